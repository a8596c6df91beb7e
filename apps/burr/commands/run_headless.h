// apps/burr/commands/run_headless.h - `burr run` without a window: a session that mills by itself.
//
// Thread: main. Errors: one sentence.
#pragma once

#include "burr/base/result.h"
#include "commands/run_folder.h"

namespace burr::app {

inline constexpr double kHeadlessSeconds = 20;  // where --seconds says nothing

// Writes the pictures before, at half time with the burr in the bone, and after, in the same view; the recording; the page.
[[nodiscard]] Status run_headless(const RunOptions& options);

}  // namespace burr::app
