// math/aabb.h - an axis-aligned box with real coordinates; both faces belong to it.
#pragma once

#include <limits>

#include "burr/math/vec3.h"

namespace burr::math {

struct Aabb {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

  [[nodiscard]] bool empty() const { return !(lo.array() <= hi.array()).all(); }
  void extend(const Vec3& p) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  [[nodiscard]] Aabb inflated(double by) const {
    return {lo - Vec3::Constant(by), hi + Vec3::Constant(by)};
  }
  [[nodiscard]] Vec3 centre() const { return 0.5 * (lo + hi); }
  [[nodiscard]] Vec3 extent() const { return hi - lo; }
  // which: 0..7; bit 0 is x, bit 1 is y, bit 2 is z. Bit set: the coordinate is that of hi.
  [[nodiscard]] Vec3 corner(int which) const {
    return {(which & 1) != 0 ? hi.x() : lo.x(), (which & 2) != 0 ? hi.y() : lo.y(),
            (which & 4) != 0 ? hi.z() : lo.z()};
  }
};

}  // namespace burr::math
