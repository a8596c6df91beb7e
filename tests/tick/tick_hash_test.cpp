#include "burr/tick/tick_hash.h"

#include <gtest/gtest.h>

#include <set>

#include "burr/record/schema.h"
#include "record/made_up.h"

namespace burr::tick {
namespace {

using namespace record::test;

// Every byte of every column, through the file's own list of columns: a field forgotten in the hash
// shows here. Tool and undone volume are not in the hash, so that recordings from before they were written down keep
// theirs.
TEST(TickHash, SeesEveryFieldButToolUndoneTimesAndItself) {
  constexpr std::size_t kTool = 8 + 8 + 4 * 5 + 1;
  BURR_SEEDED(random, 71);
  TickRow row = any_tick(5, random);
  row.hand.valid = row.contact.touching = false;
  const std::uint64_t hash = tick_hash(row, 0);
  EXPECT_NE(tick_hash(row, 1), hash) << "chained";

  record::BytesOut message;
  record::encode_ticks({&row, 1}, message);
  std::set<std::size_t> unseen;
  std::size_t changed = 0;
  for (std::size_t at = 0; at < message.size(); ++at) {
    std::vector<std::uint8_t> bytes(message.span().begin(), message.span().end());
    bytes[at] ^= 1;
    std::vector<TickRow> back;
    if (!record::decode_ticks(bytes, back) || back.size() != 1) continue;  // hit a tag or a length
    record::BytesOut again;
    record::encode_ticks(back, again);
    if (again.size() != message.size() ||
        !std::equal(again.span().begin(), again.span().end(), bytes.begin()))
      continue;
    if (back[0].tool != row.tool) {
      EXPECT_EQ(tick_hash(back[0], 0), hash) << at;
      continue;
    }
    ++changed;
    if (tick_hash(back[0], 0) == hash) unseen.insert(at);
  }
  EXPECT_GE(changed, record::tick_columns_size() - kTool - 8);
  // the times are two floats, the hash and the undone volume are eight bytes each
  EXPECT_EQ(unseen.size(), 4U + 4U + 8U + 8U);
}

}  // namespace
}  // namespace burr::tick
