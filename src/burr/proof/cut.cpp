#include "burr/proof/cut.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "burr/volume/grid.h"

namespace burr::proof {
namespace {

using math::Ijk;
using math::Vec3;

constexpr int kCutEdge = volume::kBrickEdge;
constexpr volume::TissueId kAddedBone = 1;  // of what is added, as in a session
// Farther outside than this at its middle, a brick has nothing of a shape: half a diagonal, and the ramp [voxel].
constexpr double kCutReach = 3.5 * 1.7321 + volume::kRamp;

Ijk voxel_of(const Ijk& first, int n) {
  return first + Ijk(n % kCutEdge, n / kCutEdge % kCutEdge, n / (kCutEdge * kCutEdge));
}

Vec3 world_mm(const volume::Grid& grid, const Vec3& voxel) {
  return grid.world_from_grid(voxel) * 1e3;
}

volume::BrickField content_of(const volume::Bone& bone, volume::BrickIndex brick) {
  volume::BrickField now{};
  if (const volume::Field* was = bone.brick_field(brick); was != nullptr)
    std::memcpy(now.voxel, was, sizeof now.voxel);
  return now;
}

}  // namespace

void CutBone::take(volume::BrickIndex brick, const Work& work) {
  const volume::Grid& grid = bone_.grid();
  const Ijk first = bone_.brick_ijk(brick);
  const double voxel_mm = grid.voxel * 1e3;
  volume::BrickField now = content_of(bone_, brick);
  bool changed = false;
  for (int n = 0; n < volume::kBrickVoxels; ++n) {
    if (now.voxel[n] == 0) continue;
    const double depth = work.gone(world_mm(grid, voxel_of(first, n).cast<double>()));
    const volume::Field left = volume::field_from_depth(-depth / voxel_mm);
    changed = changed || left < now.voxel[n];
    now.voxel[n] = std::min(now.voxel[n], left);
  }
  if (changed) bone_.write_brick(brick, now);
}

Status CutBone::add(volume::BrickIndex brick, const Work& work) {
  const volume::Grid& grid = bone_.grid();
  const Ijk first = bone_.brick_ijk(brick);
  const double voxel_mm = grid.voxel * 1e3;
  volume::BrickField now = content_of(bone_, brick);
  std::vector<Ijk> from_air;
  bool changed = false;
  for (int n = 0; n < volume::kBrickVoxels; ++n) {
    const Ijk voxel = voxel_of(first, n);
    if (!grid.contains(voxel)) continue;
    const double depth = work.grown(world_mm(grid, voxel.cast<double>()));
    const volume::Field full = volume::field_from_depth(depth / voxel_mm);
    if (full <= now.voxel[n]) continue;
    changed = true;
    if (now.voxel[n] == 0) from_air.push_back(voxel);
    now.voxel[n] = full;
  }
  if (!changed) return fine();
  if (bone_.ensure_slot(brick) == volume::kNoSlot)
    return error(
        Trouble::data,
        "the bone has no room for what the shapes add; raise reserve_bricks in its recipe");
  bone_.write_brick(brick, now);
  for (const Ijk& voxel : from_air) bone_.set_tissue(voxel.x(), voxel.y(), voxel.z(), kAddedBone);
  return fine();
}

Status CutBone::cut(const Work& work) {
  const volume::Grid& grid = bone_.grid();
  const double reach_mm = kCutReach * grid.voxel * 1e3;
  for (volume::BrickIndex brick = 0; brick < bone_.brick_count(); ++brick) {
    const Vec3 middle = world_mm(grid, bone_.brick_ijk(brick).cast<double>() + Vec3::Constant(3.5));
    if (bone_.brick_field(brick) != nullptr && work.gone(middle) > -reach_mm) take(brick, work);
    if (work.grown(middle) > -reach_mm)
      if (Status added = add(brick, work); !added) return added;
  }
  return fine();
}

void CutBone::restore() {
  for (volume::BrickIndex brick = 0; brick < bone_.brick_count(); ++brick) {
    if (bone_.brick_field(brick) == nullptr) continue;  // nothing was ever written there
    const volume::BrickField was = content_of(before_, brick);
    if (std::memcmp(was.voxel, bone_.brick_field(brick), sizeof was.voxel) == 0) continue;
    bone_.write_brick(brick, was);
    const Ijk first = bone_.brick_ijk(brick);
    for (int n = 0; n < volume::kBrickVoxels; ++n) {
      const Ijk v = voxel_of(first, n);
      const volume::TissueId tissue = before_.tissue(v.x(), v.y(), v.z());
      if (bone_.tissue(v.x(), v.y(), v.z()) != tissue)
        bone_.set_tissue(v.x(), v.y(), v.z(), tissue);
    }
  }
}

}  // namespace burr::proof
