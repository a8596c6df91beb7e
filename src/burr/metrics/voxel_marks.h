// metrics/voxel_marks.h - marks on the voxels of a set, for a pass that must not allocate.
//
// Thread: one. Memory: 64 bytes per brick that holds voxels of the set, taken at construction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/grid.h"

namespace burr::metrics {

class VoxelMarks {
 public:
  VoxelMarks(const volume::Grid& grid, const VoxelSet& set);  // the set outlives this

  // Marks all voxels of the set with their centres in a ball (world, m).
  void mark_ball(const math::Vec3& centre, double radius);
  [[nodiscard]] std::size_t count() const { return count_; }  // marked

 private:
  void mark(int i, int j, int k);

  volume::Grid grid_;
  const VoxelSet& set_;
  math::Ijk bricks_ = {0, 0, 0};
  std::vector<std::int32_t> slot_;                  // (bricks of the grid) index of bits_, or -1
  std::vector<std::array<std::uint64_t, 8>> bits_;  // one bit per voxel, x fastest
  std::size_t count_ = 0;
};

}  // namespace burr::metrics
