// Suction takes splinters: small loose bone near the mouth of a tube. The servo writes it, the ledger has it, an undo
// brings it back, and a replay gives the same bits.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "burr/device/replayed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/sim/piece_mover.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"
#include "support/folder.h"

namespace burr::sim {
namespace {

using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;

// Where the splinters are: one that the hand cuts free, and one that lies free from the start.
const Vec3 kSplinter = Vec3(0, 0, 10) * kMm, kOld = Vec3(5, 5, 9.5) * kMm;
constexpr double kHalf = 0.6 * kMm;  // half a side of them

// A block of 16 mm with a stub that stands on a neck. whole: it stands free already.
std::unique_ptr<volume::Bone> bone_with_stub(bool free) {
  const phantom::Depth block = phantom::box({8 * kMm, 8 * kMm, 8 * kMm}),
                       stub = phantom::box(Vec3::Constant(kHalf)),
                       neck = phantom::box({0.5 * kMm, 0.5 * kMm, 1.5 * kMm});
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3(-10, -10, -10) * kMm, Vec3(10, 10, 13) * kMm, kVoxel), {},
      [=](const Vec3& p) {
        double deepest = std::max({block(p), stub(p - kSplinter), stub(p - kOld)});
        if (!free) deepest = std::max(deepest, neck(p - Vec3(0, 0, 8.5) * kMm));
        return deepest;
      },
      1024);
}

std::int64_t units(const volume::Bone& bone) {
  std::int64_t sum = 0;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    if (bone.brick_field(brick) != nullptr) sum += volume::volume_units(bone.brick_field(brick));
  return sum;
}
constexpr double kUnit = kVoxel * kVoxel * kVoxel / static_cast<double>(volume::kVoxelUnits);

SessionSettings settings() {
  SessionSettings settings;
  settings.servo.burr.radius = 0.6 * kMm;
  settings.surface.reserve_blocks = 1 << 13;
  return settings;
}

// A session with a tube in the other hand, over a bone that stands still or is cut by a hand.
std::unique_ptr<Session> session_of(std::unique_ptr<volume::Bone> bone, bool cuts) {
  NoProgress quiet;
  device::HandPath path;
  const auto at = [&path](double t, double y, double pedal) {
    path.points.push_back({t, {Vec3(0, y, 8.7) * kMm, Quat::Identity()}, pedal});
  };
  at(0, -5, 0);
  at(0.7, -5, cuts ? 1 : 0);
  at(2.7, cuts ? 5 : -5, cuts ? 1 : 0);
  at(1e6, cuts ? 5 : -5, 0);
  auto made = Session::make(std::move(bone),
                            std::make_unique<device::SimulatedHand>(
                                std::move(path), device::ArmSettings{.stiffness = INFINITY}),
                            settings(), quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  EXPECT_TRUE(
      (*made)
          ->add_second_hand(std::make_unique<device::ReplayedHand>(device::DeviceSpec{}), {})
          .ok());
  return std::move(*made);
}

struct ReadySplinter {
  edit::PieceMove move;
  std::shared_ptr<const edit::MovedBricks> bricks;
};
ReadySplinter prepared(Session& session, const Vec3& at) {
  ReadySplinter ready;
  const math::Ijk seed = session.bone().grid().grid_from_world(at).array().round().cast<int>();
  for (std::size_t axis = 0; axis < 3; ++axis) ready.move.seed[axis] = seed[static_cast<int>(axis)];
  ready.move.writes = session.servo().writes_done();
  const auto bricks = edit::PieceStore{}.prepare_splinter(session.bone(), ready.move);
  EXPECT_TRUE(bricks.ok()) << (bricks.ok() ? "" : bricks.error().text);
  if (!bricks.ok()) return ready;
  ready.bricks = *bricks;
  ready.move.bricks = ready.bricks->hash;
  return ready;
}

TEST(Splinter, IsTakenWithItsVolumeAndComesBackByUndo) {
  NoProgress quiet;
  const auto session = session_of(bone_with_stub(true), false);
  const auto fresh = bone_with_stub(true);
  const std::uint64_t at_start = fresh->content_hash();
  const std::int64_t before = units(*fresh);
  session->run(0.2, quiet);
  const ReadySplinter ready = prepared(*session, kSplinter);
  ASSERT_NE(ready.bricks, nullptr);
  EXPECT_NEAR(static_cast<double>(ready.bricks->lost) * kUnit, 8 * std::pow(kHalf, 3),
              0.15 * 8 * std::pow(kHalf, 3));
  ASSERT_TRUE(session->take_splinter(ready.move, true, ready.bricks));
  session->run(0.002, quiet);
  ASSERT_EQ(session->move_state(), tick::MoveState::done);
  session->run(0.2, quiet);
  EXPECT_EQ(before - units(session->bone()), ready.bricks->lost);
  tick::TickRow row;
  ASSERT_TRUE(session->view(row));
  EXPECT_DOUBLE_EQ(row.ledger.moved, static_cast<double>(ready.bricks->lost) * kUnit);
  EXPECT_EQ(row.ledger.removed, 0);
  EXPECT_DOUBLE_EQ(session->second_hand()->row().ledger.moved, row.ledger.moved) << "who took it";
  EXPECT_LT(volume::depth_at(session->bone(), kSplinter), 0) << "it is gone";
  EXPECT_GT(volume::depth_at(session->bone(), kOld), 0);
  const std::uint64_t taken = session->bone().content_hash();
  session->command({tick::CommandKind::undo, 0});
  session->run(0.5, quiet);
  EXPECT_EQ(session->bone().content_hash(), at_start);
  ASSERT_TRUE(session->view(row));
  EXPECT_EQ(row.ledger.moved, 0);
  session->command({tick::CommandKind::redo, 0});
  session->run(0.5, quiet);
  EXPECT_EQ(session->bone().content_hash(), taken);
  session->command({tick::CommandKind::reset, 0});
  session->run(0.5, quiet);
  EXPECT_EQ(session->bone().content_hash(), at_start);
}

// The bone was written since, the bricks are others, or there is no splinter: nothing happens.
TEST(Splinter, IsRefusedWhereTheBoneIsAnother) {
  NoProgress quiet;
  const auto session = session_of(bone_with_stub(true), false);
  session->run(0.2, quiet);
  const std::uint64_t at_start = session->bone().content_hash();
  const ReadySplinter ready = prepared(*session, kSplinter);
  ASSERT_NE(ready.bricks, nullptr);
  const auto refused = [&](const edit::PieceMove& move) {
    EXPECT_TRUE(session->take_splinter(move, false, ready.bricks));
    session->run(0.05, quiet);
    EXPECT_EQ(session->bone().content_hash(), at_start);
    return session->move_state() == tick::MoveState::refused;
  };
  edit::PieceMove other = ready.move;
  ++other.writes;
  EXPECT_TRUE(refused(other));
  other = ready.move;
  ++other.bricks;
  EXPECT_TRUE(refused(other));
  other = ready.move;
  other.seed = {40, 40, 40};  // in the block
  EXPECT_FALSE(edit::PieceStore{}.prepare_splinter(session->bone(), other).ok());
  other.seed = {-1, 400, 0};
  EXPECT_FALSE(edit::PieceStore{}.prepare_splinter(session->bone(), other).ok());
  // one that is too large is a piece
  const auto large = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-10, -10, -10) * kMm, Vec3(10, 10, 14) * kMm, kVoxel), {},
      [](const Vec3& p) {
        return std::max(phantom::box(Vec3::Constant(8 * kMm))(p),
                        phantom::box(Vec3::Constant(1.1 * kMm))(p - Vec3(0, 0, 11) * kMm));
      },
      64);
  const math::Ijk seed =
      large->grid().grid_from_world(Vec3(0, 0, 11) * kMm).array().round().cast<int>();
  other.seed = {seed.x(), seed.y(), seed.z()};
  EXPECT_FALSE(edit::PieceStore{}.prepare_splinter(*large, other).ok());
}

bool waited_for(const std::function<bool()>& what) {
  for (int n = 0; n < 3000; ++n) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// Cut free by the hand, it is taken when the tube is near, and not before; what lay free at the start stays. The
// recording replays to the bit.
TEST(Splinter, ThatWasCutFreeIsTakenByATubeNearIt) {
  const burr::test::Folder folder;
  const std::string path = (folder.path() / "sucked.mcap").string();
  NoProgress quiet;
  double taken = 0;
  {
    const auto session = session_of(bone_with_stub(false), true);
    record::SessionInfo info;
    describe(session->settings(), session->hand().spec(), info);
    describe(session->second_hand()->settings(), session->second_device().spec(), info);
    info.volume.content_hash = session->bone().content_hash();
    info.volume.grid = session->bone().grid();
    info.volume.tissues = session->bone().tissues();
    info.volume.recipe.reserve_bricks = 1024;
    record::Recorder recorder(info.rate_hz, 8192, true, true);
    ASSERT_TRUE(recorder.start(path, info, &session->bone()).ok());
    session->set_recorder(&recorder);
    const std::int64_t before = units(session->bone());
    PieceMover mover(*session);
    session->start();
    int splinters = 0, sucked = 0;
    const auto look = [&] {
      for (const PieceMover::News& one : mover.look()) {
        splinters += one.dust && !one.sucked ? 1 : 0;
        sucked += one.sucked ? 1 : 0;
        if (one.sucked) taken += one.volume;
      }
    };
    PieceMover::Suction by;
    by.reach = 4.5 * kMm;
    by.bore = 1.5 * kMm;
    by.second = true;
    by.mouth = kSplinter + Vec3(6, 0, 0) * kMm;  // 5.4 mm from its side
    mover.suck(by);
    EXPECT_TRUE(waited_for([&] {
      look();
      return splinters > 0;
    })) << "it came free";
    // until the thread has looked with the tube as it is now, and the servo has written what it found
    const auto has_looked = [&] {
      const std::uint64_t looked = mover.looks();
      EXPECT_TRUE(waited_for([&] {
        look();
        return mover.looks() >= looked + 3;
      }));
      const std::uint64_t ticks = session->ticks();
      EXPECT_TRUE(waited_for([&] { return session->ticks() > ticks + 50; }));
      look();
    };
    has_looked();
    EXPECT_EQ(sucked, 0) << "too far away";
    by.mouth = kSplinter + Vec3(4, 0, 0) * kMm;
    by.bore = 0.4 * kMm;
    mover.suck(by);
    has_looked();
    EXPECT_EQ(sucked, 0) << "thicker than the tube";
    by.bore = 1.5 * kMm;
    mover.suck(by);
    EXPECT_TRUE(waited_for([&] {
      look();
      return sucked > 0;
    }));
    by.mouth = kOld;
    mover.suck(by);
    has_looked();
    session->stop();
    EXPECT_EQ(sucked, 1) << "what lay free at the start stays";
    EXPECT_LT(volume::depth_at(session->bone(), kSplinter), 0);
    EXPECT_GT(volume::depth_at(session->bone(), kOld), 0);
    const edit::Ledger ledger = session->outcome().ledger;
    EXPECT_NEAR(ledger.moved, taken, 1e-15);
    EXPECT_NEAR(taken, 8 * std::pow(kHalf, 3), 0.3 * 8 * std::pow(kHalf, 3));
    EXPECT_EQ(before - units(session->bone()),
              std::llround((ledger.removed - ledger.undone + ledger.moved) / kUnit));
    session->set_recorder(nullptr);
    ASSERT_TRUE(recorder.finish().ok());
  }
  auto player = record::Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  auto bone = (*player)->embedded_bone();
  ASSERT_TRUE(bone.ok());
  const auto again = replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick.has_value()) << again->difference;
  EXPECT_EQ(again->gaps, 0U) << again->difference;
  EXPECT_LT(volume::depth_at(*again->bone, kSplinter), 0);
  // and the bone at any moment is that of then
  auto shown = (*player)->embedded_bone();
  ASSERT_TRUE(shown.ok());
  ASSERT_TRUE((*player)->bone_at(1e9, **shown).ok());
  EXPECT_EQ((*shown)->content_hash(), again->bone->content_hash());
}

}  // namespace
}  // namespace burr::sim
