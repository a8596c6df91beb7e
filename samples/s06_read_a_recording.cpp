// s06_read_a_recording - how much of each tissue was removed, from a recording and its bone alone.
//
//     s06_read_a_recording [FILE]      default: session.mcap, which s05_record_a_session writes
//
// Prints a line per tissue, and the sum beside the ledger of the session, which must agree.
#include <burr/record/player.h>
#include <burr/volume/volume_of.h>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
  using namespace burr;
  const auto player = record::Player::open(argc > 1 ? argv[1] : "session.mcap");
  if (!player) return std::printf("%s\n", player.error().text.c_str()), 1;
  const auto before = (*player)->embedded_bone(), after = (*player)->embedded_bone();
  if (!before || !after) return std::printf("the recording holds no bone\n"), 1;
  const Status at_end = (*player)->bone_at((*player)->seconds(), **after);
  if (!at_end) return std::printf("%s\n", at_end.error().text.c_str()), 1;

  double sum = 0;
  for (std::size_t n = 0; n < (*before)->tissues().tissues.size(); ++n) {
    const auto id = static_cast<volume::TissueId>(n);
    const double removed = volume::volume_of(**before, id) - volume::volume_of(**after, id);
    std::printf("%-12s %8.3f mm3\n", (*before)->tissues()[id].name.c_str(), removed * 1e9);
    sum += removed;
  }
  const auto last = (*player)->tick_at((*player)->seconds());
  const double ledger = last ? last->ledger.removed - last->ledger.added : 0;
  std::printf("sum %.3f mm3, ledger %.3f mm3\n", sum * 1e9, ledger * 1e9);
  return std::abs(sum - ledger) <= 1e-3 * ledger ? 0 : 1;
}
