// math/turn.h - products, matrices and logarithms of rotations whose order of additions is written
// down, so that the tick may use them (math/sums.h says why Eigen's own may not be).
#pragma once

#include <cmath>

#include "burr/math/pose.h"
#include "burr/math/sums.h"
#include "burr/math/vec3.h"

namespace burr::math {

// a * b: first b, then a.
[[nodiscard]] inline Quat product(const Quat& a, const Quat& b) {
  return {((a.w() * b.w() - a.x() * b.x()) - a.y() * b.y()) - a.z() * b.z(),
          ((a.w() * b.x() + a.x() * b.w()) + a.y() * b.z()) - a.z() * b.y(),
          ((a.w() * b.y() + a.y() * b.w()) + a.z() * b.x()) - a.x() * b.z(),
          ((a.w() * b.z() + a.z() * b.w()) + a.x() * b.y()) - a.y() * b.x()};
}

// The rotation vector of a unit quaternion: unit axis times angle, at most pi [rad].
[[nodiscard]] inline Vec3 rotation_vector(const Quat& q) {
  const double side = q.w() < 0 ? -1 : 1;
  const Vec3 half(side * q.x(), side * q.y(), side * q.z());
  const double sine = norm(half);
  if (sine < 1e-12) return 2 * half;
  return half * (2 * std::atan2(sine, side * q.w()) / sine);
}

// `q` turned further by the small rotation vector `by`: exact to |by|^3 / 12. Unit again. [rad]
[[nodiscard]] inline Quat turned(const Quat& q, const Vec3& by) {
  return normalized(product({1, 0.5 * by.x(), 0.5 * by.y(), 0.5 * by.z()}, q));
}

}  // namespace burr::math
