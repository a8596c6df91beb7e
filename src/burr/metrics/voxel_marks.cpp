#include "burr/metrics/voxel_marks.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/volume/bone.h"

namespace burr::metrics {

using math::Ijk;
using math::Vec3;

VoxelMarks::VoxelMarks(const volume::Grid& grid, const VoxelSet& set) : grid_(grid), set_(set) {
  if (set.count() == 0) return;
  for (int a = 0; a < 3; ++a)
    bricks_[a] = (grid.size[a] + volume::kBrickEdge - 1) / volume::kBrickEdge;
  slot_.assign(static_cast<std::size_t>(bricks_.prod()), -1);
  for (std::size_t brick = 0; brick < slot_.size(); ++brick) {
    if (!set.has_any_in(static_cast<volume::BrickIndex>(brick))) continue;
    slot_[brick] = static_cast<std::int32_t>(bits_.size());
    bits_.emplace_back();
  }
}

void VoxelMarks::mark(int i, int j, int k) {
  if (!set_.has(i, j, k)) return;
  const int brick = (i >> 3) + bricks_.x() * ((j >> 3) + bricks_.y() * (k >> 3));
  const std::int32_t slot = slot_[static_cast<std::size_t>(brick)];
  if (slot < 0) return;
  const int v = (i & 7) + 8 * ((j & 7) + 8 * (k & 7));
  std::uint64_t& word = bits_[static_cast<std::size_t>(slot)][static_cast<std::size_t>(v >> 6)];
  const std::uint64_t bit = std::uint64_t{1} << (v & 63);
  count_ += (word & bit) == 0 ? 1 : 0;
  word |= bit;
}

void VoxelMarks::mark_ball(const Vec3& centre, double radius) {
  if (slot_.empty()) return;
  const Vec3 c = grid_.grid_from_world(centre);
  const double r = radius / grid_.voxel;
  Ijk lo, hi;
  for (int a = 0; a < 3; ++a) {
    // clamped: a ball far outside has no voxels
    lo[a] = static_cast<int>(std::ceil(std::clamp(c[a] - r, 0.0, double{1 << 20})));
    hi[a] = static_cast<int>(std::floor(std::clamp(c[a] + r, -1.0, grid_.size[a] - 1.0)));
  }
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j)
      for (int i = lo.x(); i <= hi.x(); ++i)
        if (math::squared_norm(Vec3(i, j, k) - c) <= r * r) mark(i, j, k);
}

}  // namespace burr::metrics
