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

// Farther outside than this at its middle, a brick has nothing of a region [voxel].
constexpr double kHalfDiagonal = 3.5 * 1.74;

constexpr volume::TissueId kAdded = 1;  // of what is added, as in a session

}  // namespace

Status fill_region(volume::Bone& bone, const metrics::Region& plan) {
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

Result<ReferencePlan> reference_plan(const volume::Bone& before, const scenario::CaseLesson& lesson,
                                     Progress& progress) {
  Workpiece scene(before, before, lesson, progress);
  ReferencePlan plan = reference_plan_of(scene);
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  return plan;
}

ReferencePlan reference_plan_of(Workpiece& scene) {
  const scenario::CaseLesson& lesson = scene.lesson();
  BURR_CHECK(lesson.reference && !lesson.reference->remove.empty());
  ReferencePlan plan;
  for (const std::string& name : lesson.reference->remove) {
    metrics::Region region = scene.region(name);
    for (const auto& [structure, thickness] : lesson.reference->leave)
      if (!scene.tissues(structure).empty())
        region = metrics::without(std::move(region),
                                  metrics::within(scene.distance(structure), thickness));
    plan.remove.push_back({name, std::move(region)});
  }
  for (const std::string& name : lesson.reference->fill)
    plan.fill.push_back({name, scene.region(name)});
  return plan;
}

Result<std::vector<SparedStructure>> spared_structures(const volume::Bone& before,
                                                       const scenario::CaseLesson& lesson,
                                                       Progress& progress) {
  Workpiece scene(before, before, lesson, progress);
  std::vector<SparedStructure> all;
  for (const scenario::Structure& one : lesson.structures) {
    std::vector<volume::TissueId> tissues = scene.tissues(one.name);
    if (one.intact != scenario::Intact::unsaid && !tissues.empty())
      all.push_back({one.name, std::move(tissues), scene.distance(one.name)});
  }
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  return all;
}

metrics::Region all_of(const std::vector<ReferencePlan::Part>& parts) {
  BURR_CHECK(!parts.empty());
  metrics::Region all = parts.front().region;
  for (std::size_t n = 1; n < parts.size(); ++n)
    all = metrics::either(std::move(all), parts[n].region);
  return all;
}

Status cut_region(volume::Bone& bone, const metrics::Region& plan, Progress& progress) {
  const volume::Grid& grid = bone.grid();
  constexpr int kEdge = volume::kBrickEdge;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    const volume::Field* old = bone.brick_field(brick);
    if (old == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(brick);
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
  return fine();
}

Status cut_to_reference(volume::Bone& bone, const volume::Bone& before,
                        const scenario::CaseLesson& lesson, Progress& progress) {
  const auto plan = reference_plan(before, lesson, progress);
  if (!plan) return plan.error();
  if (const Status cut = cut_region(bone, all_of(plan->remove), progress); !cut) return cut;
  return plan->fill.empty() ? fine() : fill_region(bone, all_of(plan->fill));
}

}  // namespace burr::scoring
