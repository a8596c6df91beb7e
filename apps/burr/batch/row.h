// apps/burr/batch/row.h - one row of a manifest: the command line that it stands for, and its work.
//
// Thread: main.
#pragma once

#include <string>
#include <vector>

#include "batch/manifest.h"
#include "batch/row_command.h"
#include "burr/base/result.h"

namespace burr::app {

// "Try again": memory, a full disk, a file that is busy. The exit code is EX_TEMPFAIL of sysexits.h.
inline constexpr Trouble kTryAgain{75};

// Refuses a column that no command has, and those that are not for a batch: what a command writes, and devices.
[[nodiscard]] Status check_columns(const Manifest& manifest);

// more: further options, as on the command line. Error: names line and column.
[[nodiscard]] Result<RowTodo> todo_of(const Manifest& manifest, const ManifestRow& row,
                                      const std::vector<std::string>& more = {});

// Does the work. Error, data: of the row, which will never do; kTryAgain: of this machine, now; interrupted; other kinds: of burr.
[[nodiscard]] Result<CommandResult> do_row(const Manifest& manifest, const ManifestRow& row,
                                           const std::vector<std::string>& more);

}  // namespace burr::app
