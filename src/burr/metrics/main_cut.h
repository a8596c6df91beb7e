// metrics/main_cut.h - the largest connected piece of what was removed in a region: a corridor without the
// holes beside it.
//
// Gaps of at most 0.75 mm do not part it, as between the walls of spongy bone; gaps of 1.5 mm and more do (in voxels of
// up to 0.4 mm).
// Frame: world. Units: m. Thread: any. Memory: 64 bytes for each voxel that was cut.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct Gone {
  math::Vec3 place = math::Vec3::Zero();  // centre of the voxel
  double share = 0;                       // of the voxel that was removed
};

struct MainCut {
  std::vector<Gone> gone;   // in the order of bricks
  std::size_t others = 0;   // pieces that were left out
  double others_share = 0;  // of all that was removed in the region
};

[[nodiscard]] MainCut main_cut(const volume::Bone& before, const volume::Bone& after,
                               const Region& region);

}  // namespace burr::metrics
