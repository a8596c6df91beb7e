// volume/copy_of_bone.h - a second bone of the same content: cheaper than making it again from a formula
// or a file.
//
//     auto after = volume::copy_of(*before);      // the same content_hash(), grid, tissues and room to add
//
// It has no watchers. Thread: the writer's of `bone`, or before the session. Memory: that of the bone.
#pragma once

#include <memory>

#include "burr/volume/bone.h"

namespace burr::volume {

[[nodiscard]] std::unique_ptr<Bone> copy_of(const Bone& bone);

}  // namespace burr::volume
