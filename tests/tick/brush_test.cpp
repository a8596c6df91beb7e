// Brushing in whole sessions: the hand presses, the bone comes back, the recording replays.
#include "burr/sim/session.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "burr/device/replayed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kRadius = 2 * kMm;

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
      phantom::slab(), 256);
}

// A servo whose hand is held where it is told.
struct Held {
  Held() : bone(slab()), surface(*bone, {}, 1, quiet), hand({}), servo(*bone, surface, hand, {}) {
    servo.commands().push({CommandKind::burr_radius, kRadius});
    state.world_from_tool.p = {0, 0, 5 * kMm};
    state.pedal = 1;
    for (int n = 0; n < 300; ++n) tick();
  }
  const TickRow& tick() {
    hand.set(state);
    row = servo.tick(false);
    servo.publish();
    EXPECT_LE(row.contact.force.norm(), 3.3 + 1e-9);
    return row;
  }
  void go(const Vec3& to, double speed = 20 * kMm) {
    while ((to - state.world_from_tool.p).norm() > 1e-9) {
      const Vec3 way = to - state.world_from_tool.p;
      state.world_from_tool.p += way.normalized() * std::min(way.norm(), speed * 1e-3);
      tick();
    }
  }
  void mode(ToolMode to) {
    servo.commands().push({CommandKind::tool_mode, static_cast<double>(to)});
  }

  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  device::ReplayedHand hand;
  Servo servo;
  device::HandState state;
  TickRow row;
};

TEST(BackToTheOriginal, APressedBurrIsLiftedOutOfItsHoleAndLeavesTheOriginalBytes) {
  Held held;
  const std::uint64_t hash = held.bone->content_hash();
  const double before = volume::volume_of(*held.bone);
  held.go({0, 0, 0 * kMm});
  held.go({1.5 * kMm, 0, 0 * kMm}, 1 * kMm);
  ASSERT_NE(held.bone->content_hash(), hash);
  EXPECT_LT(held.row.contact.proxy.z(), kRadius - 0.5 * kMm) << "no hole: the test shows nothing";

  const Vec3 deep = held.state.world_from_tool.p;
  held.go({0, 0, 5 * kMm});  // the stroke ends
  for (int n = 0; n < 400; ++n) held.tick();
  held.mode(ToolMode::restore);
  held.go(deep);
  for (int n = 0; n < 1500; ++n) held.tick();
  EXPECT_GT(held.row.contact.proxy.z(), kRadius - 0.2 * kMm) << "the burr rides up";
  for (double y = -1.5; y <= 1.5; y += 0.75)
    for (const double x : {-2.5, 4.0, -2.5}) held.go({x * kMm, y * kMm, 1 * kMm}, 4 * kMm);
  EXPECT_EQ(held.bone->content_hash(), hash);
  const edit::Ledger is = held.row.ledger;
  EXPECT_GT(is.added, 1e-9);
  EXPECT_NEAR(is.asked, is.removed + is.debt + is.not_cut, 1e-6 * is.asked);
  EXPECT_NEAR(volume::volume_of(*held.bone) - before, is.added - is.removed, 1e-6 * is.added);

  // undo takes the brushing back, redo brings it again
  held.mode(ToolMode::touch);
  held.go({0, 0, 6 * kMm});
  for (int n = 0; n < 400; ++n) held.tick();
  const auto settle = [&](CommandKind kind) {
    held.servo.commands().push({kind, 0});
    do held.tick();
    while (held.servo.restoring());
  };
  settle(CommandKind::undo);
  EXPECT_NE(held.bone->content_hash(), hash);
  settle(CommandKind::redo);
  EXPECT_EQ(held.bone->content_hash(), hash);
}

class Recorded : public testing::Test {
 protected:
  const burr::test::Folder folder_;
  const std::string file = folder_ / "s.mcap";
  // Mills a pocket, then works on with these commands; recorded, replayed, compared.
  void expect_same(const std::vector<Command>& commands, const std::vector<Command>& later = {}) {
    NoProgress quiet;
    sim::SessionSettings settings;
    settings.servo.burr.radius = kRadius;
    settings.servo.undo_bricks = 2048;
    settings.surface.reserve_blocks = 1 << 13;
    auto path = surgeon::motion("pocket", {}, kRadius, 2);
    ASSERT_TRUE(path.ok());
    auto made = sim::Session::make(
        slab(), std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}), settings,
        quiet);
    ASSERT_TRUE(made.ok()) << made.error().text;
    sim::Session& session = **made;
    record::SessionInfo info;
    sim::describe(session.settings(), session.hand().spec(), info);
    info.volume.content_hash = session.bone().content_hash();
    info.volume.grid = session.bone().grid();
    info.volume.tissues = session.bone().tissues();
    info.volume.recipe.reserve_bricks = 256;
    record::Recorder recorder(settings.servo.rate_hz);
    ASSERT_TRUE(recorder.start(file, info, &session.bone()).ok());
    session.set_recorder(&recorder);
    session.run(1, quiet);
    const edit::Ledger milled = session.outcome().ledger;
    for (const Command& command : commands) session.command(command);
    session.run(0.5, quiet);
    for (const Command& command : later) session.command(command);
    session.run(0.5, quiet);
    session.set_recorder(nullptr);
    ASSERT_TRUE(recorder.finish().ok());
    EXPECT_GT(session.outcome().ledger.added, milled.added) << "nothing was brushed";

    auto player = record::Player::open(file);
    ASSERT_TRUE(player.ok()) << player.error().text;
    auto kept = slab();
    ASSERT_TRUE((*player)->bone_at(1e9, *kept));
    EXPECT_EQ(kept->content_hash(), session.bone().content_hash()) << "what was written down";
    const auto again = sim::replay(**player, slab(), quiet);
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_FALSE(again->first_different_tick.has_value())
        << *again->first_different_tick << ": " << again->difference;
  }
};

TEST_F(Recorded, BackToTheOriginalReplaysToTheBit) {
  expect_same({{CommandKind::tool_mode, static_cast<double>(ToolMode::restore)}});
}

TEST_F(Recorded, SmoothingReplaysToTheBit) {
  expect_same({{CommandKind::tool_mode, static_cast<double>(ToolMode::smooth)}});
}

TEST_F(Recorded, OneAfterTheOtherWithUndoReplaysToTheBit) {
  expect_same(
      {{CommandKind::tool_mode, static_cast<double>(ToolMode::smooth)}},
      {{CommandKind::undo, 0}, {CommandKind::tool_mode, static_cast<double>(ToolMode::restore)}});
}

TEST(Smooth, APressedBurrTakesTheEdgeOffAHoleAndTheAccountHolds) {
  Held held;
  const double before = volume::volume_of(*held.bone);
  held.go({0, 0, 0.5 * kMm});
  held.go({1.5 * kMm, 0, 0.5 * kMm}, 2 * kMm);
  held.go({0, 0, 5 * kMm});
  for (int n = 0; n < 400; ++n) held.tick();
  const std::uint64_t milled = held.bone->content_hash();
  held.mode(ToolMode::smooth);
  held.go({0, 1.2 * kMm, 1 * kMm});
  for (int n = 0; n < 1000; ++n) held.tick();
  ASSERT_NE(held.bone->content_hash(), milled);
  const edit::Ledger is = held.row.ledger;
  EXPECT_GT(is.added, 0);
  EXPECT_NEAR(is.asked, is.removed + is.debt + is.not_cut, 1e-6 * is.asked);
  EXPECT_NEAR(volume::volume_of(*held.bone) - before, is.added - is.removed, 1e-6 * is.removed);
  held.go({0, 0, 6 * kMm});
  for (int n = 0; n < 400; ++n) held.tick();
  held.servo.commands().push({CommandKind::undo, 0});
  do held.tick();
  while (held.servo.restoring());
  EXPECT_EQ(held.bone->content_hash(), milled);
}

TEST(BackToTheOriginal, TheTickTakesNeitherMemoryNorLock) {
  Held held;
  held.go({0, 0, 0.5 * kMm});
  held.mode(ToolMode::restore);
  const burr::test::RtGuard guard;
  for (int n = 0; n < 1000; ++n) {
    if (n == 500) held.mode(ToolMode::smooth);
    held.tick();
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

}  // namespace
}  // namespace burr::tick
