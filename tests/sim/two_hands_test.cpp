// Two simulated hands in one session: both cut, the account holds, and the recording gives both back to
// the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "burr/device/replayed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/player.h"
#include "burr/record/schema.h"
#include "burr/rt/flags.h"
#include "burr/rt/simd.h"
#include "burr/scenario/rack.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/recording.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::sim {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kMm3 = 1e-9;

tool::ShapedTool of_rack(const char* name) {
  const auto tool = scenario::built_in_rack().get(name);
  EXPECT_TRUE(tool.ok());
  return {tool->name, tool->tool, tool->cutter};
}

device::HandPath path(const char* motion, const Vec3& at, double seconds) {
  const surgeon::WorkPlace place{at, -Vec3::UnitZ()};
  return *surgeon::motion(motion, place, 2 * kMm, seconds);
}

struct Wish {
  const char* second_tool = "fissure-bur";  // nullptr: a suction tube
  Vec3 second_at = {5 * kMm, 0, 0};
  haptics::Method touch = haptics::Method::shaft;
  double seconds = 3;
  bool heat = false;
};

std::unique_ptr<Session> two_hands(const Wish& wish = {}) {
  NoProgress quiet;
  SessionSettings settings;
  settings.servo.burr.radius = 2 * kMm;
  settings.servo.touch = wish.touch;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  if (wish.heat)
    settings.heat = {{{-12 * kMm, -8 * kMm, -8 * kMm}, {12 * kMm, 8 * kMm, 8 * kMm}}, {}};
  auto made = Session::make(
      phantom::bone_from_distance(phantom::box_grid({-12 * kMm, -8 * kMm, -8 * kMm},
                                                    {12 * kMm, 8 * kMm, 8 * kMm}, 0.25 * kMm),
                                  {}, phantom::slab(), 256),
      std::make_unique<device::SimulatedHand>(path("pocket", {-5 * kMm, 0, 0}, wish.seconds),
                                              device::ArmSettings{}),
      settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  tick::SecondHandSettings second;
  if (wish.second_tool != nullptr) second.tool = of_rack(wish.second_tool);
  const Status joined = (*made)->add_second_hand(
      std::make_unique<device::SimulatedHand>(path("stroke", wish.second_at, wish.seconds),
                                              device::ArmSettings{}),
      second);
  EXPECT_TRUE(joined.ok()) << joined.error().text;
  return std::move(*made);
}

TEST(TwoHandsSession, BothCutAndTheAccountHolds) {
  const auto session = two_hands();
  NoProgress quiet;
  const double before = volume::volume_of(session->bone());
  session->run(3, quiet);
  const edit::Ledger all = session->outcome().ledger, own = session->second_hand()->row().ledger;
  EXPECT_GT(own.removed, 0.5 * kMm3);
  EXPECT_GT(all.removed - own.removed, 1 * kMm3) << "the first hand's";
  EXPECT_NEAR(before - volume::volume_of(session->bone()), all.removed, 1e-9 * all.removed);
  EXPECT_NEAR(all.asked, all.removed + all.debt + all.not_cut, 1e-9 * all.asked);
  EXPECT_NEAR(own.asked, own.removed + own.debt + own.not_cut, 1e-9 * own.asked);
  EXPECT_GT(session->second_hand()->row().spindle_rad_s, 0);
}

// The other hand's share alone is what it removes alone, where the two places do not meet.
TEST(TwoHandsSession, NeitherCutsTheOthersDebt) {
  const auto both = two_hands();
  NoProgress quiet;
  both->run(3, quiet);
  const auto alone = two_hands({.second_tool = nullptr, .second_at = {5 * kMm, 0, 3 * kMm}});
  alone->run(3, quiet);
  const double with = both->outcome().ledger.removed - both->second_hand()->row().ledger.removed,
               without = alone->outcome().ledger.removed;
  EXPECT_NEAR(with, without, 1e-3 * without);
}

// What the other hand's tool spends warms the bone as well: the heat's account has it all, and none is
// lost.
TEST(TwoHandsSession, BothWarmTheBone) {
  NoProgress quiet;
  double spent[2] = {0, 0}, second = 0;
  for (const bool two : {false, true}) {
    const auto session = two_hands({.second_tool = two ? "fissure-bur" : nullptr,
                                    .second_at = {5 * kMm, 0, two ? 0 : 3 * kMm},
                                    .seconds = 2,
                                    .heat = true});
    std::vector<double> sum = {0};
    for (int n = 0; n < 2000; ++n) {
      static_cast<void>(session->servo().tick(false));
      session->servo().publish();
      sum.push_back(sum.back() + 1e-3 * session->second_hand()->row().cutting_w);
    }
    session->run(1e-3, quiet);  // waits for the heat
    thermal::HeatSummary heat;
    ASSERT_TRUE(session->heat(heat));
    if (two) second = sum.at(static_cast<std::size_t>(heat.time_ns / 1'000'000));
    const thermal::HeatLedger& all = heat.ledger;
    spent[two ? 1 : 0] = all.spent;
    EXPECT_NEAR(all.into, all.stored + all.convected + all.conducted + all.removed,
                1e-6 * all.into);
  }
  EXPECT_GT(second, 0.1);  // J
  EXPECT_NEAR(spent[1] - spent[0], second, 0.05 * second);
}

TEST(TwoHandsSession, AnUndoTakesBackTheStrokeOfBoth) {
  const auto session = two_hands({.seconds = 2});
  NoProgress quiet;
  const std::uint64_t before = session->bone().content_hash();
  session->run(2, quiet);
  EXPECT_NE(session->bone().content_hash(), before);
  session->command({tick::CommandKind::reset, 0});
  // the hands have come to their end: the servo goes on by itself
  for (int n = 0; n < 3000; ++n) {
    static_cast<void>(session->servo().tick(true));
    session->servo().publish();
  }
  EXPECT_EQ(session->bone().content_hash(), before);
}

TEST(TwoHandsSession, TakesNoMemoryAndNoLock) {
  const auto session = two_hands();
  for (int n = 0; n < 900; ++n) static_cast<void>(session->servo().tick(false));
  session->bone().commit_ahead();
  session->servo().commit_ahead();
  const burr::test::RtGuard guard;
  for (int n = 0; n < 300; ++n) {
    static_cast<void>(session->servo().tick(false));
    session->servo().publish();
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_GT(session->second_hand()->row().ledger.removed, 0);
}

TEST(TwoHandsSession, RefusesAToolThinnerThanAVoxel) {
  NoProgress quiet;
  SessionSettings settings;
  settings.servo.burr.radius = 3 * kMm;
  auto made = Session::make(
      phantom::bone_from_distance(
          phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 1 * kMm), {},
          phantom::slab(), 16),
      std::make_unique<device::SimulatedHand>(path("pocket", Vec3::Zero(), 1),
                                              device::ArmSettings{}),
      settings, quiet);
  ASSERT_TRUE(made.ok()) << made.error().text;
  tick::SecondHandSettings second;
  second.tool = of_rack("sagittal-saw");
  const Status joined =
      (*made)->add_second_hand(std::make_unique<device::SimulatedHand>(
                                   path("pocket", Vec3::Zero(), 1), device::ArmSettings{}),
                               second);
  ASSERT_FALSE(joined.ok());
  EXPECT_EQ(joined.error().trouble, Trouble::usage);
  EXPECT_NE(joined.error().text.find("the second tool sagittal-saw"), std::string::npos);
}

// ---- recorded, read back and simulated again

class TwoHandsReplay : public testing::Test {
 protected:
  const burr::test::Folder folder_;
  const std::string file = folder_ / "s.mcap";

  // with an undo in the middle
  void record(Session& session, double seconds) {
    NoProgress quiet;
    workshop::About about;
    about.motion = "pocket";
    about.embed = true;
    about.recipe.reserve_bricks = 256;
    auto recorder = workshop::record(session, file, about);
    ASSERT_TRUE(recorder.ok()) << recorder.error().text;
    session.run(seconds / 2, quiet);
    session.command({tick::CommandKind::undo, 0});
    session.run(seconds / 2, quiet);
    session.set_recorder(nullptr);
    auto account = (*recorder)->finish();
    ASSERT_TRUE(account.ok()) << account.error().text;
    EXPECT_TRUE(account->whole());
  }
  void expect_the_same(Session& session) {
    NoProgress quiet;
    const rt::Simd best = rt::simd();
    for (const rt::Simd which : {rt::Simd::avx512, rt::Simd::avx2, rt::Simd::scalar}) {
      rt::force_simd(which);
      auto player = record::Player::open(file);
      ASSERT_TRUE(player.ok());
      auto outcome = replay(**player, std::move(*(*player)->embedded_bone(256)), quiet);
      ASSERT_TRUE(outcome.ok()) << outcome.error().text;
      EXPECT_FALSE(outcome->first_different_tick)
          << "tick " << *outcome->first_different_tick << ": " << outcome->difference;
      EXPECT_EQ(outcome->gaps, 0U) << outcome->difference;
      EXPECT_GT(outcome->ticks, 1000U);
      EXPECT_EQ(outcome->bone->content_hash(), session.bone().content_hash());
    }
    rt::force_simd(best);
  }
};

TEST_F(TwoHandsReplay, BothComeOutTheSameToTheBit) {
  const auto session = two_hands({.seconds = 4});
  record(*session, 3);
  expect_the_same(*session);

  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok());
  const auto& info = (*player)->info();
  ASSERT_TRUE(info.second.has_value());
  ASSERT_NE(record::tool_of(info.second), nullptr);
  EXPECT_EQ(info.second->tools.front().name, "fissure-bur");
  record::StepCursor steps = (*player)->steps();
  record::Step step;
  std::uint64_t count = 0;
  int felt = 0;
  while (steps.next(step)) {
    ASSERT_TRUE(step.second.has_value());
    ASSERT_EQ(step.second->tick, step.row.tick);
    felt += step.second->contact.force.norm() > 0.1 ? 1 : 0;
    ++count;
  }
  EXPECT_EQ(count, 3000U);
  EXPECT_GT(felt, 500);
  const auto late = (*player)->step_at(2.5);
  ASSERT_TRUE(late.ok());
  ASSERT_TRUE(late->second.has_value());
  EXPECT_EQ(late->second->tick, late->row.tick);
  EXPECT_EQ(late->second->tool.number, 0);
}

// They work at one place, so that the tools press on each other.
TEST_F(TwoHandsReplay, ToolsThatMeetComeOutTheSameToo) {
  const auto session = two_hands({.second_at = {-4 * kMm, 0.5 * kMm, 0}, .seconds = 4});
  record(*session, 3);
  expect_the_same(*session);
}

TEST_F(TwoHandsReplay, ASuctionTubeComesOutTheSame) {
  const auto session =
      two_hands({.second_tool = nullptr, .touch = haptics::Method::constraint, .seconds = 3});
  record(*session, 2);
  expect_the_same(*session);
  auto player = record::Player::open(file);
  ASSERT_TRUE((*player)->info().second.has_value());
  EXPECT_EQ(record::tool_of((*player)->info().second), nullptr);
  const auto late = (*player)->step_at(1);
  EXPECT_GT(late->second->contact.force.norm(), 0.1) << "it rested on the bone";
  EXPECT_EQ(late->second->ledger.removed, 0);
}

TEST_F(TwoHandsReplay, ItsSettingsAreReadBackAndChecked) {
  const auto session = two_hands({.second_tool = nullptr, .seconds = 3});
  tick::SecondHandSettings changed = session->second_hand()->settings();
  record::SessionInfo info;
  describe(changed, session->second_device().spec(), info);
  auto back = second_of(info, "s.mcap");
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->settings.force.stiffness, changed.force.stiffness);
  EXPECT_EQ(back->settings.slip_m_s, changed.slip_m_s);
  info.second->numbers.erase("friction");
  EXPECT_FALSE(second_of(info, "s.mcap").ok());
  info.second->numbers["friction"] = -1;
  EXPECT_FALSE(second_of(info, "s.mcap").ok());
}

// A session with one hand holds nothing of a second.
TEST_F(TwoHandsReplay, OneHandLeavesNoTraceOfASecond) {
  NoProgress quiet;
  SessionSettings settings;
  settings.servo.burr.radius = 2 * kMm;
  auto made = Session::make(
      phantom::bone_from_distance(
          phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.5 * kMm), {},
          phantom::slab(), 64),
      std::make_unique<device::SimulatedHand>(path("pocket", Vec3::Zero(), 2),
                                              device::ArmSettings{}),
      settings, quiet);
  ASSERT_TRUE(made.ok());
  record(**made, 1);
  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok());
  EXPECT_FALSE((*player)->info().second.has_value());
  EXPECT_FALSE((*player)->step_at(0.5)->second.has_value());
  const auto reader = record::McapReader::open(file);
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE((*reader)->channels_of(record::kSecond.name).empty())
      << "no channel, so that it is as before";
}

}  // namespace
}  // namespace burr::sim
