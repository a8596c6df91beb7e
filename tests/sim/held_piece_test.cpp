// A slab that was sawn free is lifted out of a block by a hand: what the hand feels, against closed forms;
// where the bone stops it; the account; undo and leaving; a lost hand; a replay to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/device/replayed_hand.h"
#include "burr/edit/piece_store.h"
#include "burr/math/turn.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/rt/simd.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/volume/volume_of.h"
#include "slab_piece.h"
#include "support/folder.h"

namespace burr::sim {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
using slab::Bench;
using slab::kKerf;
using slab::kMm;
using slab::kStiffness;
using slab::kVoxel;
using slab::units;
using slab::with_torque;
using tick::CommandKind;
// Before and after add up to the unit, and the bone's surface is that of the block without the slab.
TEST(HeldPiece, IsOutOfTheBoneToTheUnit) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  EXPECT_EQ(units(*bench.bone) + units(*bench.piece.bone), bench.units_at_start);
  EXPECT_EQ(bench.missing(), units(*bench.piece.bone)) << "the account";
  EXPECT_TRUE(bench.servo.piece().lifted());
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kLies);
  EXPECT_LT((bench.row.piece.p - bench.piece.centre).norm(), 1e-9);
  EXPECT_NEAR(bench.piece.centre.x(), 0, 0.02 * kMm);
  EXPECT_NEAR(bench.piece.centre.z(), 1.5 * kMm, 0.02 * kMm);
}

// Neither when the piece comes out nor when the hand takes it is anything felt.
TEST(HeldPiece, TheHandOverIsNotFelt) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  EXPECT_LT(bench.jump, 0.01);
  bench.now.pedal = 1;
  double most = 0;
  for (int n = 0; n < 800; ++n) {
    const Vec3 before = bench.row.contact.force;
    if (n == 5) bench.now.pedal = 0;
    if (n == 9) bench.now.pedal = 1;
    bench.tick();
    EXPECT_EQ(bench.row.piece.state, n < 9 ? tick::PieceRow::kLies : tick::PieceRow::kHeld) << n;
    most = std::max(most, (bench.row.contact.force - before).norm());
  }
  EXPECT_LT(most, 0.01) << "N";
  EXPECT_LT(bench.moved().norm(), 1e-4 * kMm);
}

// Pressed on the wall of its slot the slab stands at the wall, and the spring says how hard.
TEST(HeldPiece, IsStoppedByTheWallWithTheForceOfTheSpring) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  for (const double side : {1.0, -1.0}) {
    const double beyond = 0.8;  // [mm]
    bench.go(side * Vec3(1e3 * kKerf + beyond, 0, 0));
    EXPECT_NEAR(bench.moved().x(), side * kKerf, 0.06 * kVoxel);
    EXPECT_NEAR(-side * bench.row.contact.force.x(), kStiffness * beyond * kMm,
                0.02 * kStiffness * beyond * kMm);
    EXPECT_NEAR(bench.row.contact.force.y(), 0, 0.02 * kStiffness * beyond * kMm);
    EXPECT_NEAR(bench.row.contact.force.z(), 0, 0.02 * kStiffness * beyond * kMm);
    EXPECT_LT(bench.row.contact.unsent_torque.norm(), 0.02 * 1e-3) << "N m: nothing tilts it";
    EXPECT_TRUE(bench.row.contact.touching);
    // the tool is carried along: the picture shows it where the piece is stopped
    EXPECT_NEAR(bench.row.contact.proxy.x() - bench.now.world_from_tool.p.x(), -side * beyond * kMm,
                0.06 * kVoxel);
    EXPECT_LT(bench.deepest(0), 0.06) << side;
    bench.go(-side * Vec3(1e3 * kKerf + beyond, 0, 0));
  }
  EXPECT_EQ(bench.allocations, 0);
  EXPECT_EQ(bench.locks, 0);
}

// Pressed and tilted: flat until the torque could tip it over its edge, so all of it is felt; the device
// gets it about the piece's centre.
TEST(HeldPiece, GivesTheHandTheTorqueOfATilt) {
  Bench bench(with_torque());
  ASSERT_TRUE(bench.lift());
  bench.grab();
  const haptics::Coupling springs = coupling_of(with_torque(), bench.servo.settings());
  ASSERT_GT(springs.turn_stiffness, 0);
  const double beyond = 0.8 * kMm;
  // half of what would tip it over the edge of its shorter side, 2.5 mm from the middle
  const double tilt = 0.5 * springs.stiffness * beyond * 2.5 * kMm / springs.turn_stiffness;
  bench.go({1e3 * kKerf + 0.8, 0, 0});
  bench.go({0, 0, 0}, {0, tilt, 0});
  EXPECT_NEAR(-bench.row.contact.force.x(), springs.stiffness * beyond,
              0.03 * springs.stiffness * beyond);
  EXPECT_NEAR(bench.row.contact.torque.y(), -springs.turn_stiffness * tilt,
              0.05 * springs.turn_stiffness * tilt);
  EXPECT_LT(math::rotation_vector(bench.servo.piece().pose().q).norm(), 0.1 * tilt)
      << "the wall keeps it flat";
}

// Along the kerf, in its middle, it touches neither wall and no bottom.
TEST(HeldPiece, SlidesAlongTheKerfWithoutTouching) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  double most = 0;
  for (int n = 0; n < 1000; ++n) {
    bench.now.world_from_tool.p.y() = 8 * kMm * std::sin(2 * M_PI * n / 1000.0);
    bench.tick();
    most = std::max(most, bench.row.contact.force.norm());
    EXPECT_FALSE(bench.row.contact.touching) << n;
  }
  EXPECT_EQ(most, 0);
}

// A hand that swings about and twists wildly: the piece is never deeper in the bone than a fraction of a
// voxel, and no force is larger than the hand's limit.
TEST(HeldPiece, IsNeverInTheBone) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  const Pose middle = bench.now.world_from_tool;
  double most = 0, deepest = -1, of_faces = -1;
  for (int n = 0; n < 3000; ++n) {
    const double t = 1e-3 * n;
    bench.now.world_from_tool.p =
        middle.p + kMm * Vec3(3 * std::sin(7 * t), 5 * std::sin(3 * t), 2 * std::sin(5 * t));
    bench.now.world_from_tool.q = math::turned(
        middle.q, Vec3(0.1 * std::sin(4 * t), 0.2 * std::sin(6 * t), 0.15 * std::sin(3.3 * t)));
    bench.tick();
    most = std::max(most, bench.row.contact.force.norm());
    deepest = std::max(deepest, bench.deepest(0));
    of_faces = std::max(of_faces, bench.deepest(0.2));
  }
  EXPECT_LE(most, 3.3 + 1e-9);
  EXPECT_GT(most, 0.3);
  // voxels round sharp edges off, the slab's and the slot's rim, by 0.2 of a voxel each, and corners by more
  EXPECT_LT(deepest, 0.45) << "voxel";
  EXPECT_LT(of_faces, 0.25) << "voxel";
  EXPECT_GT(deepest, -0.1) << "it was pressed on the bone";
  EXPECT_EQ(bench.allocations, 0);
  EXPECT_EQ(bench.locks, 0);
}

// Put down where it stands against the wall: it does not overlap, and one undo takes lift and move back.
TEST(HeldPiece, LiesWhereItWasStoppedAndOneUndoTakesItBack) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  bench.go({1e3 * kKerf + 0.8, 2, 0});
  const Pose stopped = bench.servo.piece().pose();
  ASSERT_TRUE(bench.put_down());
  bench.ticks(50);
  EXPECT_FALSE(bench.servo.piece().lifted());
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kNone);
  EXPECT_EQ(bench.row.contact.force.norm(), 0) << "the force has faded";
  EXPECT_EQ(bench.units_at_start - units(*bench.bone), bench.missing());
  const auto places = bench.store.moved(*bench.bone);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_LT((places[0].now * places[0].centre - stopped.p).norm(), 1e-9);
  const std::uint64_t there = bench.bone->content_hash();
  bench.command(CommandKind::undo);
  EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
  EXPECT_EQ(bench.missing(), 0);
  bench.command(CommandKind::redo);
  EXPECT_EQ(bench.bone->content_hash(), there);
  EXPECT_EQ(bench.units_at_start - units(*bench.bone), bench.missing());
  bench.command(CommandKind::reset);
  EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
  // and it can be lifted again
  EXPECT_TRUE(bench.lift());
}

// Leaving, undo and reset put it back exactly, and nothing is left to redo.
TEST(HeldPiece, GoesBackExactly) {
  for (const CommandKind kind : {CommandKind::leave_piece, CommandKind::undo, CommandKind::reset}) {
    Bench bench;
    ASSERT_TRUE(bench.lift());
    bench.grab();
    bench.go({0.3, 4, 3}, {0.1, 0, 0.2});
    bench.command(CommandKind::redo);
    EXPECT_TRUE(bench.servo.piece().lifted()) << "there is nothing to redo";
    bench.command(kind);
    EXPECT_FALSE(bench.servo.piece().lifted());
    EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
    EXPECT_EQ(bench.missing(), 0);
    bench.command(CommandKind::redo);
    EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
    ASSERT_TRUE(bench.lift()) << "again";
    bench.command(CommandKind::leave_piece);
    EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
  }
}

// Nothing cuts meanwhile; a lost hand lets go at once, and has to open its grip before it holds again.
TEST(HeldPiece, ALostHandLetsGo) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  bench.go({1e3 * kKerf + 0.8, 0, 0});
  const std::uint64_t hash = bench.bone->content_hash();
  const Pose at = bench.servo.piece().pose();
  EXPECT_GT(bench.row.contact.force.norm(), 0.3);
  bench.now.valid = false;
  bench.ticks(10);
  EXPECT_EQ(bench.row.contact.force.norm(), 0);
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kLies);
  bench.now.valid = true;
  bench.ticks(50);
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kLies) << "the button is still down";
  EXPECT_EQ((bench.servo.piece().pose().p - at.p).norm(), 0);
  bench.grab();
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kHeld);
  EXPECT_LT(bench.row.contact.force.norm(), 0.01) << "grabbed where the hand is now";
  EXPECT_EQ(bench.bone->content_hash(), hash);
  bench.command(CommandKind::let_go, 20);
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kLies);
}

// A hand that is lost does not keep the piece out: it goes back, or is put down, without it.
TEST(HeldPiece, ALostHandDoesNotKeepItOut) {
  for (const bool puts : {false, true}) {
    Bench bench;
    ASSERT_TRUE(bench.lift());
    bench.grab();
    bench.go({0.3, 4, 3});
    bench.now.valid = false;
    bench.ticks(100);
    EXPECT_TRUE(bench.servo.piece().lifted());
    if (puts)
      EXPECT_TRUE(bench.put_down());
    else
      bench.command(CommandKind::leave_piece);
    EXPECT_FALSE(bench.servo.restoring());
    EXPECT_FALSE(bench.servo.piece().lifted());
    EXPECT_EQ(bench.row.contact.force.norm(), 0);
    EXPECT_EQ(bench.bone->content_hash() == bench.at_start, !puts);
    EXPECT_EQ(bench.units_at_start - units(*bench.bone), bench.missing());
    bench.now.valid = true;
    bench.now.pedal = 0;
    bench.ticks(700);
    EXPECT_EQ(bench.row.contact.flags & rt::kFlagRestoring, 0U);
  }
}

// A place for it by number: it goes there as far as the bone lets it, and nobody is pushed.
TEST(HeldPiece, GoesWhereItIsWantedAsFarAsTheBoneLetsIt) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  edit::PieceMove move = put_at(bench.piece.number, bench.piece.centre, bench.servo.piece().pose());
  const auto shift = [&](const Vec3& mm) {
    for (int axis = 0; axis < 3; ++axis)
      move.by[static_cast<std::size_t>(axis)] = (bench.piece.centre + kMm * mm)[axis];
    bench.servo.commands().push({CommandKind::shift_piece, 0, move});
    bench.ticks(50);
  };
  shift({0, 0, 3});
  EXPECT_LT((bench.moved() - Vec3(0, 0, 3) * kMm).norm(), 1e-3 * kMm);
  shift({0, 0, -3});
  EXPECT_NEAR(bench.moved().z(), -kKerf, 0.06 * kVoxel) << "the bottom of the slot";
  EXPECT_EQ(bench.row.contact.force.norm(), 0);
  move.turn = {0, 0, 0, 2};
  shift({0, 0, 3});
  EXPECT_NEAR(bench.moved().z(), -kKerf, 0.06 * kVoxel) << "no rotation: refused";
}

// Bricks were prepared for one place, and the hand went on: the bone must not come back at the old place.
TEST(HeldPiece, IsNotPutDownWhereItNoLongerIs) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  edit::PieceMove move;
  const auto prepared = bench.down(move);
  ASSERT_TRUE(prepared.ok());
  bench.go({0, 1, 0});
  EXPECT_FALSE(bench.obeyed(CommandKind::move_piece, move, *prepared));
  EXPECT_TRUE(bench.servo.piece().lifted());
  EXPECT_TRUE(bench.put_down());
  EXPECT_FALSE(bench.servo.piece().lifted());
}

// A place from a command or a file: the hand that holds the piece lets go, and its force does not leap with the place.
TEST(HeldPiece, AWantedPlaceTakesItOutOfTheHand) {
  Bench bench;
  ASSERT_TRUE(bench.lift());
  bench.grab();
  ASSERT_EQ(bench.row.piece.state, tick::PieceRow::kHeld);
  edit::PieceMove to;
  const Pose from = bench.servo.piece().pose();
  for (int axis = 0; axis < 3; ++axis) to.by[static_cast<std::size_t>(axis)] = from.p[axis];
  to.by[1] += 4 * kMm;  // along the kerf
  to.turn = {from.q.x(), from.q.y(), from.q.z(), from.q.w()};
  bench.servo.commands().push(
      {CommandKind::shift_piece, static_cast<double>(bench.piece.number), to});
  double most = 0;
  for (int n = 0; n < 700; ++n) most = std::max(most, bench.tick().contact.force.norm());
  EXPECT_LT(most, 0.01);
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kLies);  // the button is still down
  EXPECT_NEAR((bench.servo.piece().pose().p - from.p).norm(), 4 * kMm, 0.1 * kMm);
  bench.grab();
  EXPECT_EQ(bench.row.piece.state, tick::PieceRow::kHeld);
}

TEST(HeldPiece, AStaleLiftIsRefused) {
  Bench bench;
  edit::PieceMove move = further(bench.piece, Vec3::Zero(), Quat::Identity());
  move.writes = bench.servo.writes_done();
  const auto prepared = bench.store.prepare_lift(*bench.bone, move);
  ASSERT_TRUE(prepared.ok());
  move.bricks = prepared->bricks->hash;
  move.body = prepared->bricks->body.hash ^ 1;
  EXPECT_FALSE(bench.obeyed(CommandKind::lift_piece, move, *prepared)) << "another body";
  move.body ^= 1;
  move.writes += 1;
  EXPECT_FALSE(bench.obeyed(CommandKind::lift_piece, move, *prepared)) << "another bone";
  EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
  move.writes -= 1;
  EXPECT_TRUE(bench.obeyed(CommandKind::lift_piece, move, *prepared));
}

// A replay must give the same bits on every processor.
TEST(HeldPiece, GivesTheSameBitsOnEveryInstructionSet) {
  const rt::Simd best = rt::simd();
  std::vector<std::uint64_t> first;
  for (const rt::Simd set : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(set);
    Bench bench({}, 1);
    ASSERT_TRUE(bench.lift());
    bench.grab();
    bench.go({0.9, 1, 0.5}, {0.02, 0.05, 0.1});
    ASSERT_TRUE(bench.put_down());
    if (set == rt::Simd::scalar) first = {bench.row.hash, bench.bone->content_hash()};
    EXPECT_EQ(bench.row.hash, first[0]);
    EXPECT_EQ(bench.bone->content_hash(), first[1]);
  }
  rt::force_simd(best);
}

// Lifted, carried out of the volume, refused there and left; lifted, carried, put down: recorded and
// replayed.
TEST(HeldPiece, ARecordingReplaysToTheBit) {
  const burr::test::Folder folder;
  const std::string path = (folder.path() / "held.mcap").string();
  std::uint64_t at_end = 0;
  NoProgress quiet;
  {
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    device::ReplayedHand& hand = *owned;
    SessionSettings settings;
    settings.servo = Bench::settings(1);
    settings.surface.reserve_blocks = 1 << 14;
    auto bone = Bench::make();
    const std::uint64_t at_start = bone->content_hash();
    auto made = Session::make(std::move(bone), std::move(owned), settings, quiet);
    ASSERT_TRUE(made.ok()) << made.error().text;
    Session& session = **made;
    record::SessionInfo info;
    describe(session.settings(), session.hand().spec(), info);
    info.volume.content_hash = at_start;
    info.volume.grid = session.bone().grid();
    info.volume.tissues = session.bone().tissues();
    info.volume.recipe.reserve_bricks = 4096;
    record::Recorder recorder(info.rate_hz, 8192);
    ASSERT_TRUE(recorder.start(path, info, &session.bone()).ok());
    session.set_recorder(&recorder);
    edit::PieceStore store;
    device::HandState now;
    now.world_from_tool.p = Vec3(0, 0, 12) * kMm;
    const auto go = [&](const Vec3& by, double pedal) {
      now.world_from_tool.p += kMm * by;
      now.pedal = pedal;
      hand.set(now);
      session.run(0.3, quiet);
    };
    go({0, 0, 0}, 0);
    const auto first = lift_piece(session, store, Vec3(0, 0, 2) * kMm, quiet);
    ASSERT_TRUE(first.ok());
    go({0, 0, 0}, 1);
    for (int n = 0; n < 5; ++n) go({0, 0, 3}, 1);
    EXPECT_GT(session.servo().piece().pose().p.z(), 14 * kMm);
    const auto twice = lift_piece(session, store, Vec3(0, 0, 2) * kMm, quiet);
    ASSERT_FALSE(twice.ok());
    EXPECT_NE(twice.error().text.find("in the hand already"), std::string::npos);
    const auto refused = put_down(session, store, *first, quiet);
    ASSERT_FALSE(refused.ok()) << "outside of the volume";
    EXPECT_TRUE(session.servo().piece().lifted());
    const auto left = leave_piece(session);
    ASSERT_TRUE(left.ok()) << left.error().text;
    EXPECT_TRUE(*left);
    EXPECT_EQ(session.bone().content_hash(), at_start);
    const auto none = leave_piece(session);
    ASSERT_TRUE(none.ok()) << none.error().text;
    EXPECT_FALSE(*none) << "none is out";
    go({0, 0, -15}, 0);
    const auto lifted = lift_piece(session, store, Vec3(0, 0, 2) * kMm, quiet);
    ASSERT_TRUE(lifted.ok()) << lifted.error().text;
    go({0, 0, 0}, 1);
    go({1.1, 0.5, 0.3}, 1);
    const auto put = put_down(session, store, *lifted, quiet);
    ASSERT_TRUE(put.ok()) << put.error().text;
    EXPECT_NEAR(put->move.by[0], kKerf, 0.1 * kVoxel);
    go({0, 0, 0}, 0);
    EXPECT_NE(session.bone().content_hash(), at_start);
    session.set_recorder(nullptr);
    ASSERT_TRUE(recorder.finish().ok());
    at_end = session.bone().content_hash();
  }
  auto player = record::Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  auto bone = (*player)->embedded_bone();
  ASSERT_TRUE(bone.ok());
  const auto again = replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick.has_value()) << again->difference;
  EXPECT_EQ(again->bone->content_hash(), at_end);
  EXPECT_EQ(again->pieces.moved(*again->bone).size(), 1U);
  // and without simulating
  auto shown = (*player)->embedded_bone();
  ASSERT_TRUE(shown.ok());
  const auto store = moved_in(**player, **shown);
  ASSERT_TRUE(store.ok()) << store.error().text;
  ASSERT_TRUE((*player)->bone_at((*player)->seconds(), **shown).ok());
  EXPECT_EQ((*shown)->content_hash(), at_end);
  EXPECT_EQ(store->moved(**shown).size(), 1U);
}

}  // namespace
}  // namespace burr::sim
