// The way a false device's hand goes by itself, for measuring with the whole program: away from its
// user into the bone in two seconds, then circles there, pressing, the mill button down.
//
// Frame: x right, y up, z to the user [m]; t: since it began [s].
#pragma once

#include <algorithm>
#include <cmath>

#include "burr/math/vec3.h"

namespace burr::test {

inline math::Vec3 own_way(double t) {
  const double down = std::min(1.0, t / 2), round = std::max(0.0, t - 2);
  return 1e-3 * math::Vec3(3 * std::min(1.0, round) * std::sin(3 * round),
                           3 * std::min(1.0, round) * std::cos(2 * round),
                           -22.0 * down - 1.0 * std::sin(5 * round));
}

}  // namespace burr::test
