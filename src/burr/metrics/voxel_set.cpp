#include "burr/metrics/voxel_set.h"

#include <algorithm>

namespace burr::metrics {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kBrickVoxels;
using volume::TissueId;
using volume::TissueKind;

VoxelSet::VoxelSet(const Bone& bone)
    : size_(bone.grid().size),
      bricks_(bone.bricks()),
      slot_(static_cast<std::size_t>(bone.brick_count()), -1) {}

math::Ijk VoxelSet::first_of(std::size_t brick) const {
  const int b = static_cast<int>(brick);
  return math::Ijk(b % bricks_.x(), b / bricks_.x() % bricks_.y(),
                   b / (bricks_.x() * bricks_.y())) *
         kBrickEdge;
}

// belongs(ijk, tissue, field)
template <class Belongs>
void VoxelSet::collect(const Bone& bone, const Belongs& belongs) {
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const TissueId* tissue = bone.brick_tissue(brick);
    const Field* field = bone.brick_field(brick);
    const math::Ijk first = bone.brick_ijk(brick);
    std::array<std::uint64_t, 8> bits = {};
    std::size_t found = 0;
    for (int v = 0; v < kBrickVoxels; ++v) {
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (!bone.grid().contains(at)) continue;
      if (!belongs(at, tissue == nullptr ? TissueId{0} : tissue[v],
                   field == nullptr ? Field{0} : field[v]))
        continue;
      bits[static_cast<std::size_t>(v >> 6)] |= std::uint64_t{1} << (v & 63);
      ++found;
    }
    if (found == 0) continue;
    slot_[static_cast<std::size_t>(brick)] = static_cast<std::int32_t>(bits_.size());
    bits_.push_back(bits);
    count_ += found;
  }
}

VoxelSet VoxelSet::of_tissues(const Bone& bone, std::span<const TissueId> tissues) {
  VoxelSet set(bone);
  std::array<bool, 256> listed = {};
  for (const TissueId tissue : tissues) listed[tissue] = true;
  set.collect(bone, [&](const math::Ijk&, TissueId tissue, Field field) {
    return listed[tissue] &&
           (field >= volume::kIso || bone.tissues()[tissue].kind != TissueKind::solid);
  });
  return set;
}

VoxelSet VoxelSet::of_air(const Bone& bone, std::span<const TissueId> tissues,
                          const Region& region) {
  VoxelSet set(bone);
  set.collect(bone, [&](const math::Ijk& at, TissueId tissue, Field field) {
    return field < volume::kIso &&
           (tissues.empty() ||
            std::find(tissues.begin(), tissues.end(), tissue) != tissues.end()) &&
           contains(region, bone.grid().world_from_grid(at.cast<double>()));
  });
  return set;
}

bool VoxelSet::has(int i, int j, int k) const {
  if (i < 0 || j < 0 || k < 0 || i >= size_.x() || j >= size_.y() || k >= size_.z()) return false;
  const int brick = (i >> 3) + bricks_.x() * ((j >> 3) + bricks_.y() * (k >> 3));
  const std::int32_t slot = slot_[static_cast<std::size_t>(brick)];
  if (slot < 0) return false;
  const int v = (i & 7) + 8 * ((j & 7) + 8 * (k & 7));
  return (bits_[static_cast<std::size_t>(slot)][static_cast<std::size_t>(v >> 6)] >> (v & 63) &
          1) != 0;
}

std::vector<TissueId> tissues_named(const volume::TissueTable& tissues,
                                    std::span<const std::string_view> names) {
  std::vector<TissueId> found;
  for (std::size_t id = 0; id < tissues.tissues.size(); ++id)
    for (const std::string_view name : names)
      if (tissues.tissues[id].name == name) {
        found.push_back(static_cast<TissueId>(id));
        break;
      }
  return found;
}

}  // namespace burr::metrics
