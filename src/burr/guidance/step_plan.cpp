#include "burr/guidance/step_plan.h"

#include <algorithm>
#include <cmath>

namespace burr::guidance {

BurrChoice burr_for(const scenario::Step& step, const BurrChoice& now,
                    std::span<const double> sizes) {
  constexpr double kSame = 1e-9;
  BurrChoice out = {step.kind.value_or(now.kind), now.diameter};
  if (!step.diameter || sizes.empty()) return out;
  const auto [least, most] = *step.diameter;
  const auto outside = [&, low = least, high = most](double size) {
    return std::max({low - size, size - high, 0.0});
  };
  if (outside(now.diameter) <= kSame) return out;
  out.diameter = *std::min_element(sizes.begin(), sizes.end(), [&](double a, double b) {
    if (std::abs(outside(a) - outside(b)) > kSame) return outside(a) < outside(b);
    return std::abs(a - now.diameter) < std::abs(b - now.diameter);
  });
  return out;
}

double press_for(const scoring::StepTarget& target, double usual) {
  if (target.gone) return kLeastPress;  // what is under it now nobody has said
  if (!target.found) return usual;
  const double work = target.thickness > 0 ? target.thickness : target.deepest;
  return std::max(std::min({usual, work, target.room}), kLeastPress);
}

}  // namespace burr::guidance
