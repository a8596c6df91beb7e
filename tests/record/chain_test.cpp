// A recording whose values were changed, or whose ticks were taken out, is found from the file alone.
#include "burr/record/chain.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "burr/record/player.h"
#include "burr/tick/tick_hash.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using test::any_tick;
using test::Random;
using tick::TickRow;

constexpr std::uint64_t kTicks = 400;

// Ticks 0 .. kTicks - 1 as a servo would hash them.
std::vector<TickRow> session(Random& random) {
  std::vector<TickRow> rows;
  std::uint64_t last = 0;
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    rows.push_back(any_tick(tick, random));
    rows.back().hash = last = tick::tick_hash(rows.back(), last);
  }
  return rows;
}

class ChainTest : public testing::Test {
 protected:
  ChainTest() { std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed)); }

  // "": nothing was found
  std::string found_in(const std::vector<TickRow>& rows) {
    const std::string file = (own_.path() / ("s" + std::to_string(++count_) + ".mcap")).string();
    const auto bone = test::any_bone(random_);
    Recorder recorder(1000);
    EXPECT_TRUE(recorder.start(file, test::info_of(*bone, random_), nullptr).ok());
    for (const TickRow& row : rows) EXPECT_TRUE(recorder.ticks().push(row));
    EXPECT_TRUE(recorder.finish().ok());
    auto player = Player::open(file);
    EXPECT_TRUE(player.ok());
    NoProgress quiet;
    const Status whole = check_chain(**player, quiet);
    if (whole) return "";
    EXPECT_EQ(whole.error().trouble, Trouble::data);
    EXPECT_NE(whole.error().text.find(file), std::string::npos);
    return whole.error().text;
  }

  static constexpr std::uint64_t kSeed = 20261130;
  Random random_{kSeed};
  const test::Folder own_;
  int count_ = 0;
};

TEST_F(ChainTest, ARecordingAsItWasMadeIsWhole) { EXPECT_EQ(found_in(session(random_)), ""); }

TEST_F(ChainTest, EachValueThatWasChangedIsFoundWithItsTick) {
  struct Change {
    const char* name;
    std::function<void(TickRow&)> apply;
  };
  const std::vector<Change> changes = {
      {"force", [](TickRow& row) { row.contact.force *= 0.1; }},
      {"torque",
       [](TickRow& row) {
         row.contact.torque = {1, 2, 3};
       }},
      {"proxy", [](TickRow& row) { row.contact.proxy.x() = 17; }},
      {"normal", [](TickRow& row) { row.contact.normal.z() = 17; }},
      {"depth", [](TickRow& row) { row.contact.depth = 17; }},
      {"flags", [](TickRow& row) { row.contact.flags ^= 1U; }},
      {"touching", [](TickRow& row) { row.contact.touching = !row.contact.touching; }},
      {"place", [](TickRow& row) { row.hand.world_from_tool.p.y() = 17; }},
      {"turn", [](TickRow& row) { row.hand.world_from_tool.q.w() = 17; }},
      {"speed", [](TickRow& row) { row.hand.velocity.z() = 17; }},
      {"pedal", [](TickRow& row) { row.hand.pedal = 17; }},
      {"buttons", [](TickRow& row) { row.hand.buttons ^= 1U; }},
      {"valid", [](TickRow& row) { row.hand.valid = !row.hand.valid; }},
      {"asked", [](TickRow& row) { row.ledger.asked = 17; }},
      {"removed", [](TickRow& row) { row.ledger.removed = 17; }},
      {"not cut", [](TickRow& row) { row.ledger.not_cut = 17; }},
      {"debt", [](TickRow& row) { row.ledger.debt = 17; }},
      {"added", [](TickRow& row) { row.ledger.added = 17; }},
      {"energy", [](TickRow& row) { row.ledger.energy = 17; }},
      {"moved", [](TickRow& row) { row.ledger.moved = 17; }},
      {"spindle", [](TickRow& row) { row.spindle_rad_s = 17; }},
      {"cutting torque", [](TickRow& row) { row.cutting_nm = 17; }},
      {"cutting power", [](TickRow& row) { row.cutting_w = 17; }},
      {"law",
       [](TickRow& row) {
         row.law = {tick::LawRow::kActs, {17, 0, 0}, 0, 0};
       }},
      {"piece",
       [](TickRow& row) {
         row.piece = {tick::PieceRow::kHeld, {17, 0, 0}, {0, 0, 0, 1}};
       }},
      {"hash", [](TickRow& row) { row.hash ^= 1U; }},
  };
  const std::vector<TickRow> rows = session(random_);
  for (const Change& change : changes) {
    std::vector<TickRow> changed = rows;
    const std::uint64_t at = random_() % kTicks;
    change.apply(changed[at]);
    const std::string said = found_in(changed);
    EXPECT_NE(said.find("tick " + std::to_string(at) + " was changed"), std::string::npos)
        << change.name << " of tick " << at << ": " << said;
  }
}

TEST_F(ChainTest, AllForcesTimesATenthAreFoundThoughEveryHashWasLeft) {
  std::vector<TickRow> rows = session(random_);
  for (TickRow& row : rows) row.contact.force *= 0.1;
  EXPECT_NE(found_in(rows).find("tick 0 was changed"), std::string::npos);
}

TEST_F(ChainTest, TicksThatWereTakenOutAreMissed) {
  const std::vector<TickRow> rows = session(random_);
  std::vector<TickRow> middle = rows, front = rows;
  middle.erase(middle.begin() + 100, middle.begin() + 200);
  EXPECT_NE(found_in(middle).find("the ticks before 200 are missing"), std::string::npos);
  front.erase(front.begin(), front.begin() + 10);
  EXPECT_NE(found_in(front).find("the ticks before 10 are missing"), std::string::npos);
}

// Two sessions put together: the first tick of the second one does not follow.
TEST_F(ChainTest, ASpliceOfTwoSessionsIsFound) {
  std::vector<TickRow> rows = session(random_);
  const std::vector<TickRow> other = session(random_);
  std::copy(other.begin() + 250, other.end(), rows.begin() + 250);
  EXPECT_NE(found_in(rows).find("tick 250 was changed"), std::string::npos);
}

}  // namespace
}  // namespace burr::record
