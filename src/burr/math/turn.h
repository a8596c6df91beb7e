// math/turn.h - products, matrices and logarithms of rotations whose order of additions is written
// down, so that the tick may use them (math/sums.h says why Eigen's own may not be).
#pragma once

#include <cmath>
#include <limits>

#include "burr/math/elementary.h"
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
  return half * (2 * angle_of(sine, side * q.w()) / sine);
}

// The inverse: a turn by norm(turn) about the axis `turn`. [rad]
[[nodiscard]] inline Quat rotation_of(const Vec3& turn) {
  const double angle = norm(turn);
  if (!(angle > 0)) return Quat::Identity();
  const Vec3 axis = turn / angle * sine(0.5 * angle);
  return {cosine(0.5 * angle), axis.x(), axis.y(), axis.z()};
}

// The rotation between a (share 0) and b (share 1), at the same speed all along and on the shorter way (K. Shoemake, Animating
// Rotation with Quaternion Curves, SIGGRAPH 1985): Eigen's slerp with functions and an order that are written down.
[[nodiscard]] inline Quat between(const Quat& a, const Quat& b, double share) {
  const double c = (a.x() * b.x() + a.z() * b.z()) + (a.y() * b.y() + a.w() * b.w());
  const double near = std::abs(c);
  double of_a = 1 - share, of_b = share;
  if (near < 1 - std::numeric_limits<double>::epsilon()) {
    const double half = angle_of(std::sqrt((1 - near) * (1 + near)), near), whole = sine(half);
    of_a = sine((1 - share) * half) / whole;
    of_b = sine(share * half) / whole;
  }
  if (c < 0) of_b = -of_b;
  return {of_a * a.w() + of_b * b.w(), of_a * a.x() + of_b * b.x(), of_a * a.y() + of_b * b.y(),
          of_a * a.z() + of_b * b.z()};
}

// `q` turned further by the small rotation vector `by`: exact to |by|^3 / 12. Unit again. [rad]
[[nodiscard]] inline Quat turned(const Quat& q, const Vec3& by) {
  return normalized(product({1, 0.5 * by.x(), 0.5 * by.y(), 0.5 * by.z()}, q));
}

}  // namespace burr::math
