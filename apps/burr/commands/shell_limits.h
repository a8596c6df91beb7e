// apps/burr/commands/shell_limits.h - the limits of the shell (ulimit) that would end burr in the middle
// of its work: the size of a stack, and the number of open files.
#pragma once

#include "burr/base/result.h"

namespace burr::app {

// Call it first in main(), before any other thread runs. Raises the limits as far as the system
// lets burr, for itself and the programs that it starts. Error: a limit is too low and cannot be
// raised; what to do.
[[nodiscard]] Status raise_limits();

}  // namespace burr::app
