// The path of a fake device's hand that moves by itself, for measurements with the whole program:
// away from its user into the bone within two seconds, then circles there, pressing, with the mill
// button pressed.
//
// Frame: x right, y up, z to the user [m]; t: since the start [s].
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
