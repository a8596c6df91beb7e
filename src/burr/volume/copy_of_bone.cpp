#include "burr/volume/copy_of_bone.h"

#include <algorithm>

namespace burr::volume {
namespace {

constexpr TissueId kNoTissue[kBrickVoxels] = {};

}  // namespace

std::unique_ptr<Bone> copy_of(const Bone& bone) {
  auto copy = std::make_unique<Bone>(bone.grid(), bone.tissues(), bone.used_slots(),
                                     bone.free_slots(), bone.has_intensity());
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const Field* field = bone.brick_field(brick);
    if (field == nullptr) continue;
    const TissueId* tissue = bone.brick_tissue(brick);
    copy->build_brick(brick, field, tissue != nullptr ? tissue : kNoTissue);
    if (bone.has_intensity())
      std::copy_n(bone.brick_intensity(brick), kBrickVoxels, copy->build_intensity(brick));
  }
  copy->pack();
  return copy;
}

}  // namespace burr::volume
