// volume/shared_copy.h - a whole bone copied while its writer goes on cutting it.
//
//     rt::ChangedBits& changed = bone.add_watcher();        // before the session
//     ... the servo cuts ...
//     auto copy = shared_copy(bone, changed, progress);      // any other thread
//
// Every brick once, then those that changed meanwhile, again and again, until in one look none had:
// what is copied then is the bone as it was within the last tick. The writer is never waited for
// and never made to wait.
// Without intensity. Thread: any but the writer's, one at a time for one watcher. Memory: while it
// works 1.5 KiB for each brick that is not the same throughout, besides the copy.
#pragma once

#include <memory>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/rt/changed_bits.h"
#include "burr/volume/bone.h"

namespace burr::volume {

// Error: interrupted, or the writer changes all of it faster than it can be copied.
[[nodiscard]] Result<std::unique_ptr<Bone>> shared_copy(const Bone& bone, rt::ChangedBits& changed,
                                                        Progress& progress);

}  // namespace burr::volume
