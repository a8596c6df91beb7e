// apps/burr/window/mill/mill_actions.h - what a button of the bar, an item of the menu, a key or a
// button of a pad does on the page for milling, and whether the page stays open.
//
// What the mode of the session refuses is refused here, whatever it came from. Thread: main.
#pragma once

#include <string>
#include <utility>

#include "shared/word_names.h"
#include "window/mill/mill_parts.h"
#include "window/mill/mill_site.h"
#include "window/parts/toolbar.h"
#include "window/ui/closed.h"

namespace burr::app {

class MillActions {
 public:
  MillActions(const MillSite& site, MillParts& parts)
      : session_(site.session),
        options_(site.options),
        notes_(site.notes),
        over_(site.over),
        parts_(parts) {}

  void act(Action action);
  // Closes what is open on the page; if nothing is, asks whether to leave it.
  void go_back();
  void toggle_menu(Menu menu);
  void hide_panels();
  void keep();  // marks the session as one to keep
  void change_loudness(int by);
  // The work is done: asks, if that ends the session; otherwise declares it or takes it back.
  void declare_done();
  void answer();  // yes to the question that is open, if one is
  void end_as_done();
  void end_as_left();
  void quit() { open_ = false; }  // the program

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] Closed closed() const { return closed_; }  // how
  // True once for each picture that the user wants.
  [[nodiscard]] bool take_picture() { return std::exchange(picture_, false); }
  // For the table of keys.
  [[nodiscard]] MillParts& parts() { return parts_; }
  void note(std::string text) { notes_.note(std::move(text)); }

 private:
  void leave();
  void toggle_sound();
  bool drive(Action action);
  bool show(Action action);
  void command(tick::CommandKind kind, Word says);

  sim::Session& session_;
  const WindowOptions& options_;
  MillNotes& notes_;
  MillOver& over_;
  MillParts& parts_;
  bool open_ = true, picture_ = false;
  Closed closed_ = Closed::window;
};

}  // namespace burr::app
