// s06_read_a_recording - how much of each tissue was removed, from a recording and its bone alone.
//
//     s06_read_a_recording [FILE]      default: session.mcap, which s05_record_a_session writes
//
// The bone comes from the file, from its formula, or from the scan that lies beside the recording.
// Prints a line per tissue, and the sum beside the ledger of the session, which must agree.
#include <burr/workshop/recorded_bone.h>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
  burr::NoProgress quiet;
  const auto player = burr::record::Player::open(argc > 1 ? argv[1] : "session.mcap");
  if (!player) return std::printf("%s\n", player.error().text.c_str()), 1;
  const auto tissues = burr::workshop::removed_by_tissue(**player, quiet);
  if (!tissues) return std::printf("%s\n", tissues.error().text.c_str()), 1;

  double sum = 0;
  for (const burr::workshop::TissueLoss& tissue : *tissues) {
    std::printf("%-12s %8.3f mm3\n", tissue.name.c_str(), tissue.removed * 1e9);
    sum += tissue.removed;
  }
  const auto last = (*player)->tick_at((*player)->seconds());
  const double ledger = last ? last->ledger.removed - last->ledger.added : 0;
  std::printf("sum %.3f mm3, ledger %.3f mm3\n", sum * 1e9, ledger * 1e9);
  return std::abs(sum - ledger) <= 1e-3 * ledger ? 0 : 1;
}
