// guidance/steps.h - which step of the case the user is at, and which are done.
//
//     Steps steps(lesson.steps);
//     write(steps.begin());        // the first step begins
//     write(steps.declare_done()); // the user says that the current step is done
//
// Steps come in the order of the case, but the user may choose another one. What happened is
// returned as events for the recording. Thread: any, one at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "burr/record/course.h"
#include "burr/scenario/lesson.h"

namespace burr::guidance {

class Steps {
 public:
  struct Event {
    record::CourseKind kind;
    std::string what;        // the id of the step
    std::string value = {};  // "measured": by its `done`, not by the user
    bool operator==(const Event& other) const = default;
  };
  using Events = std::vector<Event>;

  Steps() = default;
  explicit Steps(std::vector<scenario::Step> steps) : steps_(std::move(steps)) {
    state_.resize(steps_.size());
    reopened_.resize(steps_.size());
  }

  [[nodiscard]] bool empty() const { return steps_.empty(); }
  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  [[nodiscard]] const scenario::Step& operator[](std::size_t n) const { return steps_[n]; }
  [[nodiscard]] bool is_done(std::size_t n) const { return state_[n] == State::done; }
  [[nodiscard]] std::size_t done_count() const;
  // The user opened it again: he knows better than its `done`.
  [[nodiscard]] bool was_reopened(std::size_t n) const { return reopened_[n]; }
  // none: all are done, or there is no step
  [[nodiscard]] std::optional<std::size_t> current() const { return current_; }
  [[nodiscard]] const scenario::Step* now() const {
    return current_ ? &steps_[*current_] : nullptr;
  }
  // Of a step, as the recording names it: "step 3" if its own id may not be recorded.
  [[nodiscard]] std::string id(std::size_t n) const;

  // Of a session that is continued: what its recording says of the steps. Call it before begin().
  void take_up(const std::vector<record::CourseEvent>& course);
  // Call it once, when the session begins.
  [[nodiscard]] Events begin();
  // The current step is done, and the next open one begins. measured: its `done` says so.
  [[nodiscard]] Events declare_done(bool measured = false);
  // An open step becomes the current one; a done step is opened again.
  [[nodiscard]] Events choose(std::size_t n);

 private:
  enum class State { fresh, begun, done };
  void go_to(std::size_t n, Events& events);

  std::vector<scenario::Step> steps_;
  std::vector<State> state_;
  std::vector<bool> reopened_;
  std::optional<std::size_t> current_;
};

}  // namespace burr::guidance
