// metrics/thinned.h - was a wall between two airs thinned evenly, without a hole: the wall of the ear
// canal, seen from the canal.
//
//     t(s) = integral of sigma_after along the wall's normal from s to the air of the cavity
//
// s: a sample of the canal's surface; the cavity is what was removed, and the region that the case
// names for it. A sample whose normal meets no cavity within `cap` has a thick wall there (t is
// infinite). met: as skeletonised.h, with the defaults 0.1 and 2.0 mm, 0.6, 0.1 (not calibrated).
// Thread: any; uses one.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/metrics/skeletonised.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct ThinnedSettings {
  std::vector<math::Vec3> towards = {};  // from the canal to the cavity: which side of the canal
  ThinSettings thin = {.lo = 0.1e-3, .hi = 2.0e-3};
  double cap = 5e-3;  // [m]
  std::size_t most_samples = 600;
};

// canal: VoxelSet::of_air. cavity: empty air on the other side that was there before; nullptr: only
// what was removed. region: the part of the canal's surface that is looked at.
[[nodiscard]] Assessed<Thin> thinned(const volume::Bone& before, const volume::Bone& after,
                                     const VoxelSet& canal, const VoxelSet* cavity,
                                     const Region& region, const Worked& worked,
                                     const ThinnedSettings& settings);

}  // namespace burr::metrics
