#include "burr/proof/cut.h"

#include <cstring>

#include "burr/base/progress.h"
#include "burr/volume/cut_by_depth.h"

namespace burr::proof {
namespace {

using math::Ijk;
using math::Vec3;

constexpr int kCutEdge = volume::kBrickEdge;

Ijk voxel_of(const Ijk& first, int n) {
  return first + Ijk(n % kCutEdge, n / kCutEdge % kCutEdge, n / (kCutEdge * kCutEdge));
}

volume::BrickField content_of(const volume::Bone& bone, volume::BrickIndex brick) {
  volume::BrickField now{};
  if (const volume::Field* was = bone.brick_field(brick); was != nullptr)
    std::memcpy(now.voxel, was, sizeof now.voxel);
  return now;
}

}  // namespace

Status CutBone::cut(const Work& work) {
  NoProgress quiet;
  const auto metres = [](const DepthMm& depth_mm) {
    return [&depth_mm](const Vec3& p) { return 1e-3 * depth_mm(Vec3(p * 1e3)); };
  };
  const DepthMm gone = [&work](const Vec3&mm) { return work.gone(mm); },
                grown = [&work](const Vec3&mm) { return work.grown(mm); };
  if (Status cut = volume::cut_by_depth(bone_, metres(gone), quiet); !cut) return cut;
  return volume::fill_by_depth(bone_, metres(grown));
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
