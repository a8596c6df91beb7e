// math/pose.h - position and orientation. A Pose named a_from_b converts points of b into a.
#pragma once

#include "burr/math/vec3.h"

namespace burr::math {

struct Pose {
  Vec3 p = Vec3::Zero();      // origin of the inner frame, in the outer frame  [m]
  Quat q = Quat::Identity();  // unit quaternion

  // p_outer = pose * p_inner
  Vec3 operator*(const Vec3& inner) const { return p + q * inner; }
  Pose operator*(const Pose& inner) const { return {p + q * inner.p, q * inner.q}; }
  [[nodiscard]] Pose inverse() const {
    const Quat back = q.conjugate();
    return {back * (-p), back};
  }
  [[nodiscard]] bool finite() const noexcept { return p.allFinite() && q.coeffs().allFinite(); }
};

}  // namespace burr::math
