// record/repair.h - makes a complete file from an incomplete or damaged recording: keeps everything
// that is good and lists the rest.
//
// Thread: any. Errors: what could not be read or written, one sentence.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"

namespace burr::record {

struct RepairReport {
  bool was_whole = false;    // the file was complete; nothing was done
  std::uint64_t chunks = 0;  // kept
  std::uint64_t kept_bytes = 0, lost_bytes = 0;
  std::uint64_t ticks = 0;           // kept
  double seconds = 0;                // of the session, up to the last tick kept
  std::vector<std::string> notices;  // what was lost, one sentence each
};

// Reads `path` and trusts nothing in it, writes a complete file beside `out`, then renames it.
// `out` may be `path`. A file that is being recorded is refused. Cancelled or failed: nothing is
// changed.
[[nodiscard]] Result<RepairReport> repair(const std::string& path, const std::string& out,
                                          Progress& progress);

}  // namespace burr::record
