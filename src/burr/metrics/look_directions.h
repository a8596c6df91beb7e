// metrics/look_directions.h - the directions from which a surgeon can look into a cavity.
//
// A cone of 50 degrees about each direction from the bone to the surgeon, sampled by 37 directions:
// the axis, and rings of 6, 12 and 18 at a third, two thirds and all of the angle. Sines and
// cosines are written out, so that every machine has the same directions to the bit.
// Frame: world. Thread: any.
#pragma once

#include <span>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::metrics {

inline constexpr int kLooks = 37;

// towards: from the bone to the surgeon; any length but zero. (37) unit directions, the axis first.
[[nodiscard]] std::vector<math::Vec3> cone_about(const math::Vec3& towards);
// All of them, one cone after the other.
[[nodiscard]] std::vector<math::Vec3> cones_about(std::span<const math::Vec3> towards);

}  // namespace burr::metrics
