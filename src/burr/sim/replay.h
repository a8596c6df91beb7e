// sim/replay.h - a recording simulated again and held against itself: every tick's hash, every
// brick as it was written.
//
// Same build, same bits, whichever instruction set the processor takes (docs/recording.md).
// Thread: one.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/sim/session.h"

namespace burr::sim {

struct ReplayOutcome {
  std::uint64_t ticks = 0;   // simulated again
  std::uint64_t bricks = 0;  // compared whole
  std::uint64_t gaps = 0;    // places where recorded ticks are missing; comparing ends at the first
  std::optional<std::uint64_t> parted_at;  // first tick that came out differently
  std::string difference;                  // in words
  std::unique_ptr<volume::Bone> bone;      // at the end
};

// bone: as the session began. Error: the recording's settings cannot be understood, or progress was
// cancelled.
[[nodiscard]] Result<ReplayOutcome> replay(record::Player& player,
                                           std::unique_ptr<volume::Bone> bone, Progress& progress);

}  // namespace burr::sim
