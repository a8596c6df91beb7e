// metrics/filled.h - how much of a gap in the bone was filled with material, and how much material lies
// outside of the gap.
//
//     space   = sum over voxels of  share in R  *  (1 - vol(f_before))
//     filled  = sum over voxels of  share in R  *  (vol(f_after) - vol(f_before)), where f grew
//     beside  = the same sum as filled, outside of R grown by g
//
// vol and the share of a voxel in R are those of metrics/removed.h. What was cut away does not count
// against what was added elsewhere. The border of R counts as in removed.h: the filling that ends
// exactly there misses about 0.15 voxel of it; `error` is 0.23. Thread: any; uses one. Cost: one pass
// over the bricks that the region touches and over those that changed.
#pragma once

#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct FilledSettings {
  double grown = 0;  // g: material so near outside is not beside [m]
};

struct Filled {
  double space = 0;        // in R before [m^3]
  double filled = 0;       // of it [m^3]
  double beside = 0;       // added outside of R grown by g [m^3]
  double all = 0;          // added anywhere [m^3]
  double share = 0;        // filled / space
  double stray = 0;        // beside / all; 0: nothing was added
  double error = 0;        // of the share, if the filling ends where R does
  double stray_error = 0;  // of the stray, if it does; none where g is a voxel or more
};

// Not assessable: no space in R before, or less than 8 voxels of it.
[[nodiscard]] Assessed<Filled> filled_of(const volume::Bone& before, const volume::Bone& after,
                                         const Region& region, const FilledSettings& settings);

}  // namespace burr::metrics
