// A slab that was lifted out of a block, and two hands: either carries it and feels it, the other one's tool
// meets it, and a tool pushes it where nobody holds it. Against closed forms; a replay to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/simd.h"
#include "burr/scenario/rack.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
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
using tick::CommandKind;
using tick::PieceRow;

constexpr double kBall = 1.5 * kMm;  // of the tool in the second hand
constexpr double kTop = 4 * kMm;     // of the slab where it came free

// A tube, or a tool that is one ball.
tick::SecondHandSettings other_hand(bool tool, tool::Role role = tool::Role::rubs) {
  tick::SecondHandSettings other;
  other.force = {kStiffness, 0};
  if (!tool) return other;
  tool::ShapedTool ball;
  ball.name = "ball";
  EXPECT_TRUE(tool::add_part(ball.tool, {{tool::ShapeKind::ball, 0, 0, 0, kBall}, {}, role}));
  other.tool = ball;
  return other;
}

// The bench with the piece lifted and both hands.
struct Two : Bench {
  explicit Two(bool tool, const device::DeviceSpec& spec = {}, double friction = 0)
      : Bench(spec, friction, &(settings = other_hand(tool)), haptics::Method::shaft) {
    EXPECT_TRUE(lift());
  }
  [[nodiscard]] const tick::TickRow& too() const { return second->row(); }
  void grab_too() {
    now_too.pedal = 0;
    tick();
    now_too.pedal = 1;
    ticks(700);
  }
  void go_too(const Vec3& by_mm, const Vec3& turn = Vec3::Zero(), int count = 300) {
    const Pose from = now_too.world_from_tool;
    for (int n = 1; n <= count; ++n) {
      const double share = static_cast<double>(n) / count;
      now_too.world_from_tool.p = from.p + share * kMm * by_mm;
      now_too.world_from_tool.q = math::turned(from.q, share * turn);
      tick();
    }
    ticks(count);
  }
  void put_too(const Vec3& mm) { go_too(mm - 1e3 * now_too.world_from_tool.p); }
  // Above its inner part, far from the edges, which voxels round off.
  [[nodiscard]] bool above_the_face(const Vec3& centre) const {
    const Pose body = servo.piece().pose();
    const Vec3 p = body.q.conjugate() * Vec3(centre - body.p) + piece.centre - slab::kSlabAt;
    return std::abs(p.x()) < slab::kSlab.x() - 2 * kVoxel &&
           std::abs(p.y()) < slab::kSlab.y() - 2 * kVoxel;
  }
  // How deep a ball is in the slab  [voxel].
  [[nodiscard]] double deep(const Vec3& centre, double radius) const {
    static const phantom::Depth box = phantom::box(slab::kSlab);
    const Pose body = servo.piece().pose();
    const Vec3 p = body.q.conjugate() * Vec3(centre - body.p) + piece.centre - slab::kSlabAt;
    return (radius + box(p)) / kVoxel;
  }

  inline static tick::SecondHandSettings settings;
};

// Pressed from above by the other hand's tool by delta, it yields by half of that, and both hands feel
// k delta / 2, opposite to each other; beside the middle with the torque of that lever.
TEST(PieceTwoHands, TheOtherToolPressesOnAHeldPiece) {
  Two bench(true);
  bench.grab();
  ASSERT_EQ(bench.row.piece.state, PieceRow::kHeld);
  const double delta = 0.4;  // [mm]
  bench.put_too({0, 0, 5.5 - delta});
  const double push = kStiffness * 0.5 * delta * kMm;
  EXPECT_NEAR(bench.too().contact.force.z(), push, 0.03 * push);
  EXPECT_NEAR(bench.row.contact.force.z(), -push, 0.03 * push);
  EXPECT_NEAR(bench.row.contact.force.z(), -bench.too().contact.force.z(), 0.01 * push);
  EXPECT_NEAR(bench.moved().z(), -0.5 * delta * kMm, 0.05 * kVoxel);
  EXPECT_TRUE(bench.row.contact.touching);
  EXPECT_TRUE(bench.too().contact.touching);
  EXPECT_LT(bench.deep(bench.too().contact.proxy, kBall), 0.05);
  // the ball rests on a point that may lie so much beside its middle
  EXPECT_LT(bench.row.contact.unsent_torque.norm(), 0.25 * kMm * push);
  bench.put_too({0, 0, 6.5});
  EXPECT_LT(bench.row.contact.force.norm(), 1e-6);
  EXPECT_LT(bench.too().contact.force.norm(), 1e-6);
  bench.put_too({0, 3, 6.5});
  bench.put_too({0, 3, 5.5 - delta});
  EXPECT_NEAR(bench.row.contact.force.z(), -push, 0.04 * push);
  EXPECT_NEAR(std::abs(bench.row.contact.unsent_torque.x()), push * 3 * kMm, 0.06 * push * 3 * kMm);
  EXPECT_EQ(bench.allocations, 0);
  EXPECT_EQ(bench.locks, 0);
}

// Pressed down to the bottom of the slot: then the tool's hand has all of its stretch, and the bone under the piece
// carries it.
TEST(PieceTwoHands, BoneStopsThePieceThatIsPressed) {
  Two bench(true);
  bench.grab();
  const double beyond = 0.6;  // of the tool below where the piece is stopped [mm]
  bench.put_too({0, 0, 5.5 - 1e3 * kKerf - beyond});
  EXPECT_NEAR(bench.moved().z(), -kKerf, 0.06 * kVoxel);
  EXPECT_NEAR(bench.too().contact.force.z(), kStiffness * beyond * kMm,
              0.04 * kStiffness * beyond * kMm);
  // the hand that holds it is 0.5 mm above
  EXPECT_NEAR(bench.row.contact.force.z(), -kStiffness * kKerf, 0.04 * kStiffness * kKerf);
}

// The hand with a suction tube carries and feels the wall, force and torque; the first hand feels nothing.
TEST(PieceTwoHands, TheSecondHandFeelsWhatItCarries) {
  for (const bool torque : {false, true}) {
    const device::DeviceSpec spec = torque ? slab::with_torque() : device::DeviceSpec{};
    Two bench(false, spec);
    bench.grab_too();
    ASSERT_EQ(bench.row.piece.state, PieceRow::kHeldByOther);
    const double beyond = 0.8;
    bench.go_too({1e3 * kKerf + beyond, 0, 0});
    EXPECT_NEAR(bench.moved().x(), kKerf, 0.06 * kVoxel);
    const double push = kStiffness * beyond * kMm;
    EXPECT_NEAR(-bench.too().contact.force.x(), push, 0.03 * push);
    EXPECT_LT(bench.row.contact.force.norm(), 1e-6);
    EXPECT_LT(bench.deepest(0), 0.06);
    if (torque) {
      const haptics::Coupling springs = coupling_of(spec, bench.servo.settings());
      const double tilt =
          0.5 * springs.stiffness * beyond * kMm * 2.5 * kMm / springs.turn_stiffness;
      bench.go_too({0, 0, 0}, {0, tilt, 0});
      EXPECT_NEAR(bench.too().contact.torque.y(), -springs.turn_stiffness * tilt,
                  0.05 * springs.turn_stiffness * tilt);
    }
    EXPECT_EQ(bench.allocations, 0);
    EXPECT_EQ(bench.locks, 0);
  }
}

// A suction tube meets the piece that the first hand holds, as any tool does, and pushes one that lies.
TEST(PieceTwoHands, ATubeMeetsThePiece) {
  for (const bool held : {true, false}) {
    Two bench(false);
    if (held) bench.grab();
    const double delta = 0.4;  // the ball at its tip has a radius of 1.5 mm
    bench.put_too({0, 0, 5.5 - delta});
    const double push = held ? kStiffness * 0.5 * delta * kMm : 0;
    EXPECT_NEAR(bench.too().contact.force.z(), push, 0.03 * push + 1e-3);
    EXPECT_NEAR(bench.row.contact.force.z(), -push, 0.03 * push + 1e-6);
    EXPECT_NEAR(bench.moved().z(), (held ? -0.5 : -1) * delta * kMm, 0.05 * kVoxel);
    EXPECT_LT(bench.deep(bench.too().contact.proxy, 1.5 * kMm), 0.05);
    // to the bottom of the slot: the bone under the piece carries what is pressed through it
    const double beyond = 0.6;
    bench.put_too({0, 0, 5.5 - 1e3 * kKerf - beyond});
    EXPECT_NEAR(bench.moved().z(), -kKerf, 0.06 * kVoxel);
    EXPECT_NEAR(bench.too().contact.force.z(), kStiffness * beyond * kMm,
                0.04 * kStiffness * beyond * kMm);
    // it is the tube of three unknowns again when the piece is bone again
    bench.command(CommandKind::leave_piece);
    EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
    bench.put_too({0, 0, 8});
    bench.put_too({0, 0, 5.5 - delta});
    EXPECT_NEAR(bench.too().contact.force.z(), kStiffness * delta * kMm,
                0.03 * kStiffness * delta * kMm);
    EXPECT_EQ(bench.allocations, 0);
    EXPECT_EQ(bench.locks, 0);
  }
}

// While the second hand carries, the tool is in the first hand again and meets the piece.
TEST(PieceTwoHands, TheFirstHandsToolMeetsWhatTheSecondCarries) {
  Two bench(false);
  bench.grab_too();
  bench.ticks(700);
  ASSERT_EQ(bench.row.piece.state, PieceRow::kHeldByOther);
  const double delta = 0.4;  // the head has a radius of 1 mm
  bench.go(Vec3(0, 0, 5 - delta) - 1e3 * bench.now.world_from_tool.p);
  const double push = kStiffness * 0.5 * delta * kMm;
  EXPECT_NEAR(bench.row.contact.force.z(), push, 0.03 * push);
  EXPECT_NEAR(bench.too().contact.force.z(), -push, 0.03 * push);
  EXPECT_NEAR(bench.moved().z(), -0.5 * delta * kMm, 0.05 * kVoxel);
  EXPECT_EQ(bench.row.spindle_rad_s, 0);
  // let go, it lies, and the first hand has no tool: its force fades
  bench.now_too.pedal = 0;
  bench.ticks(50);
  EXPECT_EQ(bench.row.piece.state, PieceRow::kLies);
  EXPECT_EQ(bench.row.contact.force.norm(), 0);
}

// One hand holds it at a time. The other waits with its button down, and has it when the first lets go; no
// force leaps.
TEST(PieceTwoHands, ItGoesFromHandToHand) {
  Two bench(true);
  bench.grab();
  bench.now_too.pedal = 1;
  bench.ticks(700);
  EXPECT_EQ(bench.row.piece.state, PieceRow::kHeld);
  bench.now.pedal = 0;
  double most = 0;
  for (int n = 0; n < 5; ++n) {
    const Vec3 before = bench.too().contact.force;
    bench.tick();
    EXPECT_EQ(bench.row.piece.state, PieceRow::kHeldByOther) << n;
    most = std::max(most, (bench.too().contact.force - before).norm());
  }
  EXPECT_LT(most, 0.01) << "N";
  EXPECT_LT(bench.moved().norm(), 1e-4 * kMm);
  bench.now_too.valid = false;
  bench.ticks(3);
  EXPECT_EQ(bench.row.piece.state, PieceRow::kLies) << "a lost hand lets go";
  bench.now_too.valid = true;
  bench.ticks(50);
  EXPECT_EQ(bench.row.piece.state, PieceRow::kLies) << "its button is still down";
  bench.command(CommandKind::leave_piece);
  EXPECT_EQ(bench.bone->content_hash(), bench.at_start);
}

// Nobody holds it: a tool pushes it before it, against its drag, until the bone stops it; then the hand feels
// the stretch, as at a wall. It has no weight and stays where it was left.
TEST(PieceTwoHands, AToolPushesALoosePiece) {
  Two bench(true);
  ASSERT_EQ(bench.row.piece.state, PieceRow::kLies);
  bench.put_too({0, 0, 5.7});
  EXPECT_EQ(bench.moved().norm(), 0) << "not touched yet";
  // 1 mm/s while it pushes: the drag's force
  double pushing = 0;
  for (int n = 0; n < 400; ++n) {
    bench.now_too.world_from_tool.p.z() -= 1e-6;
    bench.tick();
    pushing = bench.too().contact.force.z();
  }
  EXPECT_NEAR(pushing, tick::HeldPiece::kDrag * 1e-3, 0.2 * tick::HeldPiece::kDrag * 1e-3);
  EXPECT_NEAR(bench.moved().z(), -0.2 * kMm, 0.07 * kVoxel);
  EXPECT_EQ(bench.row.contact.force.norm(), 0);
  bench.ticks(300);
  EXPECT_LT(bench.too().contact.force.norm(), 1e-3) << "it has yielded";
  const double beyond = 0.6;
  bench.put_too({0, 0, 5.5 - 1e3 * kKerf - beyond});
  EXPECT_NEAR(bench.moved().z(), -kKerf, 0.06 * kVoxel) << "the bottom of the slot";
  EXPECT_NEAR(bench.too().contact.force.z(), kStiffness * beyond * kMm,
              0.04 * kStiffness * beyond * kMm);
  EXPECT_LT(bench.deepest(0), 0.06);
  bench.put_too({0, 0, 8});
  const Vec3 left = bench.moved();
  EXPECT_NEAR(left.z(), -kKerf, 0.06 * kVoxel) << "it stays where it was left";
  // put down where it was pushed to
  ASSERT_TRUE(bench.put_down());
  EXPECT_EQ(bench.missing(), bench.units_at_start - slab::units(*bench.bone));
  EXPECT_EQ(bench.allocations, 0);
  EXPECT_EQ(bench.locks, 0);
}

// A hand takes what a tool rests on: the tool goes on to rest on it.
TEST(PieceTwoHands, AToolThatRestsOnItGoesOnToRest) {
  Two bench(true);
  bench.put_too({0, 0, 5.4});
  bench.ticks(500);
  const double there = bench.moved().z();
  EXPECT_NEAR(there, -0.1 * kMm, 0.05 * kVoxel);
  bench.grab();
  const double delta = 0.2;
  bench.go_too({0, 0, -delta});
  const double push = kStiffness * 0.5 * delta * kMm;
  EXPECT_NEAR(bench.too().contact.force.z(), push, 0.05 * push);
  EXPECT_NEAR(bench.row.contact.force.z(), -push, 0.05 * push);
}

// Both hands swing and push at random: the tool is never deeper in the piece, nor the piece in the bone, than a
// fraction of a voxel, and no force is larger than a hand's limit.
TEST(PieceTwoHands, NeitherGoesIntoTheOther) {
  for (const bool held : {true, false}) {
    Two bench(true);
    if (held) bench.grab();
    const Pose middle = bench.now.world_from_tool;
    bench.put_too({0, 0, 5.3});
    const Pose middle_too = bench.now_too.world_from_tool;
    double most = 0, most_too = 0, deepest = -1, on_face = -1, of_faces = -1;
    for (int n = 0; n < 3000; ++n) {
      const double t = 1e-3 * n;
      bench.now.world_from_tool.p =
          middle.p + kMm * Vec3(1.5 * std::sin(7 * t), 2 * std::sin(3 * t), std::sin(5 * t));
      bench.now.world_from_tool.q = math::turned(
          middle.q, Vec3(0.05 * std::sin(4 * t), 0.1 * std::sin(6 * t), 0.1 * std::sin(3.3 * t)));
      bench.now_too.world_from_tool.p =
          middle_too.p +
          kMm * Vec3(2 * std::sin(5 * t), 5 * std::sin(2 * t), -std::abs(std::sin(9 * t)));
      bench.tick();
      most = std::max(most, bench.row.contact.force.norm());
      most_too = std::max(most_too, bench.too().contact.force.norm());
      const Vec3 ball = bench.too().contact.proxy;
      deepest = std::max(deepest, bench.deep(ball, kBall));
      if (bench.above_the_face(ball)) on_face = std::max(on_face, bench.deep(ball, kBall));
      of_faces = std::max(of_faces, bench.deepest(0.2));
    }
    EXPECT_LE(most, 3.3 + 1e-9);
    EXPECT_LE(most_too, 3.3 + 1e-9);
    EXPECT_GT(most_too, 0.1) << held;
    EXPECT_LT(on_face, 0.15) << "voxel, tool in a face of the piece; held: " << held;
    EXPECT_LT(deepest, 0.6) << "voxel, in an edge, which voxels round off; held: " << held;
    EXPECT_GT(on_face, -0.1);
    EXPECT_LT(of_faces, 0.25) << "voxel, piece in the bone; held: " << held;
    EXPECT_EQ(bench.allocations, 0);
    EXPECT_EQ(bench.locks, 0);
  }
}

// A tool that was pressed to carry does not cut at once when the piece is bone again: not before its button was up.
TEST(PieceTwoHands, AToolThatCarriedWaitsForItsButton) {
  const tick::SecondHandSettings turning = other_hand(true, tool::Role::cuts);
  Bench bench({}, 0, &turning);
  ASSERT_TRUE(bench.lift());
  bench.now_too.pedal = 0;
  bench.tick();
  bench.now_too.pedal = 1;
  bench.ticks(50);
  ASSERT_EQ(bench.row.piece.state, PieceRow::kHeldByOther);
  EXPECT_EQ(bench.second->row().spindle_rad_s, 0);
  bench.command(CommandKind::leave_piece);
  ASSERT_FALSE(bench.servo.piece().lifted());
  EXPECT_EQ(bench.second->row().spindle_rad_s, 0);
  bench.now_too.pedal = 0;
  bench.tick();
  bench.now_too.pedal = 1;
  bench.ticks(300);
  EXPECT_GT(bench.second->row().spindle_rad_s, 0);
}

// A replay must give the same bits on every processor.
TEST(PieceTwoHands, GivesTheSameBitsOnEveryInstructionSet) {
  const rt::Simd best = rt::simd();
  std::optional<std::pair<std::uint64_t, std::uint64_t>> first;
  for (const rt::Simd set : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(set);
    Two bench(true, {}, 1);
    bench.put_too({0.5, 1, 5.2});
    bench.grab();
    bench.go({0.9, 1, 0.5}, {0.02, 0.05, 0.1});
    bench.go_too({0.5, 0.5, -0.5});
    bench.now.pedal = 0;
    bench.go_too({-1, 0.5, -0.2});
    const std::pair now = {bench.row.hash, bench.too().hash};
    if (!first) first = now;
    EXPECT_EQ(now, *first);
  }
  rt::force_simd(best);
}

// Carried by the second hand against the first one's tool, pushed, and carried by the first: recorded and
// replayed, both hands.
TEST(PieceTwoHands, ARecordingReplaysToTheBit) {
  const burr::test::Folder folder;
  const std::string path = (folder.path() / "two.mcap").string();
  NoProgress quiet;
  {
    auto owned = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    auto owned_too = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
    device::ReplayedHand &hand = *owned, &hand_too = *owned_too;
    SessionSettings settings;
    settings.servo = Bench::settings(1, haptics::Method::shaft);
    settings.surface.reserve_blocks = 1 << 14;
    auto made = Session::make(Bench::make(), std::move(owned), settings, quiet);
    ASSERT_TRUE(made.ok()) << made.error().text;
    Session& session = **made;
    tick::SecondHandSettings other = other_hand(false);
    const auto tool = scenario::built_in_rack().get("fissure-bur");
    ASSERT_TRUE(tool.ok());
    other.tool = tool::ShapedTool{tool->name, tool->tool, tool->cutter};
    ASSERT_TRUE(session.add_second_hand(std::move(owned_too), other).ok());
    record::SessionInfo info;
    describe(session.settings(), session.hand().spec(), info);
    describe(session.second_hand()->settings(), session.second_device().spec(), info);
    info.volume.content_hash = session.bone().content_hash();
    info.volume.grid = session.bone().grid();
    info.volume.tissues = session.bone().tissues();
    info.volume.recipe.reserve_bricks = 4096;
    record::Recorder recorder(info.rate_hz, 8192, false, true);
    ASSERT_TRUE(recorder.start(path, info, &session.bone()).ok());
    session.set_recorder(&recorder);
    edit::PieceStore store;
    device::HandState now, too;
    now.world_from_tool.p = Vec3(0, 0, 12) * kMm;
    too.world_from_tool.p = Vec3(0, 0, 9) * kMm;
    const auto go = [&](const Vec3& by, double pedal, const Vec3& by_too, double pedal_too) {
      for (int n = 0; n < 30; ++n) {
        now.world_from_tool.p += kMm / 30 * by;
        too.world_from_tool.p += kMm / 30 * by_too;
        now.pedal = pedal;
        too.pedal = pedal_too;
        hand.set(now);
        hand_too.set(too);
        session.run(0.01, quiet);
      }
    };
    const Vec3 none = Vec3::Zero();
    go(none, 0, none, 0);
    const auto lifted = lift_piece(session, store, Vec3(0, 0, 2) * kMm, quiet);
    ASSERT_TRUE(lifted.ok()) << lifted.error().text;
    go(none, 0, none, 1);  // the second carries
    go(none, 0, none, 1);
    EXPECT_EQ(session.servo().piece().holder(), tick::HeldPiece::kSecond);
    go({0, 0, -7.3}, 0, {0.2, 0, 0}, 1);
    EXPECT_LT(session.servo().piece().pose().p.z(), lifted->centre.z() - 0.05 * kMm)
        << "it was met";
    go({0, 0, 7.3}, 0, none, 1);
    go(none, 0, none, 0);
    const double before = session.servo().piece().pose().p.z();
    go(none, 0, {0, 0, -6}, 0);  // it is pushed
    EXPECT_LT(session.servo().piece().pose().p.z(), before - 0.05 * kMm) << "it was pushed";
    go(none, 1, none, 0);  // the first carries
    go({0.3, 1, 0.2}, 1, none, 0);
    EXPECT_EQ(session.servo().piece().holder(), tick::HeldPiece::kFirst);
    const auto put = put_down(session, store, *lifted, quiet);
    ASSERT_TRUE(put.ok()) << put.error().text;
    go(none, 0, none, 0);
    session.set_recorder(nullptr);
    ASSERT_TRUE(recorder.finish().ok());
  }
  auto player = record::Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  auto bone = (*player)->embedded_bone();
  ASSERT_TRUE(bone.ok());
  const auto again = replay(**player, std::move(*bone), quiet);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_FALSE(again->first_different_tick.has_value()) << again->difference;
  EXPECT_EQ(again->gaps, 0U) << again->difference;  // to the end
}

}  // namespace
}  // namespace burr::sim
