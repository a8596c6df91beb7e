// metrics/divided.h - whether a cut has divided the bone into two pieces.
//
//     core     voxels of bone whose six neighbours are bone too, so a bridge of two voxels at most is
//              no bridge: it breaks
//     share    of the second largest connected piece of the core in the region, after the cut
//
// Connected: over faces. Frame: world. Not assessable: the bone was in two pieces before, or there
// is none in the region. Thread: any. Memory: a byte per voxel of the grid.
#pragma once

#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct Divided {
  double share = 0;  // of the smaller piece; 0: in one piece
  double first = 0;  // of the larger piece
};

// least: a smaller piece before the cut is a splinter, not a piece [share].
[[nodiscard]] Assessed<Divided> divided(const volume::Bone& before, const volume::Bone& after,
                                        const Region& region, double least);

}  // namespace burr::metrics
