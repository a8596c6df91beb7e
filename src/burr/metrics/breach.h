// metrics/breach.h - how far a screw on a drilled axis would stick out of the pedicle.
//
//     b = max over the axis of ( d / 2 - distance, square to the axis, to the nearest place outside )
//
// d: diameter of the screw. Outside: neither bone nor a tissue that the case lists as glass (marrow),
// for at least 3 mm on; so pores of spongy bone and narrow gaps do not count. b <= 0: the screw is in bone all round
// (grade A); below 2, 4, 6 mm: B, C, D; more: E (Gertzbein & Robbins 1990, doi:10.1097/00007632-199001000-00004).
// It is about the axis with the screw, not about the hole: a wide hole may still hold a good screw.
//
// Looked at in 24 directions every half voxel, so b is right to about half a voxel. Frame: world.
// Units: m. Thread: any.
#pragma once

#include <span>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct Breach {
  double out = 0;                       // b; below 0: bone that is left beside the screw [m]
  math::Vec3 at = math::Vec3::Zero();   // of the axis, where it is worst
  math::Vec3 way = math::Vec3::Zero();  // unit, from there to the nearest outside
};

// before: the bone as it was. from, to: the part of the axis that must lie in bone. diameter > 0 [m]
[[nodiscard]] Breach breach(const volume::Bone& before, std::span<const volume::TissueId> glass,
                            const math::Vec3& from, const math::Vec3& to, double diameter);

}  // namespace burr::metrics
