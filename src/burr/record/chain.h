// record/chain.h - whether the ticks of a recording are those whose hashes stand beside them.
//
//     if (Status whole = record::check_chain(**player, progress); !whole) return whole.error();
//
// Each tick holds a hash of its own values and of the hash before it (tick/tick_hash.h). This computes
// them again from the values that were read, of both hands. So a force, a pose or a volume that somebody
// changed in the file is found without the bone and without simulating anything.
//
// The texts (session, commands, view, course, events) are compared with the sums in the account at the end of a
// finished recording (record/text_sums.h).
//
// What it does not show: a file whose hashes were computed again too. Only a replay on the bone finds that
// (sim/replay.h). The times of a tick, the tool and the undone volume are not part of the hash.
// Thread: as Player. Cost: 1.8 us a tick, reading included (a virtual core, 2026-11-30).
#pragma once

#include <cstdint>
#include <optional>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/tick/rows.h"

namespace burr::record {

// The chain of one hand, tick by tick.
class Chain {
 public:
  // False: the values of this tick do not give its hash. after_gap: the tick before it is missing, so
  // its hash cannot be checked and is believed.
  [[nodiscard]] bool add(const tick::TickRow& row, bool after_gap);
  // Ticks whose hash had to be believed.
  [[nodiscard]] std::uint64_t believed() const { return believed_; }

 private:
  std::uint64_t last_ = 0, believed_ = 0;
};

// Reads all ticks and texts. Error: the first tick that was changed; ticks that are missing though nothing was
// dropped or damaged, so somebody took them out; the topic whose texts were changed; or progress was cancelled.
[[nodiscard]] Status check_chain(Player& player, Progress& progress);

}  // namespace burr::record
