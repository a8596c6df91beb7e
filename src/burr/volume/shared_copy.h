// volume/shared_copy.h - copies a whole bone while its writer goes on cutting.
//
//     rt::ChangedBits& changed = bone.add_watcher();        // before the session
//     ... the servo cuts ...
//     auto copy = shared_copy(bone, changed, progress);      // any other thread
//
// Copies every brick once, then those that changed meanwhile, again and again until a pass finds no
// change: the copy is then the bone of at most one tick ago. The copy does not wait for the writer,
// and the writer does not wait for the copy.
// Without intensity. Thread: any but the writer's, one at a time per watcher. Memory, besides the
// copy: 1.5 KiB per brick that is not uniform, while it works.
#pragma once

#include <memory>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/rt/changed_bits.h"
#include "burr/volume/bone.h"

namespace burr::volume {

// Errors: interrupted; or the writer changes bricks faster than they can be copied.
[[nodiscard]] Result<std::unique_ptr<Bone>> shared_copy(const Bone& bone, rt::ChangedBits& changed,
                                                        Progress& progress);

}  // namespace burr::volume
