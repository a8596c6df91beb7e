// haptics/soft_contact.h - where the burr would rest if the bone were covered by a thin soft layer.
//
//     q = argmin |q - wanted|^2 + kappa sum_j s_j^2,    s_j = max(0, layer - gap_j - n_j . q)
//
// While bone is milled its surface goes down brick by brick, in steps, and a burr that stands on
// the three highest discs would jump with it. A soft layer spreads the load over many discs, each
// in proportion to how far it is pressed in, so that a disc that disappears or appears is hardly
// felt. kappa is chosen so that the layer carries the load where the burr stands now: on average it
// stands no higher than without the layer. Only the force is computed from this; the proxy stays
// outside the bone as before. The function is convex and piecewise quadratic: Newton's method finds
// the minimum in a few rounds.
#pragma once

#include "burr/haptics/scan_kernel.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct SoftRest {
  math::Vec3 place = math::Vec3::Zero();  // relative to where the candidates were collected [voxel]
  double pressing = 0;                    // sum of the loads of the discs        [voxel]
};

// How much the discs within `layer` support a burr that moved by `at`: |sum s n|.  [voxel]
[[nodiscard]] double soft_support(const Candidates& candidates, const math::Vec3& at, double layer,
                                  SoftPush push) BURR_RT;

// wanted: the hand, relative to where the candidates were collected [voxel]. support:
// soft_support(), or its mean over the last ticks; > 0.
[[nodiscard]] SoftRest soft_rest(const Candidates& candidates, const math::Vec3& wanted,
                                 double layer, double support, SoftPush push) BURR_RT;

}  // namespace burr::haptics
