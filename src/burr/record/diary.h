// record/diary.h - turns what the user sees, again and again, into the few views and events that a
// recording keeps.
//
//     Diary diary(recorder, rate_hz);
//     diary.look({.view = view, .helps = {"labels"}, .paused = ""});   // for each picture
//     diary.end(tick, Ending::broke_off);                             // before recorder.finish()
//
// A view is written when it changed, at most ten times a second of the session; the last one is
// never lost. Thread: one, not the servo's.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "burr/record/course.h"
#include "burr/record/recorder.h"
#include "burr/record/view.h"

namespace burr::record {

// What is to be seen at a moment; view.tick says when.
struct Sight {
  View view = {};
  std::set<std::string> helps = {};  // shown now: "task", "labels", "slices", "see-through"
  // the structure that the user is warned of; empty: none. A name that does not fit a note is
  // written as "a structure"
  std::string near = {};
  std::string paused = {};  // why the work pauses: "page", "stopped"; empty: it does not
};

class Diary {
 public:
  // The recorder must outlive the diary. rate_hz: ticks per second.
  Diary(Recorder& recorder, double rate_hz);

  void look(const Sight& sight);
  // Anything else: a step, a question, a warning of another kind. Error: the recorder's.
  [[nodiscard]] Status note(const CourseEvent& event) { return recorder_.note(event); }

  // The user declares the work done, or takes that back.
  void declare_done(std::uint64_t tick, bool done);
  // Of a session that is continued: it was declared done before.
  void was_declared_done() { done_ = true; }
  [[nodiscard]] bool declared_done() const { return done_; }

  // Writes the last view, and how the session ended: as declared, if it was. Only the first call
  // counts.
  void end(std::uint64_t tick, Ending ending);

 private:
  void tell(std::uint64_t tick, CourseKind kind, const std::string& what,
            const std::string& where = {}, const std::string& value = {});
  void write(const View& view);

  Recorder& recorder_;
  std::uint64_t pause_ticks_;          // between two views
  std::optional<View> written_, now_;  // now_: seen, not yet written
  std::set<std::string> helps_;
  std::string near_, paused_;
  bool done_ = false, ended_ = false;
};

}  // namespace burr::record
