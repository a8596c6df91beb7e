// metrics/axis_fit.h - the axis of a drilled corridor against the planned one.
//
// Of what was removed, the largest connected piece is the corridor (main_cut.h): a hole beside it is not. It is divided into slices across the planned axis, as many whole voxels thick as
// make 0.5 mm. A robust line through the slices' middles is the axis; slices with less than
// half of the median width (the ends) or a tenth of the median volume do not count. The middle of a slice is that of
// its outline (the Steiner point of its hull, from 16 directions), so the pores of spongy bone do not shift it.
//
//     entry    where the fitted axis meets the surface as it was, last before what was removed on it;
//              its distance to the plan's entry, across the planned axis
//     angle    between the two axes
//     depth    length of the corridor along the plan, from the entry to its end on the axis: the
//              first bone that stands, or where the bone ended before the cut (`through`). Where the axis
//              ends in an old pore, the deepest of eight lines beside it that end in bone counts
//     reach    how far its end lies from the planned entry along the plan: what a planned depth is compared with, since
//              the bone's surface may lie beside the plan's first point
//     width    where half of the bone round the axis stands again (corridor_width.h); pores do not count
//
// Frame: world. Units: m, rad. Not assessable: nothing was removed there, a corridor shorter than one and
// a half of its diameters (too_little_done), or an axis that does not lead from the air outside into what was removed within
// 10 mm of the planned entry. Thread: any.
#pragma once

#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct PlannedAxis {
  math::Vec3 entry = math::Vec3::Zero();    // on the bone's surface
  math::Vec3 inward = math::Vec3::UnitZ();  // unit, into the bone
};

struct AxisFit {
  double entry_off = 0;  // [m]
  double angle = 0;      // [rad]
  double depth = 0;      // [m]
  double reach = 0;      // [m]
  double width = 0;      // [m]
  bool through =
      false;         // the corridor ends in air that was there before: it passes through the bone
  double error = 0;  // of entry_off: 0.25 h [m]
  math::Vec3 entry = math::Vec3::Zero(), inward = math::Vec3::Zero();  // of the fit
  math::Vec3 apex = math::Vec3::Zero();                                // its end on the fitted axis
  std::vector<math::Vec3> centres;                                     // of the slices that count
};

// region: where the corridor may lie; other cuts are left out.
[[nodiscard]] Assessed<AxisFit> axis_fit(const volume::Bone& before, const volume::Bone& after,
                                         const PlannedAxis& plan, const Region& region);

}  // namespace burr::metrics
