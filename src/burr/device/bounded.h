// device/bounded.h - the last bound before a device, beside the tick's own, should that ever be
// mistaken.
//
// Thread: any. Units: those of peak. Memory: none.
#pragma once

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::device {

// A force or a torque: what is no number is none, what is larger than peak is that, its direction
// kept.
[[nodiscard]] inline math::Vec3 bounded(const math::Vec3& push, double peak) BURR_RT {
  if (!push.allFinite()) return math::Vec3::Zero();
  const double size = push.norm();
  return size > peak ? math::Vec3(push * (peak / size)) : push;
}

}  // namespace burr::device
