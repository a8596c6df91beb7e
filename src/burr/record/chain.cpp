#include "burr/record/chain.h"

#include <fmt/format.h>

#include <algorithm>

#include "burr/tick/tick_hash.h"

namespace burr::record {

bool Chain::add(const tick::TickRow& row, bool after_gap) {
  const bool same = after_gap || tick::tick_hash(row, last_) == row.hash;
  believed_ += after_gap ? 1 : 0;
  last_ = row.hash;
  return same;
}

Status check_chain(Player& player, Progress& progress) {
  constexpr std::uint64_t kReport = 8192;  // ticks between two words of progress
  const auto changed = [&](const tick::TickRow& row, const char* whose) {
    return error(fmt::format(
        "{}: tick {}{} was changed after it was recorded: its values do not give the hash "
        "beside them, so nothing in this recording can be trusted; use the original file",
        player.path(), row.tick, whose));
  };
  Chain first, second;
  std::uint64_t ticks = 0, second_before = 0;
  bool second_there = false;
  StepCursor steps = player.steps();
  Step step;
  while (steps.next(step)) {
    // a recording that was cut at its front begins with a tick that nothing stands before
    const bool gap = step.missing || (ticks == 0 && step.row.tick != 0);
    if (gap && player.dropped_ticks() == 0 && player.holes().empty())
      return error(fmt::format(
          "{}: the ticks before {} are missing, and nothing in the recording says why, so it "
          "cannot be trusted; use the original file",
          player.path(), step.row.tick));
    if (!first.add(step.row, gap)) return changed(step.row, "");
    if (step.second) {
      const bool follows =
          second_there ? step.second->tick == second_before + 1 : step.second->tick == 0;
      if (!second.add(*step.second, !follows)) return changed(*step.second, " of the second hand");
      second_before = step.second->tick;
      second_there = true;
    }
    if (++ticks % kReport == 0) {
      if (progress.cancelled())
        return error(Trouble::interrupted, "the check of the recording was stopped");
      progress.report(static_cast<double>(step.row.tick) /
                          static_cast<double>(std::max<std::uint64_t>(player.end_tick(), 1)),
                      "checking the ticks");
    }
  }
  return player.check_texts();
}

}  // namespace burr::record
