// device/bounded.h - the last limit on a force before it reaches a device. It comes after the
// limits of the tick and protects the hand if those are wrong.
//
// Thread: any. Units: those of peak. Memory: none.
#pragma once

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::device {

// Limits a force or a torque. A vector that is not finite becomes zero. A vector longer than peak
// is shortened to peak and keeps its direction.
[[nodiscard]] inline math::Vec3 bounded(const math::Vec3& push, double peak) BURR_RT {
  if (!push.allFinite()) return math::Vec3::Zero();
  const double size = push.norm();
  return size > peak ? math::Vec3(push * (peak / size)) : push;
}

}  // namespace burr::device
