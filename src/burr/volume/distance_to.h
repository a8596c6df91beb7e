// volume/distance_to.h - the distance from any point to the nearest of some tissues, and which
// tissue that is.
//
//     D(p) = min |p - c| - voxel / 2      over the centres c of all voxels of these tissues
//
// A voxel counts as a solid tissue only if it is labelled so and lies inside the surface, because
// labels reach some voxels into the air. D is 0 at the voxels' faces and -voxel / 2 inside.
//
// Error, compared with the union of the voxels' cubes: none, or up to 0.37 voxel too long at their
// corners. Compared with a smooth structure, whose voxels are those with their centres in it: 0.3
// voxel too short on average, between 0.5 too short and 0.4 too long (a ball of 8 voxels,
// tests/volume/distance_to_test.cpp). Computed once, before anything is cut: labels do not change.
//
// Method: exact squared distances in whole voxels, by one pass along each axis: first the nearest
// voxel in each row, then the lower envelope of parabolas (Felzenszwalb & Huttenlocher 2012; in
// integers as Meijster et al. 2000). Values are kept at every `step`-th voxel and interpolated
// trilinearly: the error is at most sqrt(3)/2 step voxels, since D has slope 1, and about 0.02
// voxel around that ball. There is no answer where a kept neighbour is beyond the reach, and none is
// kept that is farther than the reach from the box of these tissues. The reach is at most 255 voxels,
// since a square must fit into 16 bits.
//
// Frame: world. Thread: make() uses several; at() from any, wait-free. Memory: 3 bytes per kept
// voxel; while it is made, 3 more bytes for each kept voxel of a slice, for every slice; none if
// there is no voxel of these tissues.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/bone.h"

namespace burr::volume {

struct DistanceSettings {
  double reach = 20e-3;                // larger distances are not reported                 [m]
  std::size_t most_kept = 32'000'000;  // voxels; `step` is the smallest that keeps to it
  int threads = 2;
};

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  // infinity: beyond the reach   [m]
  TissueId tissue = 0;
};

class DistanceTo {
 public:
  DistanceTo() = default;  // no tissues: at() is always beyond the reach

  // Error: only Trouble::interrupted. The result does not depend on the number of threads.
  [[nodiscard]] static Result<DistanceTo> make(const Bone& bone, std::span<const TissueId> tissues,
                                               const DistanceSettings& settings,
                                               Progress& progress);

  // Works outside the grid too, where the result may be too short but never too long. A p that is
  // not finite counts as beyond the reach.
  [[nodiscard]] Nearest at(const math::Vec3& p) const BURR_RT;

  [[nodiscard]] bool empty() const BURR_RT { return square_.empty(); }
  [[nodiscard]] int step() const BURR_RT { return step_; }       // [voxel]
  [[nodiscard]] double reach() const BURR_RT { return reach_; }  // [m]
  [[nodiscard]] std::size_t memory_bytes() const BURR_RT { return 3 * square_.size(); }

 private:
  class Maker;

  Grid grid_;
  int step_ = 1;
  double reach_ = 0;
  math::Ijk all_ = {0, 0, 0};          // number along each axis of the grid
  math::Ijk first_ = {0, 0, 0};        // of them the first that is kept
  math::Ijk kept_ = {0, 0, 0};         // number that is kept
  std::vector<std::uint16_t> square_;  // (kept) squared distance, or kBeyond        [voxel^2]
  std::vector<TissueId> tissue_;       // (kept) the nearest tissue
};

}  // namespace burr::volume
