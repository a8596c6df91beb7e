// metrics/structure_patch.h - the part of a structure's surface that a measure looks at, as samples.
//
// A sample is a voxel of the structure with a neighbour (of six) outside of it, not within one voxel
// of the grid's border. Its normal n points out of the structure: minus the sum of the offsets to the
// structure's voxels among the 5 x 5 x 5 around it. In the patch are the samples in the region with
// n . a >= cos 80 degrees for a direction a to the surgeon. If these are more than `most_samples`,
// every n-th stays, in the order of bricks, so the same bone gives the same samples.
//
// The area of a sample is (free faces) h^2 / (|nx| + |ny| + |nz|): what a plane of that normal has
// per free face, times n where only every n-th stayed.
// Frame: world. Units: m. Thread: any. Memory: the samples.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/grid.h"

namespace burr::metrics {

struct SurfaceSample {
  math::Ijk voxel = {0, 0, 0};
  math::Vec3 place = math::Vec3::Zero();   // centre of the voxel, world
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the structure, world
  int faces = 0;                           // free faces, 1..6: the sample's weight
  double area = 0;                         // that it stands for [m^2]
};

struct PatchSettings {
  std::vector<math::Vec3> towards =
      {};                          // directions from the bone to the surgeon; none: all samples
  std::size_t most_samples = 600;  // 0: all
};

inline constexpr std::size_t kFewestSamples = 30;         // a patch of fewer is not assessable
inline constexpr double kSteepest = 0.17364817766693041;  // cos 80 degrees

struct Patch {
  std::vector<SurfaceSample> samples;
  std::size_t thinned = 1;  // every n-th sample of the surface stayed
};

// Not assessable: the structure is not in the bone, or fewer than kFewestSamples lie in the region.
[[nodiscard]] Assessed<Patch> patch_of(const volume::Grid& grid, const VoxelSet& structure,
                                       const Region& region, const PatchSettings& settings);

}  // namespace burr::metrics
