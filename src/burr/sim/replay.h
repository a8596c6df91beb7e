// sim/replay.h - simulates a recording again and compares every tick's hash and every brick with
// what was recorded.
// So are those of a second hand, where one took part.
//
// The same build gives the same bits, whichever instruction set the processor has
// (docs/use/recording.md). Thread: one.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/record/player.h"
#include "burr/sim/row_log.h"
#include "burr/sim/session.h"
#include "burr/tick/own_law.h"

namespace burr::sim {

struct ReplayOutcome {
  std::uint64_t ticks = 0;   // simulated again
  std::uint64_t bricks = 0;  // compared whole
  std::uint64_t gaps = 0;    // places where recorded ticks are missing; the comparison ends at the
                             // first
  std::optional<std::uint64_t> first_different_tick;  // first tick with a different result
  std::string difference;                             // in words
  std::unique_ptr<volume::Bone> bone;                 // at the end
  edit::PieceStore pieces;                            // that were moved
};

// bone: as at the start of the session. law: the compiled one of the session; the answers of a function of
// Python are in the recording. Error: the recording's settings cannot be understood, it needs another law, or
// progress was cancelled.
// log: of this bone; gets the rows and the voxels of each tick. nullptr: nobody wants them.
[[nodiscard]] Result<ReplayOutcome> replay(record::Player& player,
                                           std::unique_ptr<volume::Bone> bone, Progress& progress,
                                           RowLog* log = nullptr, tick::OwnLaw* law = nullptr);

}  // namespace burr::sim
