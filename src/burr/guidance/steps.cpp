#include "burr/guidance/steps.h"

#include <fmt/format.h>

#include <algorithm>

#include "burr/record/private_text.h"

namespace burr::guidance {

using record::CourseKind;

std::size_t Steps::done_count() const {
  return static_cast<std::size_t>(std::count(state_.begin(), state_.end(), State::done));
}

std::string Steps::id(std::size_t n) const {
  return record::fit_for_a_note(steps_[n].id) ? steps_[n].id : fmt::format("step {}", n + 1);
}

void Steps::go_to(std::size_t n, Events& events) {
  current_ = n;
  if (state_[n] == State::fresh) events.push_back({CourseKind::step_begun, id(n)});
  state_[n] = State::begun;
}

void Steps::take_up(const std::vector<record::CourseEvent>& course) {
  for (const record::CourseEvent& event : course) {
    std::size_t n = 0;
    while (n < steps_.size() && id(n) != event.what) ++n;
    if (n == steps_.size()) continue;
    if (event.kind == CourseKind::step_done) {
      state_[n] = State::done;
      if (current_ == n) current_.reset();
    } else if (event.kind == CourseKind::step_begun || event.kind == CourseKind::step_reopened) {
      reopened_[n] = reopened_[n] || event.kind == CourseKind::step_reopened;
      state_[n] = State::begun;
      current_ = n;
    }
  }
}

Steps::Events Steps::begin() {
  Events events;
  for (std::size_t n = 0; n < steps_.size() && !current_; ++n)
    if (state_[n] != State::done) current_ = n;
  if (current_) go_to(*current_, events);
  return events;
}

Steps::Events Steps::declare_done(bool measured) {
  Events events;
  if (!current_) return events;
  events.push_back({CourseKind::step_done, id(*current_), measured ? "measured" : ""});
  state_[*current_] = State::done;
  // the next open one behind it, or else the first open one
  const std::size_t from = *current_;
  current_.reset();
  for (std::size_t n = 1; n < steps_.size() && !current_; ++n)
    if (const std::size_t next = (from + n) % steps_.size(); state_[next] != State::done)
      go_to(next, events);
  return events;
}

Steps::Events Steps::choose(std::size_t n) {
  Events events;
  if (n >= steps_.size() || current_ == n) return events;
  if (state_[n] == State::done) {
    events.push_back({CourseKind::step_reopened, id(n)});
    reopened_[n] = true;
  }
  go_to(n, events);
  return events;
}

}  // namespace burr::guidance
