#include "burr/scoring/reference.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "burr/base/check.h"
#include "burr/metrics/region.h"
#include "burr/scoring/workpiece.h"

namespace burr::scoring {
namespace {

metrics::Region plan_of(const scenario::Reference& reference, Workpiece& scene) {
  metrics::Region all = scene.regions(reference.remove);
  for (const auto& [structure, thickness] : reference.leave)
    if (!scene.tissues(structure).empty())
      all = metrics::without(std::move(all), metrics::within(scene.distance(structure), thickness));
  return all;
}

// Farther outside than this at its middle, a brick has nothing of a region [voxel].
constexpr double kHalfDiagonal = 3.5 * 1.74;

constexpr volume::TissueId kAdded = 1;  // of what is added, as in a session

Status fill(volume::Bone& bone, const metrics::Region& plan) {
  const volume::Grid& grid = bone.grid();
  constexpr int kEdge = volume::kBrickEdge;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const math::Ijk first = bone.brick_ijk(brick);
    const math::Vec3 middle =
        grid.world_from_grid(first.cast<double>() + math::Vec3::Constant(3.5));
    if (plan(middle) < -(kHalfDiagonal + volume::kRamp) * grid.voxel) continue;
    volume::BrickField now{};
    if (const volume::Field* old = bone.brick_field(brick); old != nullptr)
      std::memcpy(now.voxel, old, sizeof now.voxel);
    bool any = false;
    std::vector<math::Ijk> grown;  // from air
    for (int n = 0; n < volume::kBrickVoxels; ++n) {
      const math::Ijk voxel = first + math::Ijk(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge));
      if (!grid.contains(voxel)) continue;
      const double depth = plan(grid.world_from_grid(voxel.cast<double>()));
      const volume::Field full = volume::field_from_depth(depth / grid.voxel);
      if (full <= now.voxel[n]) continue;
      any = true;
      if (now.voxel[n] == 0) grown.push_back(voxel);
      now.voxel[n] = full;
    }
    if (!any) continue;
    if (bone.ensure_slot(brick) == volume::kNoSlot)
      return error(Trouble::data, "the bone has no room left for what the reference adds");
    bone.write_brick(brick, now);
    for (const math::Ijk& voxel : grown) bone.set_tissue(voxel.x(), voxel.y(), voxel.z(), kAdded);
  }
  return fine();
}

}  // namespace

Status cut_to_reference(volume::Bone& bone, const volume::Bone& before,
                        const scenario::CaseLesson& lesson, Progress& progress) {
  BURR_CHECK(lesson.reference && !lesson.reference->remove.empty());
  Workpiece scene(before, before, lesson, progress);
  const metrics::Region plan = plan_of(*lesson.reference, scene);
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  const volume::Grid& grid = before.grid();
  constexpr int kEdge = volume::kBrickEdge;
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    const volume::Field* old = before.brick_field(brick);
    if (old == nullptr) continue;
    const math::Ijk first = before.brick_ijk(brick);
    // no region reaches farther than its depth at the middle says; the corners are this far away
    const math::Vec3 middle =
        grid.world_from_grid(first.cast<double>() + math::Vec3::Constant(3.5));
    if (plan(middle) < -(kHalfDiagonal + volume::kRamp) * grid.voxel) continue;
    volume::BrickField now;
    std::memcpy(now.voxel, old, sizeof now.voxel);
    bool cut = false;
    for (int n = 0; n < volume::kBrickVoxels; ++n) {
      if (now.voxel[n] == 0) continue;
      const math::Ijk voxel = first + math::Ijk(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge));
      const double depth = plan(grid.world_from_grid(voxel.cast<double>()));
      const volume::Field left = volume::field_from_depth(-depth / grid.voxel);
      cut = cut || left < now.voxel[n];
      now.voxel[n] = std::min(now.voxel[n], left);
    }
    if (cut) bone.write_brick(brick, now);
  }
  if (!lesson.reference->fill.empty()) return fill(bone, scene.regions(lesson.reference->fill));
  return fine();
}

}  // namespace burr::scoring
