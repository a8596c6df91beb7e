// Pieces that were cut free are moved, in whole sessions: where they then lie, what the account
// says, undo and reset, and a replay to the bit.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/device/replayed_hand.h"
#include "burr/edit/piece_store.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/tick/servo.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"
#include "support/crossing.h"
#include "support/folder.h"
#include "support/rt_guard.h"

namespace burr::sim {
namespace {

using math::Vec3;
using volume::Bone;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;

// A bar along x, 20 x 6 x 6 mm, with a kerf of 1 mm across it at x = 2: the right part, 2.5 to 10
// mm, is the smaller one. bridge: width of what still holds it [m].
phantom::Depth bar(double bridge = 0) {
  const phantom::Depth whole = phantom::box({10 * kMm, 3 * kMm, 3 * kMm});
  return [=](const Vec3& p) {
    double kerf = std::abs(p.x() - 2 * kMm) - 0.5 * kMm;
    if (bridge > 0)
      kerf = std::max(kerf, 0.5 * bridge - std::max(std::abs(p.y()), std::abs(p.z())));
    return std::min(whole(p), kerf);
  };
}

// The same with a loose speck in a pore inside the right part.
const Vec3 kInPore = Vec3(6, 0, 0) * kMm;
phantom::Depth bar_with_specks() {
  const phantom::Depth solid = bar(), hollow = phantom::ball(1.2 * kMm),
                       speck = phantom::ball(0.4 * kMm);
  return [=](const Vec3& p) {
    const double porous = std::min(solid(p), -hollow(p - kInPore));
    return std::max(porous, speck(p - kInPore));
  };
}

struct Bench {
  std::unique_ptr<Session> session;
  device::ReplayedHand* hand = nullptr;
  edit::PieceStore store;
  NoProgress quiet;
  std::uint64_t at_start = 0;
  std::int64_t units_at_start = 0;

  explicit Bench(const phantom::Depth& depth = bar(), std::size_t reserve = 2048,
                 std::size_t undo = 4096) {
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    hand = owned.get();
    SessionSettings settings;
    settings.servo.burr.radius = 1.5 * kMm;
    settings.servo.undo_bricks = undo;
    settings.surface.reserve_blocks = 1 << 14;
    auto bone = phantom::bone_from_distance(
        phantom::box_grid(Vec3(-14, -10, -10) * kMm, Vec3(20, 10, 10) * kMm, kVoxel), {}, depth,
        reserve);
    at_start = bone->content_hash();
    units_at_start = units(*bone);
    auto made = Session::make(std::move(bone), std::move(owned), settings, quiet);
    EXPECT_TRUE(made.ok()) << made.error().text;
    session = std::move(*made);
    device::HandState away;
    away.world_from_tool.p = Vec3(0, 0, 9) * kMm;
    hand->set(away);
  }
  static std::int64_t units(const Bone& bone) {
    std::int64_t sum = 0;
    for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
      if (bone.brick_field(brick) != nullptr) sum += volume::volume_units(bone.brick_field(brick));
    return sum;
  }
  // What the account says is missing [units].
  [[nodiscard]] std::int64_t missing() const {
    const double unit = kVoxel * kVoxel * kVoxel / static_cast<double>(volume::kVoxelUnits);
    const edit::Ledger ledger = session->outcome().ledger;
    return std::llround((ledger.removed - ledger.undone + ledger.moved - ledger.added) / unit);
  }
  void expect_account(const char* when) const {
    EXPECT_EQ(units_at_start - units(session->bone()), missing()) << when;
  }
  Result<PieceMoved> move(const Vec3& near_mm, const Vec3& by_mm,
                          const Vec3& turn_deg = {0, 0, 0}) {
    return move_piece(*session, store, {near_mm * kMm, by_mm * kMm, turn_deg * (M_PI / 180)},
                      quiet);
  }
  void command(tick::CommandKind kind) {
    session->command({kind, 0});
    session->run(0.6, quiet);
  }
};

TEST(Pieces, AMovedBoxSitsWhereItShould) {
  Bench bench;
  // 3.1 mm along x: not a whole number of voxels; and 20 degrees about z
  const auto moved = bench.move({6, 0, 0}, {3.1, 1.05, 0}, {0, 0, 20});
  ASSERT_TRUE(moved.ok()) << moved.error().text;
  EXPECT_NEAR(1e9 * moved->volume, 7.5 * 36, 0.02 * 7.5 * 36);
  const auto places = bench.store.moved(bench.session->bone());
  ASSERT_EQ(places.size(), 1U);
  const Bone& piece = *places[0].piece;
  const double turn = 20 * M_PI / 180;
  const Vec3 along(std::cos(turn), std::sin(turn), 0), across(-std::sin(turn), std::cos(turn), 0);
  const Vec3 centre = Vec3(6.25 + 3.1, 1.05, 0) * kMm;
  for (const auto& [d, far] : {std::pair{along, 3.75 * kMm}, std::pair{Vec3(-along), 3.75 * kMm},
                               std::pair{across, 3 * kMm}, std::pair{Vec3(-across), 3 * kMm},
                               std::pair{Vec3(0, 0, 1), 3 * kMm}})
    EXPECT_NEAR(test::crossing(piece, centre, d), far, 0.1 * kVoxel) << d.transpose();
  bench.expect_account("after the move");
}

TEST(Pieces, WhatIsLeftAndWhatIsMovedAddUpToTheUnit) {
  Bench bench;
  const auto moved = bench.move({6, 0, 0}, {5, 0, 0});  // whole voxels: nothing is blurred
  ASSERT_TRUE(moved.ok()) << moved.error().text;
  EXPECT_EQ(moved->lost, 0);
  EXPECT_EQ(moved->overlap, 0);
  EXPECT_EQ(Bench::units(bench.session->bone()), bench.units_at_start);
  const auto places = bench.store.moved(bench.session->bone());
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(Bench::units(*places[0].piece) +
                Bench::units(*bench.store.without_moved(bench.session->bone())),
            bench.units_at_start);
}

// What is loose inside the piece would otherwise stay where it is and hold the piece up when that is lifted. Moves
// of older recordings leave it.
TEST(Pieces, WhatLiesLooseInItsPoresGoesWithIt) {
  Bench bench(bar_with_specks());
  const auto piece = bench.store.find(bench.session->bone(), Vec3(9.5, 0, 0) * kMm);
  ASSERT_TRUE(piece.ok());
  edit::PieceMove older = further(*piece, Vec3(5, 0, 0) * kMm, math::Quat::Identity());
  older.specks = false;
  const auto as_before = bench.store.prepare(bench.session->bone(), older);
  ASSERT_TRUE(as_before.ok());
  const auto moved = bench.move({9.5, 0, 0}, {5, 0, 0});
  ASSERT_TRUE(moved.ok()) << moved.error().text;
  EXPECT_NE(moved->move.bricks, as_before->bricks->hash);
  const Bone& bone = bench.session->bone();
  EXPECT_GT(volume::depth_at(bone, kInPore + Vec3(5, 0, 0) * kMm), 0);
  EXPECT_LT(volume::depth_at(bone, kInPore), 0);
  EXPECT_EQ(moved->lost, 0);
  bench.expect_account("after the move");
}

TEST(Pieces, OverlapIsThereOnceAndIsToldToTheUnit) {
  Bench bench;
  const auto moved = bench.move({6, 0, 0}, {-3.0, 0, 0});  // 2 mm into the mother
  ASSERT_TRUE(moved.ok()) << moved.error().text;
  EXPECT_NEAR(1e9 * moved->overlap, 2 * 36, 0.05 * 2 * 36);
  EXPECT_EQ(moved->lost, moved->overlap) << "whole voxels: the overlap is all that is lost";
  bench.expect_account("after the move");
  EXPECT_GT(bench.missing(), 0);
}

TEST(Pieces, UndoRedoAndResetBringEverythingBack) {
  Bench bench;
  ASSERT_TRUE(bench.move({6, 0, 0}, {3.1, 0.4, 0}, {5, 0, 7}).ok());
  const std::uint64_t once = bench.session->bone().content_hash();
  ASSERT_TRUE(bench.move({9, 0, 0}, {1.3, -0.4, 0}, {0, 3, 0}).ok());
  const std::uint64_t twice = bench.session->bone().content_hash();
  EXPECT_NE(once, twice);
  bench.expect_account("moved twice");
  bench.command(tick::CommandKind::undo);
  EXPECT_EQ(bench.session->bone().content_hash(), once);
  bench.expect_account("undone once");
  bench.command(tick::CommandKind::undo);
  EXPECT_EQ(bench.session->bone().content_hash(), bench.at_start);
  EXPECT_EQ(bench.missing(), 0);
  EXPECT_TRUE(bench.store.moved(bench.session->bone()).empty());
  bench.command(tick::CommandKind::redo);
  EXPECT_EQ(bench.session->bone().content_hash(), once);
  bench.expect_account("redone");
  bench.command(tick::CommandKind::redo);
  EXPECT_EQ(bench.session->bone().content_hash(), twice);
  bench.expect_account("redone twice");
  bench.command(tick::CommandKind::reset);
  EXPECT_EQ(bench.session->bone().content_hash(), bench.at_start);
  EXPECT_EQ(bench.missing(), 0);
}

TEST(Pieces, ManyMovesBlurNoMoreThanOne) {
  Bench one, many;
  ASSERT_TRUE(one.move({6, 0, 0}, {4.3, 0.3, 0.15}).ok());
  for (int n = 0; n < 4; ++n)
    ASSERT_TRUE(many.move(Vec3(6, 0, 0) + n * Vec3(1, 0.4, 0), {1.0, 0.4, 0.0}).ok()) << n;
  // and to the same place
  ASSERT_TRUE(many.move({10, 1.6, 0}, {0.3, -1.3, 0.15}).ok());
  const auto a = one.store.moved(one.session->bone()), b = many.store.moved(many.session->bone());
  ASSERT_TRUE(a.size() == 1 && b.size() == 1);
  // the sums of shifts differ in their last bits, the field in none
  EXPECT_EQ(a[0].piece->content_hash(), b[0].piece->content_hash());
  EXPECT_EQ(one.session->bone().content_hash(), many.session->bone().content_hash());
  // and back to where it came from: as if it had never moved
  const Vec3 back = -1e3 * (b[0].now * b[0].centre - b[0].centre);
  ASSERT_TRUE(many.move({10.3, 0.3, 0.15}, back).ok());
  EXPECT_EQ(many.session->bone().content_hash(), many.at_start);
}

TEST(Pieces, ABridgeOfOneVoxelHolds) {
  Bench held(bar(1.5 * kVoxel)), free(bar(0));
  const auto moved = held.move({6, 0, 0}, {5, 0, 0});
  ASSERT_FALSE(moved.ok());
  EXPECT_NE(moved.error().text.find("bridge"), std::string::npos) << moved.error().text;
  EXPECT_EQ(held.session->bone().content_hash(), held.at_start);
  EXPECT_TRUE(free.move({6, 0, 0}, {5, 0, 0}).ok());
}

TEST(Pieces, WhatCannotBeMovedIsRefusedInWords) {
  Bench bench;
  const auto far = bench.move({6, 0, 0}, {25, 0, 0});
  ASSERT_FALSE(far.ok());
  EXPECT_NE(far.error().text.find("leave the volume"), std::string::npos) << far.error().text;
  const auto nowhere = bench.move({-6, 0, 8}, {1, 0, 0});
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().text.find("no free piece lies"), std::string::npos);
  Bench small(bar(), 0);  // no room for bricks of air
  const auto full = small.move({6, 0, 0}, {5, 0, 0});
  ASSERT_FALSE(full.ok());
  EXPECT_NE(full.error().text.find("raise reserve_bricks"), std::string::npos) << full.error().text;
  EXPECT_EQ(small.session->bone().content_hash(), small.at_start);
  Bench forgetful(bar(), 2048, 64);
  const auto large = forgetful.move({6, 0, 0}, {5, 0, 0});
  ASSERT_FALSE(large.ok());
  EXPECT_NE(large.error().text.find("raise undo_bricks"), std::string::npos) << large.error().text;
}

// A command whose bone was changed after it was prepared changes nothing.
TEST(Pieces, AStaleMoveIsRefused) {
  Bench bench;
  const auto piece = bench.store.find(bench.session->bone(), Vec3(6, 0, 0) * kMm);
  ASSERT_TRUE(piece.ok());
  edit::PieceMove move = further(*piece, Vec3(5, 0, 0) * kMm, math::Quat::Identity());
  move.writes = bench.session->servo().writes_done();
  const auto prepared = bench.store.prepare(bench.session->bone(), move);
  ASSERT_TRUE(prepared.ok());
  move.bricks = prepared->bricks->hash;
  move.writes += 1;
  ASSERT_TRUE(bench.session->move_piece(move, prepared->bricks));
  bench.session->run(0.3, bench.quiet);
  EXPECT_EQ(bench.session->move_state(), tick::MoveState::refused);
  EXPECT_EQ(bench.session->bone().content_hash(), bench.at_start);
  move.writes -= 1;
  move.bricks ^= 1;
  ASSERT_TRUE(bench.session->move_piece(move, prepared->bricks));
  bench.session->run(0.3, bench.quiet);
  EXPECT_EQ(bench.session->move_state(), tick::MoveState::refused);
  EXPECT_EQ(bench.session->bone().content_hash(), bench.at_start);
}

// The hand holds the burr in the air; no tick of the move is felt, and none allocates or waits.
TEST(Pieces, TheHandFeelsNothingOfItAndTheTickNeverWaits) {
  Bench bench;
  bench.session->run(0.5, bench.quiet);
  const auto piece = bench.store.find(bench.session->bone(), Vec3(6, 0, 0) * kMm);
  ASSERT_TRUE(piece.ok());
  edit::PieceMove move = further(*piece, Vec3(4.1, 0, 0) * kMm, math::Quat::Identity());
  tick::Servo& servo = bench.session->servo();
  move.writes = servo.writes_done();
  const auto prepared = bench.store.prepare(bench.session->bone(), move);
  ASSERT_TRUE(prepared.ok());
  move.bricks = prepared->bricks->hash;
  bench.session->bone().commit_ahead();
  servo.commit_ahead();
  ASSERT_TRUE(bench.session->move_piece(move, prepared->bricks));
  Vec3 before = Vec3::Zero();
  double most = 0;
  int ticks = 0;
  long allocations = 0, locks = 0;
  for (; ticks < 1000 && bench.session->move_state() != tick::MoveState::done; ++ticks) {
    const burr::test::RtGuard guard;
    const tick::TickRow& row = servo.tick(false);
    servo.publish();
    allocations += guard.allocations();
    locks += guard.locks();
    most = std::max(most, (row.contact.force - before).norm());
    before = row.contact.force;
  }
  EXPECT_EQ(bench.session->move_state(), tick::MoveState::done);
  EXPECT_LT(most, 0.01) << "N";
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

// A session with strokes, moves, undo and a stale command, recorded and replayed.
TEST(Pieces, ARecordingReplaysToTheBit) {
  const burr::test::Folder folder;
  const std::string path = (folder.path() / "moved.mcap").string();
  std::uint64_t at_end = 0;
  std::vector<std::uint64_t> pieces;
  {
    Bench bench(bar_with_specks());
    record::SessionInfo info;
    describe(bench.session->settings(), bench.session->hand().spec(), info);
    info.volume.content_hash = bench.at_start;
    info.volume.grid = bench.session->bone().grid();
    info.volume.tissues = bench.session->bone().tissues();
    info.volume.recipe.reserve_bricks = 2048;
    record::Recorder recorder(info.rate_hz, 8192);
    ASSERT_TRUE(recorder.start(path, info, &bench.session->bone()).ok());
    bench.session->set_recorder(&recorder);
    ASSERT_TRUE(bench.move({6, 0, 0}, {3.1, 0.4, 0}, {5, 0, 7}).ok());
    // a hole in the mother
    device::HandState hand;
    hand.pedal = 1;
    for (const double z : {9.0, 4.0, 4.0, 9.0}) {
      hand.world_from_tool.p = Vec3(-4, 0, z) * kMm;
      bench.hand->set(hand);
      bench.session->run(0.4, bench.quiet);
    }
    ASSERT_TRUE(bench.move({9, 0, 0}, {1.3, -0.4, 0}, {0, 3, 0}).ok());
    bench.command(tick::CommandKind::undo);
    ASSERT_TRUE(bench.move({9, 0, 0}, {2, 0, 0}, {0, 0, -7}).ok());
    bench.expect_account("at the end");
    bench.session->set_recorder(nullptr);
    ASSERT_TRUE(recorder.finish().ok());
    at_end = bench.session->bone().content_hash();
    for (const auto& one : bench.store.moved(bench.session->bone()))
      pieces.push_back(one.piece->content_hash());
  }
  auto player = record::Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  NoProgress quiet;
  auto bone = (*player)->embedded_bone();
  ASSERT_TRUE(bone.ok());
  const auto again = replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick.has_value()) << again->difference;
  EXPECT_EQ(again->bone->content_hash(), at_end);
  std::vector<std::uint64_t> replayed;
  for (const auto& one : again->pieces.moved(*again->bone))
    replayed.push_back(one.piece->content_hash());
  EXPECT_EQ(replayed, pieces);
  // and without simulating: tissues and all
  auto shown = (*player)->embedded_bone();
  ASSERT_TRUE(shown.ok());
  ASSERT_TRUE((*player)->bone_at((*player)->seconds(), **shown).ok());
  EXPECT_EQ((*shown)->content_hash(), at_end);
}

}  // namespace
}  // namespace burr::sim
