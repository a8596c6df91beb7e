// io/read/merge_structures.h - structures that come one by one, each a set of voxels (a mask, a segment, a stack of
// contours), become one label map. Internal to io.
//
// They are numbered from 1 in their order. Where two overlap, the one with fewer voxels stays, of two equal ones the
// later; notices state in how many voxels, and which structures are empty.
// Units: mm. Frame: LPS. Thread: any. Memory: 16 bytes for each run of voxels, and the label map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

// Where the voxels of a scan lie.
struct VoxelPlaces {
  math::Ijk size = {0, 0, 0};
  math::Vec3 spacing_mm = {1, 1, 1};
  math::Mat3 axes = math::Mat3::Identity();
  math::Vec3 origin_mm = math::Vec3::Zero();
};
[[nodiscard]] VoxelPlaces places_of(const Scan& scan);
// "12 x 10 x 8 voxels of 0.5 x 0.5 x 1 mm from (1, 2, 3)"
[[nodiscard]] std::string in_words(const VoxelPlaces& places);

// How the voxels of one grid are numbered in another: number = first + turn * ijk, where the turn only exchanges and
// reverses axes. Nothing: the voxels of the two do not lie at the same places (to a tenth of a voxel).
struct GridTurn {
  math::Ijk first = {0, 0, 0};
  Eigen::Matrix3i turn = Eigen::Matrix3i::Identity();
};
[[nodiscard]] std::optional<GridTurn> turn_of(const VoxelPlaces& from, const VoxelPlaces& to);

struct VoxelRun {
  std::uint64_t from = 0, count = 0;  // voxels of its own grid, x fastest
};

struct LooseStructure {
  Label label;       // name, colour, meaning; the number follows from the order
  std::string file;  // for sentences; empty: all are of one file
  VoxelPlaces places;
  std::vector<VoxelRun> runs;  // in order, without overlap

  // voxels in ascending order
  void add(std::uint64_t voxel) {
    if (!runs.empty() && runs.back().from + runs.back().count == voxel)
      ++runs.back().count;
    else
      runs.push_back({voxel, 1});
  }
  [[nodiscard]] std::uint64_t voxels() const {
    std::uint64_t n = 0;
    for (const VoxelRun& run : runs) n += run.count;
    return n;
  }
};

// Fills labels, names and the grid of the scan; its notices stay. on: the grid to be used; none: the smallest that holds
// all structures. file: for errors (different grids; more than 255 structures; none has a voxel).
[[nodiscard]] Status merge_structures(const std::vector<LooseStructure>& all,
                                      const std::optional<VoxelPlaces>& on, const std::string& file,
                                      Scan& scan, Progress& progress);

}  // namespace burr::io
