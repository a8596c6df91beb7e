// edit/bone_memory.h - a bone as it was at a moment, and back to it: only the bricks that changed.
//
//     BoneMemory memory;
//     memory.note(undo);                        // what has changed since the bone was opened
//     const BoneState then = memory.now(bone);
//     ... cutting ...
//     memory.note(undo);
//     memory.put_back(then, writer);
//
// Thread: one; the servo stands still. Memory: 1.6 KiB for each brick that was ever changed, and the
// same again for each state.
#pragma once

#include <unordered_map>

#include "burr/edit/bone_writer.h"
#include "burr/edit/undo.h"
#include "burr/volume/bone.h"

namespace burr::edit {

// A brick that is not here is as it was when the bone was opened.
struct BoneState {
  std::unordered_map<volume::BrickIndex, KeptBrick> bricks;
};

class BoneMemory {
 public:
  // Takes over what this store keeps from its start. Call it before the store is given up.
  void note(const UndoStore& undo);
  [[nodiscard]] BoneState now(const volume::Bone& bone) const;
  // Not in the account, and not to be undone.
  void put_back(const BoneState& then, BoneWriter& writer) const;

 private:
  std::unordered_map<volume::BrickIndex, KeptBrick> first_;  // as when the bone was opened
};

}  // namespace burr::edit
