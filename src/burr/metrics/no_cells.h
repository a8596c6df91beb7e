// metrics/no_cells.h - were the cells over a structure taken away, with their walls?
//
//     zone Z  = region and { hi < D_X <= d }        beyond the plate of bone that is meant to stay
//     walls W = solid before the cut in Z, minus its opening by a ball of 0.75 mm
//     left    = volume of W after the cut / before
//     shut    = air before the cut in Z that no look of the cone reaches / all of it
//
// The opening of the solid is all that a ball of 0.75 mm inside it can cover; what is left over is
// thin, the walls of cells. W is found once, before the cut: taken anew after it, a thinned plate
// would be walls itself. met: left <= 0.15 and shut <= 0.10 (not calibrated). hi: that of
// skeletonised.h, d = 3 mm. Labels of cells are not needed.
//
// Frame: world. Thread: uses `threads` of its own; the result does not depend on their number.
// Memory: some 6 bytes for each voxel of the box around the zone.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/volume/bone.h"
#include "burr/volume/distance_to.h"

namespace burr::metrics {

struct NoCellsSettings {
  std::vector<math::Vec3> towards = {};      // from the bone to the surgeon, at least one
  std::vector<volume::TissueId> glass = {};  // soft tissues that hide nothing
  double hi = 1.5e-3, d = 3e-3;              // [m]
  double ball = 0.75e-3;                     // radius [m]
  double most_left = 0.15, most_shut = 0.10;
  double least_air = 20e-9;  // less in the zone: not assessable [m^3]
  int threads = 2;
};

struct NoCells {
  Mark left, shut;                   // shares
  bool met = false;                  // both
  double walls = 0;                  // W before the cut [m^3]
  double air = 0;                    // in Z before the cut [m^3]
  std::vector<math::Vec3> standing;  // voxels of W that stand: at most kMostShown of them, evenly
  std::vector<math::Vec3> hidden;    // air that is shut: those of the samples
};
inline constexpr std::size_t kMostShown = 2000;

// x: the distance to the structure. Not assessable: its reach is less than d, little air in the zone
// (bone without cells), no walls, or voxels too coarse for the ball. What lies outside the grid is
// not in the zone.
[[nodiscard]] Assessed<NoCells> no_cells(const volume::Bone& before, const volume::Bone& after,
                                         const volume::DistanceTo& x, const Region& region,
                                         const NoCellsSettings& settings);

}  // namespace burr::metrics
