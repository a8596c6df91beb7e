#include "burr/volume/cut_by_depth.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace burr::volume {
namespace {

// Farther outside than this at its middle, a brick has nothing of a shape [voxel].
constexpr double kHalfDiagonal = 3.5 * 1.74;

constexpr TissueId kAdded = 1;  // of what is added, as in a session

}  // namespace

Status cut_by_depth(Bone& bone, const DepthAt& depth, Progress& progress) {
  const Grid& grid = bone.grid();
  constexpr int kEdge = kBrickEdge;
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    const Field* old = bone.brick_field(brick);
    if (old == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(brick);
    // no shape reaches farther than its depth at the middle says; the corners are this far away
    const math::Vec3 middle =
        grid.world_from_grid(first.cast<double>() + math::Vec3::Constant(3.5));
    if (depth(middle) < -(kHalfDiagonal + kRamp) * grid.voxel) continue;
    BrickField now;
    std::memcpy(now.voxel, old, sizeof now.voxel);
    bool cut = false;
    for (int n = 0; n < kBrickVoxels; ++n) {
      if (now.voxel[n] == 0) continue;
      const math::Ijk voxel = first + math::Ijk(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge));
      const double deep = depth(grid.world_from_grid(voxel.cast<double>()));
      const Field left = field_from_depth(-deep / grid.voxel);
      cut = cut || left < now.voxel[n];
      now.voxel[n] = std::min(now.voxel[n], left);
    }
    if (cut) bone.write_brick(brick, now);
  }
  return fine();
}

Status fill_by_depth(Bone& bone, const DepthAt& depth) {
  const Grid& grid = bone.grid();
  constexpr int kEdge = kBrickEdge;
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const math::Ijk first = bone.brick_ijk(brick);
    const math::Vec3 middle =
        grid.world_from_grid(first.cast<double>() + math::Vec3::Constant(3.5));
    if (depth(middle) < -(kHalfDiagonal + kRamp) * grid.voxel) continue;
    BrickField now{};
    if (const Field* old = bone.brick_field(brick); old != nullptr)
      std::memcpy(now.voxel, old, sizeof now.voxel);
    bool any = false;
    std::vector<math::Ijk> grown;  // from air
    for (int n = 0; n < kBrickVoxels; ++n) {
      const math::Ijk voxel = first + math::Ijk(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge));
      if (!grid.contains(voxel)) continue;
      const double deep = depth(grid.world_from_grid(voxel.cast<double>()));
      const Field full = field_from_depth(deep / grid.voxel);
      if (full <= now.voxel[n]) continue;
      any = true;
      if (now.voxel[n] == 0) grown.push_back(voxel);
      now.voxel[n] = full;
    }
    if (!any) continue;
    if (bone.ensure_slot(brick) == kNoSlot)
      return error(
          Trouble::data,
          "the bone has no room left for what is added; raise `reserve_bricks` in its recipe");
    bone.write_brick(brick, now);
    for (const math::Ijk& voxel : grown) bone.set_tissue(voxel.x(), voxel.y(), voxel.z(), kAdded);
  }
  return fine();
}

}  // namespace burr::volume
