// metrics/intact_solid.h - is a structure of solid tissue whole: how much of it was cut away.
//
//     V = sum over its voxels of max(0, vol(f_before) - vol(f_after))      vol: volume/volume_of.h
//
// Its voxels: labelled so, and inside the surface before the cut. met: V <= v, by default the larger
// of 0.05 mm^3 and 3 h^3 (not calibrated). A cut that stays half a voxel away loses nothing; a
// nearer one may take a share of a voxel that still stands, which is the error.
//
// Soft tissue is never cut by a burr, so this says nothing about it: metrics/intact_soft.h.
// Thread: any. Cost: one pass over the structure.
#pragma once

#include <optional>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

struct IntactSolidSettings {
  std::optional<double> v = {};  // most that may be lost [m^3]; none: max(0.05 mm^3, 3 h^3)
};

struct IntactSolid {
  Mark mark;                           // [m^3]
  double whole = 0;                    // volume before [m^3]
  double most_lost = 0;                // the largest loss of one voxel, as a share of it
  math::Vec3 at = math::Vec3::Zero();  // where; only if something was lost
};

// Not assessable: no voxel of the structure, or it is soft.
[[nodiscard]] Assessed<IntactSolid> intact_solid(const volume::Bone& before,
                                                 const volume::Bone& after,
                                                 const VoxelSet& structure, const Worked& worked,
                                                 const IntactSolidSettings& settings);

}  // namespace burr::metrics
