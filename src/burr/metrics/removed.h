// metrics/removed.h - how much of a region is gone, how much is left, and what is gone outside.
//
//     removed = sum over voxels of  share in R  *  (vol(f_before) - vol(f_after))
//     missed  = V(R and bone before) - removed
//     excess  = the same sum as removed, outside of R grown by g
//     lost    = that sum over the voxels alone that hold less than before, so that nothing added makes up for it
//     added   = sum over the voxels that hold more than before of  vol(f_after) - vol(f_before)
//
// vol is the volume of a voxel from its field (volume/volume_of.h); the share of a voxel in R comes
// from R's depth by the same function. So a border of R across solid bone costs nothing; where the
// cut ends exactly at the border of R, about 0.15 voxel of it counts as missed; `error` is 0.23.
// Added material counts as negative. Thread: any; uses two. Cost: one pass over the changed bricks
// and over the bricks that the region touches.
#pragma once

#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct RemovedSettings {
  double grown = 0;  // g: what is removed so near outside is no excess [m]
};

struct Removed {
  double bone = 0;     // in R before [m^3]
  double removed = 0;  // of it [m^3]
  double missed = 0;   // of it, still there [m^3]
  double excess = 0;   // removed outside of R grown by g [m^3]
  double lost = 0;     // the same without what was added there [m^3]
  double all = 0;      // removed anywhere [m^3]
  double added = 0;    // anywhere [m^3]
  double share = 0;    // removed / bone
  double dice = 0;     // 2 removed / (bone + all)
  double error = 0;    // of the share, if the cut ends where R does
};

// Not assessable: no bone in R before the cut, or less than 8 voxels of it.
[[nodiscard]] Assessed<Removed> removed_of(const volume::Bone& before, const volume::Bone& after,
                                           const Region& region, const RemovedSettings& settings);

}  // namespace burr::metrics
