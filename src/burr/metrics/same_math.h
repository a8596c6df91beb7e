// metrics/same_math.h - arc tangent, sine, cosine and logarithm made of + - * / and square roots
// alone, so that marks do not depend on the last bit of a C library.
//
// Errors: below 1e-14 of the result, or 1e-15 where the result is near zero. Thread: any.
#pragma once

#include <cmath>

#include "burr/math/sums.h"
#include "burr/math/vec3.h"

namespace burr::metrics {

inline constexpr double kPi = 3.141592653589793;
inline constexpr double kDegree = kPi / 180;

// Angle of the vector (x, y) to the x axis, -pi .. pi; of (0, 0): 0.
[[nodiscard]] double arc_tangent(double y, double x);
// |angle| at most 1e4.
[[nodiscard]] double sine(double angle);
[[nodiscard]] double cosine(double angle);
// Natural logarithm of x > 0.
[[nodiscard]] double logarithm(double x);
// 2 to the x, |x| below 1000.
[[nodiscard]] double two_to(double x);

// Angle between two directions, 0 .. pi; exact for small ones too. Of a zero vector: 0.
[[nodiscard]] inline double angle_between(const math::Vec3& a, const math::Vec3& b) {
  return arc_tangent(math::norm(a.cross(b)), math::dot(a, b));
}

}  // namespace burr::metrics
