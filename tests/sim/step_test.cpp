// Sessions that are stepped by their caller: the bits of run(), back to an earlier bone, rows and
// voxels in memory.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "burr/device/pushed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/edit/bone_memory.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::sim {
namespace {

using math::Vec3;

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8e-3), Vec3::Constant(8e-3), 0.25e-3), {}, phantom::slab(),
      256);
}

SessionSettings settings() {
  SessionSettings made;
  made.servo.burr.radius = 2e-3;
  made.servo.undo_bricks = 2048;
  made.surface.reserve_blocks = 1 << 13;
  return made;
}

std::unique_ptr<Session> with(std::unique_ptr<device::Device> hand,
                              const SessionSettings& wanted = settings()) {
  NoProgress quiet;
  auto session = Session::make(slab(), std::move(hand), wanted, quiet);
  EXPECT_TRUE(session.ok()) << session.error().text;
  return std::move(*session);
}

// A simulated hand that mills a pocket for so long.
std::unique_ptr<Session> milling(double seconds) {
  auto path = surgeon::motion("pocket", {}, 2e-3, seconds);
  EXPECT_TRUE(path.ok());
  return with(std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}));
}

device::ArmSettings rigid() {
  device::ArmSettings arm;
  arm.stiffness = INFINITY;
  return arm;
}

// A hand that presses the side of the burr along the slab, moved by the test.
class Pushing {
 public:
  Pushing() {
    auto owned = std::make_unique<device::PushedHand>(rigid());
    hand = owned.get();
    session = with(std::move(owned));
  }
  // Down, then so many strokes of 100 ticks.
  void mill(int strokes) {
    const math::Quat leaning(Eigen::AngleAxisd(1, Vec3::UnitX()));
    hand->place({Vec3(-3e-3, 0, 4e-3), leaning}, 1, 0);
    session->step(600, quiet);  // the start ramp
    for (int n = 0; n < strokes; ++n) {
      hand->move({Vec3(n % 2 == 0 ? 3e-3 : -3e-3, 0, 1.2e-3 - 0.1e-3 * n), leaning}, 1, 0, 100);
      session->step(100, quiet);
    }
  }
  std::unique_ptr<Session> session;
  device::PushedHand* hand = nullptr;
  NoProgress quiet;
};

std::vector<std::uint64_t> hashes(Session& session) {
  std::vector<std::uint64_t> all;
  for (const tick::TickRow& row : session.log()->take_rows()) {
    EXPECT_EQ(row.tick, all.size());
    all.push_back(row.hash);
  }
  return all;
}

constexpr double kSeconds = 10;
constexpr std::uint64_t kTicks = 10'000;

TEST(Step, AnySplitGivesEveryTickOfRun) {
  NoProgress quiet;
  const auto running = milling(kSeconds);
  running->keep_in_memory(true, false);
  running->run(kSeconds, quiet);
  const auto wanted = hashes(*running);
  ASSERT_EQ(wanted.size(), kTicks);
  ASSERT_GT(running->outcome().ledger.removed, 1e-9);
  for (const std::vector<std::uint64_t>& split :
       {std::vector<std::uint64_t>{1}, {kTicks}, {7, 64, 1, 200, 65}}) {
    const auto stepping = milling(kSeconds);
    stepping->keep_in_memory(true, false);
    for (std::uint64_t made = 0, n = 0; made < kTicks; ++n) {
      const std::uint64_t wish = std::min(split[n % split.size()], kTicks - made);
      ASSERT_EQ(stepping->step(wish, quiet), wish);
      made += wish;
    }
    EXPECT_EQ(hashes(*stepping), wanted);
    EXPECT_EQ(stepping->bone().content_hash(), running->bone().content_hash());
    const Outcome one = running->outcome(), other = stepping->outcome();
    EXPECT_EQ(other.ticks, one.ticks);
    EXPECT_EQ(other.ledger.removed, one.ledger.removed);
    EXPECT_EQ(other.peak_force, one.peak_force);
    EXPECT_EQ(other.mean_force, one.mean_force);
    EXPECT_EQ(other.flags, one.flags);
  }
}

TEST(Step, EndsWithTheHand) {
  NoProgress quiet;
  const auto session = milling(1);
  EXPECT_EQ(session->step(700, quiet), 700U);
  EXPECT_EQ(session->step(700, quiet), 300U);  // the path ends after 1 s
  EXPECT_EQ(session->step(1, quiet), 0U);
}

TEST(Step, StopsWhenAsked) {
  struct Impatient final : Progress {
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return ++asked > 2; }
    mutable int asked = 0;
  } impatient;
  const auto session = milling(10);
  EXPECT_EQ(session->step(1000, impatient), 128U);
  EXPECT_EQ(session->ticks(), 128U);
}

TEST(Step, TakesNoMemoryAndNoLock) {
  if (!burr::test::RtGuard::watching()) GTEST_SKIP() << "a sanitizer counts by itself";
  NoProgress quiet;
  const auto session = milling(3);
  session->step(200, quiet);
  long allocations = 0, locks = 0;
  {
    const burr::test::RtGuard guard;
    session->step(2800, quiet);
    allocations = guard.allocations();
    locks = guard.locks();
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_GT(session->outcome().ledger.removed, 1e-9);
}

TEST(Step, ARecordingOfStepsIsSimulatedAgainToTheBit) {
  NoProgress quiet;
  const burr::test::Folder folder;
  const std::string file = folder / "s.mcap";
  const auto session = milling(2);
  record::SessionInfo info;
  describe(session->settings(), session->hand().spec(), info);
  info.volume = record::volume_info(session->bone());
  record::Recorder recorder(info.rate_hz);
  ASSERT_TRUE(recorder.start(file, info, &session->bone()).ok());
  session->set_recorder(&recorder);
  for (int n = 0; n < 200; ++n) session->step(10, quiet);
  EXPECT_FALSE(session->reset_to({}).ok());
  session->settle();
  session->set_recorder(nullptr);
  ASSERT_TRUE(recorder.finish().ok());

  auto player = record::Player::open(file);
  ASSERT_TRUE(player.ok()) << player.error().text;
  auto bone = (*player)->embedded_bone(), again = (*player)->embedded_bone();
  ASSERT_TRUE(bone.ok() && again.ok());
  const auto replayed = replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(replayed.ok());
  EXPECT_EQ(replayed->ticks, 2000U);
  EXPECT_FALSE(replayed->first_different_tick) << replayed->difference;
  // the bricks that waited at the end are in the file
  ASSERT_TRUE((*player)->bone_at(2, **again).ok());
  EXPECT_EQ((*again)->content_hash(), session->bone().content_hash());
}

TEST(Step, TwoSessionsInTwoThreadsDisturbEachOtherNot) {
  NoProgress quiet;
  const auto alone = milling(3);
  alone->keep_in_memory(true, true);
  alone->step(3000, quiet);
  const auto wanted = hashes(*alone);
  std::vector<std::unique_ptr<Session>> both;
  both.push_back(milling(3));
  both.push_back(milling(3));
  std::vector<std::thread> threads;
  for (const auto& session : both)
    threads.emplace_back([&session] {
      NoProgress silent;
      session->keep_in_memory(true, true);
      for (int n = 0; n < 150; ++n) session->step(20, silent);
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& session : both) EXPECT_EQ(hashes(*session), wanted);
}

TEST(Reset, GivesTheBoneBack) {
  Pushing pushing;
  Session& session = *pushing.session;
  const std::uint64_t whole = session.bone().content_hash();
  pushing.mill(6);
  const edit::BoneState half = session.bone_state();
  const std::uint64_t half_hash = session.bone().content_hash();
  EXPECT_NE(half_hash, whole);
  pushing.mill(12);
  const edit::BoneState deep = session.bone_state();
  const std::uint64_t deep_hash = session.bone().content_hash();
  EXPECT_NE(deep_hash, half_hash);
  // forth and back, also to states of before another reset
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(session.reset_to(half).ok());
    EXPECT_EQ(session.bone().content_hash(), half_hash);
    pushing.mill(3);
    ASSERT_TRUE(session.reset_to({}).ok());
    EXPECT_EQ(session.bone().content_hash(), whole);
    EXPECT_EQ(session.ticks(), 0U);
    EXPECT_EQ(session.outcome().ledger.removed, 0);
    ASSERT_TRUE(session.reset_to(deep).ok());
    EXPECT_EQ(session.bone().content_hash(), deep_hash);
  }
}

// Everything else starts over as well: the ticks are those of a new session.
TEST(Reset, IsLikeANewSession) {
  Pushing one, other;
  one.session->keep_in_memory(true, true);
  one.mill(8);
  const auto wanted = hashes(*one.session);
  const auto voxels = one.session->log()->take_voxels();
  ASSERT_GT(voxels.size(), 100U);
  other.mill(5);
  other.session->keep_in_memory(true, true);
  other.session->command({tick::CommandKind::stiffness, 300});
  other.mill(5);
  ASSERT_TRUE(other.session->reset_to({}).ok());
  other.mill(8);
  EXPECT_EQ(hashes(*other.session), wanted);
  const auto again = other.session->log()->take_voxels();
  ASSERT_EQ(again.size(), voxels.size());
  for (std::size_t n = 0; n < voxels.size(); ++n)
    EXPECT_EQ(std::tie(again[n].tick, again[n].i, again[n].j, again[n].k, again[n].out),
              std::tie(voxels[n].tick, voxels[n].i, voxels[n].j, voxels[n].k, voxels[n].out));
  // a simulated hand starts over too
  NoProgress quiet;
  const auto path = milling(2);
  path->keep_in_memory(true, false);
  path->step(2000, quiet);
  const auto first = hashes(*path);
  ASSERT_TRUE(path->reset_to({}).ok());
  path->step(2000, quiet);
  EXPECT_EQ(hashes(*path), first);
}

// This method of touch meshes the bone around the burr, by a mesher that is handed on.
TEST(Reset, AlsoWithTheMethodThatTouchesTriangles) {
  NoProgress quiet;
  const auto path = surgeon::motion("pocket", {}, 2e-3, 1);
  ASSERT_TRUE(path.ok());
  SessionSettings triangles = settings();
  triangles.servo.touch = haptics::Method::triangles;
  const auto session =
      with(std::make_unique<device::SimulatedHand>(*path, device::ArmSettings{}), triangles);
  session->keep_in_memory(true, false);
  session->step(1500, quiet);
  const auto first = hashes(*session);
  ASSERT_GT(session->outcome().ledger.removed, 0);
  const edit::BoneState cut = session->bone_state();
  for (int n = 0; n < 2; ++n) {  // the second time the mesher comes from a servo that got it itself
    ASSERT_TRUE(session->reset_to(cut).ok());
    session->step(200, quiet);
    ASSERT_TRUE(session->reset_to({}).ok());
    session->step(1500, quiet);
    EXPECT_EQ(hashes(*session), first);
  }
}

TEST(Crossed, AreTheVoxelsThatDifferAfterwards) {
  Pushing pushing;
  Session& session = *pushing.session;
  session.keep_in_memory(false, true);
  const auto before = session.bone_before();
  pushing.mill(9);
  pushing.mill(12);
  session.command({tick::CommandKind::undo});  // the second time
  pushing.hand->move({Vec3(0, 0, 9e-3), math::Quat::Identity()}, 0, 0, 400);
  session.step(1500, pushing.quiet);
  std::set<std::tuple<int, int, int>> out;
  std::uint64_t last = 0;
  std::size_t back = 0;
  for (const CrossedVoxel& voxel : session.log()->take_voxels()) {
    EXPECT_GE(voxel.tick, last);
    last = voxel.tick;
    if (voxel.out) {
      EXPECT_TRUE(out.emplace(voxel.i, voxel.j, voxel.k).second);
    } else {
      EXPECT_EQ(out.erase({voxel.i, voxel.j, voxel.k}), 1U);
      ++back;
    }
  }
  EXPECT_LT(last, session.ticks());
  EXPECT_GT(back, 0U);  // the undo
  EXPECT_GT(out.size(), 100U);
  std::size_t differ = 0;
  const math::Ijk& size = before->grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
        if (before->field(i, j, k) >= volume::kIso &&
            session.bone().field(i, j, k) < volume::kIso) {
          ++differ;
          EXPECT_EQ(out.count({i, j, k}), 1U);
        }
  EXPECT_EQ(differ, out.size());
}

TEST(PushedHand, GoesEvenlyWhereItIsTold) {
  device::PushedHand hand(rigid());
  ASSERT_TRUE(hand.open().ok());
  const math::Quat turned(Eigen::AngleAxisd(0.8, Vec3::UnitY()));
  hand.move({Vec3(1, 0, 0), math::Quat::Identity()}, 0.5, 3, 10);  // the first: it is there at once
  device::HandState now = hand.state(1e-3);
  EXPECT_EQ(now.world_from_tool.p, Vec3(1, 0, 0));
  EXPECT_EQ(now.velocity, Vec3::Zero());
  EXPECT_EQ(now.pedal, 0.5);
  EXPECT_EQ(now.buttons, 3U);
  hand.move({Vec3(2, 0, 0), turned}, 1, 0, 4);
  for (int n = 1; n <= 4; ++n) {
    now = hand.state(1e-3);
    EXPECT_NEAR(now.world_from_tool.p.x(), 1 + 0.25 * n, 1e-12);
    EXPECT_NEAR(now.velocity.x(), 250, 1e-9);
    EXPECT_NEAR(now.world_from_tool.q.angularDistance(math::Quat::Identity()), 0.2 * n, 1e-6);
  }
  EXPECT_EQ(now.world_from_tool.q.coeffs(), turned.coeffs());
  now = hand.state(1e-3);
  EXPECT_EQ(now.velocity, Vec3::Zero());
  hand.place({Vec3(5, 5, 5), turned}, 0, 0);
  now = hand.state(1e-3);
  EXPECT_EQ(now.world_from_tool.p, Vec3(5, 5, 5));
  EXPECT_EQ(now.velocity, Vec3::Zero());
}

TEST(PushedHand, MovesFromWhereItWasPlacedAlsoWithoutATickBetween) {
  device::PushedHand hand(rigid());
  ASSERT_TRUE(hand.open().ok());
  hand.place({Vec3(0, 0, 5), math::Quat::Identity()}, 0, 0);
  hand.move({Vec3(0, 0, 4), math::Quat::Identity()}, 0, 0, 4);
  for (const double z : {4.75, 4.5, 4.25, 4.0, 4.0})
    EXPECT_EQ(hand.state(1e-3).world_from_tool.p, Vec3(0, 0, z));
}

TEST(PushedHand, YieldsWhereItsArmIsSoft) {
  device::PushedHand hand(device::ArmSettings{.mass = 0.1, .damping = 10, .stiffness = 500});
  ASSERT_TRUE(hand.open().ok());
  hand.place({}, 0, 0);
  for (int n = 0; n < 3000; ++n) {
    static_cast<void>(hand.state(1e-3));
    hand.write_force(Vec3(1, 0, 0));
  }
  EXPECT_NEAR(hand.now().world_from_tool.p.x(), 1.0 / 500, 1e-6);
  EXPECT_EQ(hand.goal().p, Vec3::Zero());
}

}  // namespace
}  // namespace burr::sim
