#include "burr/edit/bone_memory.h"

#include <cstddef>
#include <cstring>

namespace burr::edit {
namespace {

bool holds(const volume::Bone& bone, const KeptBrick& kept) {
  const volume::Field* field = bone.brick_field(kept.brick);
  return field != nullptr && std::memcmp(field, kept.field.voxel, sizeof kept.field.voxel) == 0 &&
         std::memcmp(bone.brick_tissue(kept.brick), kept.tissue, sizeof kept.tissue) == 0;
}

}  // namespace

void BoneMemory::note(const UndoStore& undo) {
  for (std::size_t n = 0; n < undo.touched(); ++n)
    first_.try_emplace(undo.original(n).brick, undo.original(n));
}

BoneState BoneMemory::now(const volume::Bone& bone) const {
  BoneState state;
  state.bricks.reserve(first_.size());
  for (const auto& [brick, original] : first_) {
    KeptBrick& kept = state.bricks[brick];
    UndoStore::copy(bone, brick, kept);
  }
  return state;
}

void BoneMemory::put_back(const BoneState& then, BoneWriter& writer) const {
  for (const auto& [brick, original] : first_) {
    const auto kept = then.bricks.find(brick);
    const KeptBrick& wanted = kept != then.bricks.end() ? kept->second : original;
    if (!holds(writer.bone(), wanted)) writer.restore(wanted);
  }
}

}  // namespace burr::edit
