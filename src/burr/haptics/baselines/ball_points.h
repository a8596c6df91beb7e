// haptics/baselines/ball_points.h - points spread evenly over the surface of the unit ball.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "burr/math/elementary.h"
#include "burr/math/vec3.h"

namespace burr::haptics {

// A golden-angle spiral (Vogel 1979): each point has a share of 4 pi / n of the surface.
inline void spread_on_ball(std::span<math::Vec3> points) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double z = 1 - (2 * static_cast<double>(n) + 1) / static_cast<double>(points.size()),
                 flat = std::sqrt(1 - z * z), turn = golden * static_cast<double>(n);
    points[n] = {flat * math::cosine(turn), flat * math::sine(turn), z};
  }
}

}  // namespace burr::haptics
