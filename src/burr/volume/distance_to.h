// volume/distance_to.h - how far it is to the nearest of some tissues, anywhere in the bone, and to
// which of them.
//
//     D(p) = min |p - c| - voxel / 2      over the centres c of all voxels of these tissues
//
// where a voxel is of a solid tissue if it is labelled so and inside the surface, as labels go on
// some voxels into the air;
// so 0 at their faces and -voxel / 2 inside. To the union of the voxels' cubes D is exact or up to
// 0.37 voxel too long, at their corners. To a smooth structure, whose voxels are those with their
// centres in it, it is 0.3 voxel too short in the mean, and from 0.5 too short to 0.4 too long (a
// ball of 8 voxels, tests/volume/distance_to_test.cpp). Made once, before anything is cut: labels
// stay.
//
// Exact squares of whole voxels, by one pass along each axis: the nearest in its row, then the
// lower envelope of parabolas (Felzenszwalb & Huttenlocher 2012; in whole numbers as Meijster et
// al. 2000). Kept at every `step`-th voxel and blended trilinearly between: off by sqrt(3)/2 step
// voxels at the very most, since D has slope 1, and about that ball by 0.02. Where a neighbour is
// beyond the reach there is no answer; the reach is at most 255 voxels, since a square must fit
// into 16 bits.
//
// Frame: world. Thread: make one with several; at() from any, wait-free. Memory: 3 bytes a kept
// voxel, and while it is made 3 bytes for each of a slice's kept voxels in each slice; no voxel of
// these tissues: none.
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
  double reach = 20e-3;                // farther is not told                            [m]
  std::size_t most_kept = 32'000'000;  // voxels; `step` is the smallest whole number for it
  int threads = 2;
};

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  // infinity: beyond the reach   [m]
  TissueId tissue = 0;
};

class DistanceTo {
 public:
  DistanceTo() = default;  // to nothing: at() is always beyond the reach

  // Error: only Trouble::interrupted. The result does not depend on the number of threads.
  [[nodiscard]] static Result<DistanceTo> make(const Bone& bone, std::span<const TissueId> tissues,
                                               const DistanceSettings& settings,
                                               Progress& progress);

  // Outside the grid too: not longer than it is. What is not a number is beyond the reach.
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
  math::Ijk kept_ = {0, 0, 0};         // along each axis
  std::vector<std::uint16_t> square_;  // (kept) of the distance; kBeyond        [voxel^2]
  std::vector<TissueId> tissue_;       // (kept) the nearest
};

}  // namespace burr::volume
