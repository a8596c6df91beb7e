#include "burr/volume/volume_of.h"

namespace burr::volume {
namespace {

double cubic_metres(const Bone& bone, std::int64_t units) {
  const double h = bone.grid().voxel;
  return static_cast<double>(units) / static_cast<double>(kVoxelUnits) * h * h * h;
}

}  // namespace

double volume_of(const Bone& bone) {
  std::int64_t sum = 0;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b)
    if (const Field* field = bone.brick_field(b)) sum += volume_units(field);
  return cubic_metres(bone, sum);
}

double volume_of(const Bone& bone, TissueId tissue) {
  std::int64_t sum = 0;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const Field* field = bone.brick_field(b);
    if (field == nullptr) continue;
    const TissueId* tissues = bone.brick_tissue(b);
    for (int v = 0; v < kBrickVoxels; ++v)
      if (tissues[v] == tissue) sum += volume_units(std::int32_t{field[v]});
  }
  return cubic_metres(bone, sum);
}

}  // namespace burr::volume
