// apps/burr/window/mill/mill_notes.h - the two texts beside the picture while milling, the note and
// the warning, and which of all that could be said they are.
//
//     notes.note(word(Word::undone));                       // about the last action
//     if (notes.due()) text = notes.renew({.warning = ...});  // in each picture
//
// A note is shown for some seconds; kept, until the user clicks it away. Thread: main.
#pragma once

#include <string>

#include "window/ui/status_line.h"

namespace burr::app {

class MillNotes {
 public:
  using Clock = StatusLine::Clock;

  void note(std::string text);                                  // "": no message
  void keep(std::string text) { line_.keep(std::move(text)); }  // somebody waited for it
  void warn_released(std::string text) { line_.warn_released(std::move(text), Clock::now()); }
  // The user clicked the note away; it is gone in the next picture.
  void click_away();

  // True five times a second: renew() the texts now.
  [[nodiscard]] bool due();
  // What is true at a picture; "": nothing.
  struct Stands {
    std::string warning = {};   // shown instead of one about a past event
    bool released = false;      // the force, and the hand is not lifted: the user must begin free
    std::string progress = {};  // of an export
    std::string measured = {};  // the value of a measurement, or what to do next
    std::string hint = {};      // if there is no other note
    std::string trouble = {};   // of an export
  };
  // Returns all of it in one line: the trouble alone, or the warning and the note.
  [[nodiscard]] std::string renew(const Stands& now);

  // As renewed last. The value of a measurement is not among them: the strip shows the one that
  // stands in the picture.
  [[nodiscard]] const std::string& text() const { return note_; }
  [[nodiscard]] const std::string& warning() const { return warning_; }
  // The note waits for a click.
  [[nodiscard]] bool stays() const { return line_.kept() && !note_.empty(); }

 private:
  StatusLine line_;
  std::string note_, warning_;
  Clock::time_point renewed_{};
};

}  // namespace burr::app
