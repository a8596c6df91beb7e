// haptics/soft_contact.h - where the burr would rest if the bone wore a thin soft layer.
//
//     q = argmin |q - wanted|^2 + kappa sum_j s_j^2,    s_j = max(0, layer - gap_j - n_j . q)
//
// While bone is milled its surface goes down brick by brick, in hops; a burr that stands on the
// three highest discs hops with them. Many discs share the load of a soft layer, each in the
// measure in which it is pressed, so one that goes away or comes is hardly felt. kappa is what
// makes the layer carry the load where the burr stands now: on average it stands no higher than
// without. Only the force is taken from here; the proxy stays outside of the bone as before.
//                        Convex and piecewise quadratic: Newton's method finds it in a few rounds.
#pragma once

#include "burr/haptics/scan_kernel.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct SoftRest {
  math::Vec3 place = math::Vec3::Zero();  // from where the candidates were seen  [voxel]
  double pressing = 0;                    // sum of what the discs bear           [voxel]
};

// What the discs within `layer` offer to a burr that moved by `at`: |sum s n|.  [voxel]
[[nodiscard]] double soft_support(const Candidates& candidates, const math::Vec3& at, double layer,
                                  SoftPush push) BURR_RT;

// wanted: the hand, from where the candidates were seen [voxel]. support: as soft_support(), or its
// mean over the last ticks; > 0.
[[nodiscard]] SoftRest soft_rest(const Candidates& candidates, const math::Vec3& wanted,
                                 double layer, double support, SoftPush push) BURR_RT;

}  // namespace burr::haptics
