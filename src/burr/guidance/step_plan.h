// guidance/step_plan.h - what is proposed for a step of the case: tool, burr, and how deep a hand that measures no force
// may press.
//
//     const BurrChoice burr = burr_for(step, {kind, diameter}, sizes);
//     const double press = press_for(target, usual);
//
// Pure functions. Thread: any. Units: m.
#pragma once

#include <span>

#include "burr/scenario/lesson.h"
#include "burr/scoring/step_target.h"
#include "burr/tool/burr_tool.h"

namespace burr::guidance {

struct BurrChoice {
  tool::BurrKind kind = tool::BurrKind::cutting;
  double diameter = 0;
  bool operator==(const BurrChoice& other) const = default;
};

// The burr in the hand, if it suits the step; otherwise the size that is nearest to it among those that do.
// sizes: that can be had, rising; none suits: the one nearest to the step's range.
[[nodiscard]] BurrChoice burr_for(const scenario::Step& step, const BurrChoice& now,
                                  std::span<const double> sizes);

using scoring::kLeastPress;

// The depth of a press: the user's usual one, but no farther than the step's own structure is thick, or than
// the target reaches, and never as far as what must be spared; at least kLeastPress, and that where nothing of
// the target is left.
[[nodiscard]] double press_for(const scoring::StepTarget& target, double usual);

}  // namespace burr::guidance
