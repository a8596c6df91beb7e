// haptics/force_law.h - computes the force from the stretch between hand and proxy.
//
//     F = k (proxy - hand)  -  B v_n n      the second only while approaching,
//                                           and never more than the spring
//
// The spring is that of Zilles & Salisbury 1995. The damping acts along the normal only, so that
// sliding stays free. Passive on a sampled device while k <= 2 (b - B) / T (Colgate & Schenkel
// 1994); `stiffness` is capped by the device's own table. Thread: servo. Frame: world. Units: SI.
// Memory: none.
#pragma once

#include <algorithm>

#include "burr/haptics/force_settings.h"
#include "burr/haptics/touch_method.h"
#include "burr/math/sums.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

// touch: from the proxy's step; velocity: of the hand, filtered [m/s]. Returns the force on the
// hand [N].
[[nodiscard]] inline math::Vec3 force_law(const Touch& touch, const math::Vec3& velocity,
                                          const ForceSettings& settings) BURR_RT {
  if (!touch.touching) return math::Vec3::Zero();
  // the frictionless part acts along the smoothed normal; friction pulls where the proxy trails
  // behind
  const double spring = settings.stiffness * touch.depth;
  const double approach = std::max(0.0, -math::dot(velocity, touch.normal));
  const double damper = std::min(settings.damping * approach, spring);
  return (spring + damper) * touch.normal + settings.stiffness * touch.tangential;
}

}  // namespace burr::haptics
