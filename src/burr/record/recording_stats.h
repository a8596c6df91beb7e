// record/recording_stats.h - the account of a recording. Plain struct. Thread: any.
#pragma once

#include <cstdint>

namespace burr::record {

// Counts of what was written and what was not.
struct RecordingStats {
  std::uint64_t ticks = 0, commands = 0, brick_rows = 0, keyframes = 0;
  std::uint64_t views = 0, events = 0;  // messages of /view and /course
  std::uint64_t dropped_ticks = 0, dropped_commands = 0, dropped_bricks = 0, dropped_notes = 0;
  std::uint64_t written_ticks = 0;  // of the ticks, those given to the kernel: what the file holds
  std::uint64_t bytes = 0;          // of the file
  double longest_pause_s = 0;  // between two chunks given to the kernel; a kill may lose as much
  [[nodiscard]] bool whole() const {
    return dropped_ticks == 0 && dropped_commands == 0 && dropped_bricks == 0 && dropped_notes == 0;
  }
};

}  // namespace burr::record
