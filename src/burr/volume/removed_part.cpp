#include "burr/volume/removed_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace burr::volume {
namespace {

bool same_place(const Grid& a, const Grid& b) {
  return a.size == b.size && a.voxel == b.voxel && a.frame.p == b.frame.p &&
         a.frame.q.coeffs() == b.frame.q.coeffs();
}

bool lowered(const Bone& before, const Bone& after, BrickIndex brick) {
  const Field* b = before.brick_field(brick);
  const Field* a = after.brick_field(brick);
  if (b == nullptr) return false;
  for (int v = 0; v < kBrickVoxels; ++v)
    if ((a == nullptr ? Field{0} : a[v]) < b[v]) return true;
  return false;
}

// an unchanged voxel: the cut as its changed neighbours continue it
Field continued(const Bone& before, const Bone& after, const math::Ijk& at) {
  static const std::array<double, 4> away = {0, kFieldPerVoxel, std::sqrt(2.0) * kFieldPerVoxel,
                                             std::sqrt(3.0) * kFieldPerVoxel};
  double best = 0;
  for (int dk = -1; dk <= 1; ++dk)
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const math::Ijk near = at + math::Ijk(di, dj, dk);
        const Field a = after.field(near.x(), near.y(), near.z());
        if (a >= before.field(near.x(), near.y(), near.z())) continue;
        const int steps = std::abs(di) + std::abs(dj) + std::abs(dk);
        best = std::max(best, kSolid - a - away[static_cast<std::size_t>(steps)]);
      }
  const Field old = before.field(at.x(), at.y(), at.z());
  const int most = std::min<int>(old, kSolid - old);  // -|d_before|
  return static_cast<Field>(std::min(best, static_cast<double>(most)));
}

}  // namespace

Result<std::unique_ptr<Bone>> removed_part(const Bone& before, const Bone& after) {
  if (!same_place(before.grid(), after.grid()))
    return error("the two bones do not lie on the same grid, so nothing can be said to be removed");

  // bricks that were cut, and those around them for the rim
  const math::Ijk& bricks = before.bricks();
  std::vector<bool> touched(static_cast<std::size_t>(before.brick_count()));
  for (BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    if (!lowered(before, after, brick)) continue;
    const math::Ijk at = before.brick_ijk(brick) / kBrickEdge;
    for (int k = std::max(at.z() - 1, 0); k <= std::min(at.z() + 1, bricks.z() - 1); ++k)
      for (int j = std::max(at.y() - 1, 0); j <= std::min(at.y() + 1, bricks.y() - 1); ++j)
        for (int i = std::max(at.x() - 1, 0); i <= std::min(at.x() + 1, bricks.x() - 1); ++i)
          touched[static_cast<std::size_t>(before.brick_at(i, j, k))] = true;
  }
  const auto count = static_cast<std::size_t>(std::count(touched.begin(), touched.end(), true));
  auto removed =
      std::make_unique<Bone>(before.grid(), before.tissues(), count, 0, before.has_intensity());

  bool any = false;
  for (BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    if (!touched[static_cast<std::size_t>(brick)]) continue;
    const Field* old_field = before.brick_field(brick);
    const Field* now_field = after.brick_field(brick);
    if (old_field == nullptr) continue;
    const math::Ijk first = before.brick_ijk(brick);
    BrickField content{};
    bool holds = false;
    for (int v = 0; v < kBrickVoxels; ++v) {
      const Field b = old_field[v], a = now_field == nullptr ? Field{0} : now_field[v];
      if (b == 0) continue;
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      content.voxel[v] =
          a < b ? std::min(b, static_cast<Field>(kSolid - a)) : continued(before, after, at);
      holds |= content.voxel[v] != 0;
      any |= content.voxel[v] >= kIso;
    }
    if (!holds) continue;
    std::copy_n(content.voxel, kBrickVoxels, removed->build_field(brick));
    TissueId* tissue = removed->build_tissue(brick);
    const TissueId* old_tissue = before.brick_tissue(brick);
    for (int v = 0; v < kBrickVoxels; ++v)
      tissue[v] = content.voxel[v] != 0 ? old_tissue[v] : TissueId{0};
    if (before.has_intensity())
      std::copy_n(before.brick_intensity(brick), kBrickVoxels, removed->build_intensity(brick));
  }
  if (!any) return error("nothing was removed from this bone yet; export --part bone instead");
  return removed;
}

}  // namespace burr::volume
