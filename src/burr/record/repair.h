// record/repair.h - makes a torn or damaged recording whole again: everything that is good is kept,
// the rest is named.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"

namespace burr::record {

struct RepairReport {
  bool was_whole = false;    // nothing was done
  std::uint64_t chunks = 0;  // kept
  std::uint64_t kept_bytes = 0, lost_bytes = 0;
  std::uint64_t ticks = 0;           // kept
  double seconds = 0;                // of the session, up to the last tick kept
  std::vector<std::string> notices;  // what was lost, one sentence each
};

// Reads `path` distrusting everything, writes a whole file beside `out`, then renames. `out` may be
// `path`. A file that is being recorded right now is refused. Cancelled or failed: nothing changed.
[[nodiscard]] Result<RepairReport> repair(const std::string& path, const std::string& out,
                                          Progress& progress);

}  // namespace burr::record
