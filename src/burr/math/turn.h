// math/turn.h - from one direction to another.
#pragma once

#include <cmath>

#include "burr/math/sums.h"
#include "burr/math/vec3.h"

namespace burr::math {

// The shortest turn that takes the direction of `from` to that of `to`; neither may be zero. Of
// opposite directions: half a turn about one of the axes across. What Eigen's
// Quaternion::FromTwoVectors does, whose singular values for that last case take a compiler some
// twenty seconds in every file.
inline Quat shortest_turn(const Vec3& from, const Vec3& to) {
  const Vec3 a = normalized(from), b = normalized(to);
  const double cosine = dot(a, b);
  Quat turn;
  if (cosine < -1 + 1e-12) {
    turn.w() = 0;
    turn.vec() = a.unitOrthogonal();
    return turn;
  }
  // by the sum: of nearly opposite directions 1 + cosine has lost its digits
  const double s = norm(a + b);
  turn.w() = 0.5 * s;
  turn.vec() = a.cross(b) * (1 / s);
  return normalized(turn);
}

}  // namespace burr::math
