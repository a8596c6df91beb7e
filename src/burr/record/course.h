// record/course.h - what happened in a session besides milling: steps, help, warnings, pauses, the
// end. A message of the channel /course.
//
// Texts are words of the case or of burr, never what a person typed: check() refuses a text that is
// too long or looks like a path, a UID or a mail address. Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::record {

enum class CourseKind {
  step_begun,     // what: id of the step
  step_done,      // the user declared it done
  step_reopened,  // the user went back to it
  help_shown,     // what: "task", "labels", "see-through" ...; where: the structure or the panel
  help_hidden,
  warning,       // what: "near", "released" ...; where: the structure
  question,      // what: id of the question
  answer,        // what: id of the question; value: the answer's id
  pause,         // what: why, "page", "stopped"
  resume,        //
  complication,  // what: its id; it begins now
  self_mark,     // what: id of the item; value: "met", "unmet", "unknown"
  done,          // the user declared the work done
  reopened,      // the user took that back
  ended,         // value: word_of(Ending)
  continued,     // after `ended`: the user came back to the session; written by the recorder
};
[[nodiscard]] const char* word_of(CourseKind kind);

// How a session ended. A session that was killed has no such event.
enum class Ending {
  declared_done,  // the user had declared the work done
  time_up,        // the time of the session was over
  broke_off,      // left or stopped before
};
[[nodiscard]] const char* word_of(Ending ending);  // "declared done", "time up", "broke off"
[[nodiscard]] std::optional<Ending> ending_of(std::string_view word);

struct CourseEvent {
  std::uint64_t tick = 0;
  CourseKind kind = CourseKind::step_begun;
  std::string what = {}, where = {}, value = {};  // empty: not needed
  bool operator==(const CourseEvent& other) const = default;
};

[[nodiscard]] Status check(const CourseEvent& event);

[[nodiscard]] std::string to_json(const CourseEvent& event);
// False: not an event, or one of a kind that this burr does not know.
[[nodiscard]] bool course_from_json(std::string_view text, CourseEvent& event);
[[nodiscard]] std::string course_schema();

}  // namespace burr::record
