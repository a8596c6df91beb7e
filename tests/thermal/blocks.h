// tests/thermal/blocks.h - bones of whole voxels with known heat conduction.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "burr/thermal/heat_grid.h"
#include "burr/volume/bone.h"

namespace burr::test {

// tissue_at(i, j, k): 0 air, otherwise a voxel full of that tissue; voxel faces lie at 0, voxel, 2
// voxel ... of the world.
inline std::unique_ptr<volume::Bone> block(
    const math::Ijk& size, double voxel,
    const std::function<int(int, int, int)>& tissue_at = [](int, int, int) { return 1; },
    volume::TissueTable tissues = {}) {
  volume::Grid grid;
  grid.size = size;
  grid.voxel = voxel;
  grid.frame.p = math::Vec3::Constant(voxel / 2);
  std::vector<volume::Field> field;
  std::vector<volume::TissueId> tissue;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        const auto id = static_cast<volume::TissueId>(tissue_at(i, j, k));
        tissue.push_back(id);
        const bool solid = tissues[id].kind == volume::TissueKind::solid;
        field.push_back(solid ? volume::kSolid : volume::Field{0});
      }
  return volume::bone_from_arrays(grid, std::move(tissues), field, tissue, {}, 64);
}

// Tissue 2 is like tissue 1, but may be given another material.
inline volume::TissueTable two_bones() {
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "other bone"});
  return tissues;
}

inline math::Aabb everything(const volume::Bone& bone) {
  return {math::Vec3::Zero(), bone.grid().size.cast<double>() * bone.grid().voxel};
}

// Voxels [lo, end) become air.
inline void cut_out(volume::Bone& bone, const math::Ijk& lo, const math::Ijk& end) {
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    volume::BrickField content;
    if (bone.brick_field(brick) == nullptr || !bone.copy_brick(brick, content)) continue;
    const math::Ijk first = bone.brick_ijk(brick);
    bool any = false;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const math::Ijk at = first + math::Ijk(v % 8, v / 8 % 8, v / 64);
      if ((at.array() < lo.array()).any() || (at.array() >= end.array()).any()) continue;
      content.voxel[v] = 0;
      any = true;
    }
    if (any) bone.write_brick(brick, content);
  }
}

// Error of the account, as a share of the heat put in.
inline double imbalance(const thermal::HeatLedger& l) {
  return std::abs(l.into - l.stored - l.convected - l.conducted - l.removed) / std::abs(l.into);
}

}  // namespace burr::test
