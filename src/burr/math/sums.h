// math/sums.h - dot products and lengths whose order of additions is written down.
//
// Eigen adds the products of a dot product in an order that depends on the instruction set it was
// compiled for, and with it on the compiler: (x + y) + z with registers of two doubles,
// x + (y + z) without. The last bit differs, and a replay to the bit ends there. Whatever the
// tick's result depends on uses these functions instead: every compiler and every processor adds
// alike. The order is the one that Eigen 3.4 uses on x86-64, so that old recordings still replay:
//
//     three doubles    (x + y) + z
//     three floats      x + (y + z)
//     a quaternion     (x + z) + (y + w)
//
// Sums of two, products of a number and a vector, sums of vectors, cross products and
// Quat * Vec3 have one order only; Eigen's own serve. Quat * Quat and Mat3 * Vec3 have several:
// not in the tick.
#pragma once

#include <cmath>

#include "burr/math/vec3.h"

namespace burr::math {

constexpr double sum_of_three(double x, double y, double z) noexcept { return (x + y) + z; }
constexpr float sum_of_three(float x, float y, float z) noexcept { return x + (y + z); }

// Of two vectors, or expressions, of three numbers.
template <class A, class B>
[[nodiscard]] inline typename A::Scalar dot(const Eigen::MatrixBase<A>& a,
                                            const Eigen::MatrixBase<B>& b) {
  static_assert(A::SizeAtCompileTime == 3 && B::SizeAtCompileTime == 3);
  const auto& u = a.eval();  // a vector as it is, an expression worked out once
  const auto& v = b.eval();
  return sum_of_three(u[0] * v[0], u[1] * v[1], u[2] * v[2]);
}

template <class A>
[[nodiscard]] inline typename A::Scalar squared_norm(const Eigen::MatrixBase<A>& a) {
  static_assert(A::SizeAtCompileTime == 3);
  const auto& v = a.eval();
  return sum_of_three(v[0] * v[0], v[1] * v[1], v[2] * v[2]);
}

template <class A>
[[nodiscard]] inline typename A::Scalar norm(const Eigen::MatrixBase<A>& a) {
  return std::sqrt(squared_norm(a));
}

// Of length one; zero stays zero.
template <class A>
[[nodiscard]] inline Eigen::Matrix<typename A::Scalar, 3, 1> normalized(
    const Eigen::MatrixBase<A>& a) {
  Eigen::Matrix<typename A::Scalar, 3, 1> v = a;
  const typename A::Scalar square = squared_norm(v);
  if (square > 0) v /= std::sqrt(square);
  return v;
}

[[nodiscard]] inline Quat normalized(const Quat& q) {
  const double square = (q.x() * q.x() + q.z() * q.z()) + (q.y() * q.y() + q.w() * q.w());
  Quat unit = q;
  if (square > 0) unit.coeffs() /= std::sqrt(square);
  return unit;
}

}  // namespace burr::math
