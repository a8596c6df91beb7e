#include "burr/scoring/step_order.h"

#include <set>
#include <string>
#include <vector>

namespace burr::scoring {
namespace {

// All steps that must come after `first`.
std::set<std::string> later_than(const scenario::CaseLesson& lesson, const std::string& first) {
  std::set<std::string> found;
  std::vector<std::string> open = {first};
  while (!open.empty()) {
    const scenario::Step* step = lesson.step(open.back());
    open.pop_back();
    if (step == nullptr) continue;
    for (const std::string& next : step->must_precede)
      if (found.insert(next).second) open.push_back(next);
  }
  return found;
}

}  // namespace

StepOrder step_order(const scenario::CaseLesson& lesson, std::span<const metrics::StepMark> marks) {
  StepOrder out;
  std::set<std::string> done;
  for (const metrics::StepMark& mark : marks) {
    if (mark.event != metrics::StepEvent::done || lesson.step(mark.step) == nullptr) continue;
    if (!done.insert(mark.step).second) continue;
    const std::set<std::string> later = later_than(lesson, mark.step);
    for (DoneStep& step : out.steps) {
      if (!later.contains(lesson.steps[step.number - 1].id)) continue;
      step.early = true;
      ++out.wrong;
    }
    const auto number = static_cast<std::size_t>(lesson.step(mark.step) - lesson.steps.data());
    out.steps.push_back({mark.t, number + 1, false});
  }
  out.done = done.size();
  return out;
}

}  // namespace burr::scoring
