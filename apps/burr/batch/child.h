// apps/burr/batch/child.h - a row is done in a process of its own, forked from the batch: what a row leaves in memory touches no other
// row, and one that crashes or runs out of memory does not take the shard with it.
//
// Thread: main, and no other thread may run. SIGTERM, SIGHUP and Ctrl-C are passed on to the child, once.
#pragma once

#include <functional>

#include "burr/base/result.h"

namespace burr::app {

struct ChildEnd {
  int code = 0;    // its exit code
  int signal = 0;  // that ended it; 0: none
};

// work: returns the exit code. Error: no process can be started. If the batch is killed, so is the child.
[[nodiscard]] Result<ChildEnd> in_child(const std::function<int()>& work);

}  // namespace burr::app
