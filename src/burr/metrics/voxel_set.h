// metrics/voxel_set.h - a set of voxels of a grid: a structure, or a part of the air.
//
// A voxel belongs to a structure if it has one of its labels; with a label of a solid tissue, only
// if it lies inside the surface, because such labels reach some voxels into the air.
// Thread: one while it is made, then any. Memory: 64 bytes per brick that holds some, 4 per brick
// of the grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "burr/metrics/region.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

class VoxelSet {
 public:
  VoxelSet() = default;  // none

  // The voxels of a structure, which is all that has one of these labels.
  [[nodiscard]] static VoxelSet of_tissues(const volume::Bone& bone,
                                           std::span<const volume::TissueId> tissues);
  // Air (field below the surface): in the region, and with one of these labels if there are any.
  [[nodiscard]] static VoxelSet of_air(const volume::Bone& bone,
                                       std::span<const volume::TissueId> tissues,
                                       const Region& region);

  [[nodiscard]] bool has(int i, int j, int k) const;  // outside the grid: no
  [[nodiscard]] bool has(const math::Ijk& v) const { return has(v.x(), v.y(), v.z()); }
  [[nodiscard]] bool has_any_in(volume::BrickIndex brick) const {
    return slot_[static_cast<std::size_t>(brick)] >= 0;
  }
  [[nodiscard]] std::size_t count() const { return count_; }

  // Calls visit(ijk) for each voxel, brick by brick, x fastest within a brick.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t b = 0; b < slot_.size(); ++b) {
      if (slot_[b] < 0) continue;
      const auto& bits = bits_[static_cast<std::size_t>(slot_[b])];
      for (int v = 0; v < volume::kBrickVoxels; ++v)
        if ((bits[static_cast<std::size_t>(v >> 6)] >> (v & 63) & 1) != 0)
          visit(first_of(b) + math::Ijk(v & 7, (v >> 3) & 7, v >> 6));
    }
  }

 private:
  explicit VoxelSet(const volume::Bone& bone);
  template <class Belongs>
  void collect(const volume::Bone& bone, const Belongs& belongs);
  [[nodiscard]] math::Ijk first_of(std::size_t brick) const;

  math::Ijk size_ = {0, 0, 0}, bricks_ = {0, 0, 0};
  std::vector<std::int32_t> slot_;                  // (bricks of the grid) index of bits_, or -1
  std::vector<std::array<std::uint64_t, 8>> bits_;  // one bit per voxel, x fastest
  std::size_t count_ = 0;
};

// The ids of all tissues with these names; a name that the bone does not have adds none.
[[nodiscard]] std::vector<volume::TissueId> tissues_named(const volume::TissueTable& tissues,
                                                          std::span<const std::string_view> names);

}  // namespace burr::metrics
