// tests/sim/slab_piece.h - a slab that was sawn free in a block, and the servo that lifts it, tick by tick.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "burr/device/replayed_hand.h"
#include "burr/edit/piece_store.h"
#include "burr/math/turn.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/move_pieces.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"
#include "support/rt_guard.h"

namespace burr::sim::slab {

using math::Pose;
using math::Quat;
using math::Vec3;
using tick::CommandKind;
inline constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;
inline constexpr double kKerf = 0.5 * kMm;  // on each side of the slab
inline constexpr double kStiffness = 500;   // of the hand's spring [N/m]

// A block 20 x 12 x 8 mm with a slot along y from above, and in the slot a slab |x| <= 2, z >= -1 that
// stands free by the kerf.
inline const Vec3 kSlab = Vec3(2, 6, 2.5) * kMm, kSlabAt = Vec3(0, 0, 1.5) * kMm;  // half, middle
inline double mother(const Vec3& p) {
  static const phantom::Depth whole = phantom::box({10 * kMm, 6 * kMm, 4 * kMm}),
                              slot = phantom::box({2 * kMm + kKerf, 20 * kMm, 5.25 * kMm});
  return std::min(whole(p), -slot(p - Vec3(0, 0, 4.25 * kMm - kKerf)));
}
inline double block(const Vec3& p) {
  static const phantom::Depth slab = phantom::box(kSlab);
  return std::max(mother(p), slab(p - kSlabAt));
}

inline std::int64_t units(const volume::Bone& bone) {
  std::int64_t sum = 0;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    if (bone.brick_field(brick) != nullptr) sum += volume::volume_units(bone.brick_field(brick));
  return sum;
}

inline device::DeviceSpec with_torque() {
  device::DeviceSpec spec;
  spec.peak_torque = 0.2;
  spec.actuated = 6;
  return spec;
}

// Servo and hand, tick by tick, on a lattice that is turned against the block.
struct Bench {
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  device::ReplayedHand hand;
  tick::Servo servo;
  edit::PieceStore store;
  edit::PieceStore::Found piece;
  device::HandState now;
  tick::TickRow row;
  std::uint64_t at_start;
  std::int64_t units_at_start;
  long allocations = 0, locks = 0;
  // With a second hand:
  std::unique_ptr<device::ReplayedHand> hand_too;
  std::unique_ptr<tick::SecondHand> second;
  device::HandState now_too;

  explicit Bench(const device::DeviceSpec& spec = {}, double friction = 0,
                 const tick::SecondHandSettings* other = nullptr,
                 haptics::Method touch = haptics::Method::constraint)
      : bone(make()),
        surface(*bone, {.reserve_blocks = 1 << 14}, 2, quiet),
        hand(spec),
        servo(*bone, surface, hand, settings(friction, touch)),
        at_start(bone->content_hash()),
        units_at_start(units(*bone)) {
    now.world_from_tool.p = Vec3(0, 0, 12) * kMm;
    now_too.world_from_tool.p = Vec3(0, 0, 9) * kMm;
    if (other != nullptr) {
      hand_too = std::make_unique<device::ReplayedHand>(spec);
      second = std::make_unique<tick::SecondHand>(servo.shared(), *hand_too, *other);
      servo.set_second(second.get());
    }
    const auto found = store.find(*bone, Vec3(0, 0, 2) * kMm);
    EXPECT_TRUE(found.ok()) << found.error().text;
    if (found.ok()) piece = *found;
    ticks(700);  // past the start ramp
  }
  static std::unique_ptr<volume::Bone> make() {
    volume::Grid grid =
        phantom::box_grid(Vec3(-16, -16, -11) * kMm, Vec3(16, 16, 15) * kMm, kVoxel);
    grid.frame.q = math::normalized(Quat(1, 0.31 / 2, 0.23 / 2, 0.17 / 2));
    grid.frame.p = grid.frame.q * grid.frame.p;
    return phantom::bone_from_distance(grid, {}, block, 4096);
  }
  static tick::ServoSettings settings(double friction,
                                      haptics::Method touch = haptics::Method::constraint) {
    tick::ServoSettings settings;
    settings.touch = touch;
    settings.burr.radius = 1 * kMm;
    settings.force.stiffness = kStiffness;
    settings.force.damping = 0;
    settings.friction_scale = friction;
    settings.undo_bricks = 8192;
    return settings;
  }
  const tick::TickRow& tick() {
    hand.set(now);
    if (hand_too) hand_too->set(now_too);
    const test::RtGuard guard;
    row = servo.tick(false);
    servo.publish();
    allocations += guard.allocations();
    locks += guard.locks();
    return row;
  }
  void ticks(int count) {
    for (int n = 0; n < count; ++n) tick();
  }
  // The hand goes there in so many ticks, and rests as long.
  void go(const Vec3& by_mm, const Vec3& turn = Vec3::Zero(), int count = 300) {
    const Pose from = now.world_from_tool;
    for (int n = 1; n <= count; ++n) {
      const double share = static_cast<double>(n) / count;
      now.world_from_tool.p = from.p + share * kMm * by_mm;
      now.world_from_tool.q = math::turned(from.q, share * turn);
      tick();
    }
    ticks(count);
  }
  bool obeyed(CommandKind kind, const edit::PieceMove& move,
              const edit::PieceStore::NewBricks& prepared) {
    bone->commit_ahead();
    servo.commit_ahead();
    EXPECT_TRUE(servo.lay_ready(*prepared.bricks));
    EXPECT_TRUE(servo.commands().push({kind, static_cast<double>(move.piece), move}));
    double most = 0;
    for (int n = 0; n < 3000; ++n) {
      const Vec3 before = row.contact.force;
      tick();
      most = std::max(most, (row.contact.force - before).norm());
      const tick::MoveState state = servo.move_state();
      if (state == tick::MoveState::refused) return false;
      if (state == tick::MoveState::done) break;
    }
    jump = most;
    store.accept(prepared);
    return servo.move_state() == tick::MoveState::done;
  }
  double jump = 0;  // of the force in any tick of the last command  [N]
  bool lift() {
    edit::PieceMove move = further(piece, Vec3::Zero(), Quat::Identity());
    move.writes = servo.writes_done();
    const auto prepared = store.prepare_lift(*bone, move);
    EXPECT_TRUE(prepared.ok()) << (prepared.ok() ? "" : prepared.error().text);
    if (!prepared.ok()) return false;
    move.bricks = prepared->bricks->hash;
    move.body = prepared->bricks->body.hash;
    return obeyed(CommandKind::lift_piece, move, *prepared);
  }
  // The button is up, then down; from then on the hand holds the piece.
  void grab() {
    now.pedal = 0;
    tick();
    now.pedal = 1;
    ticks(700);
  }
  // Where it would be put down now.
  Result<edit::PieceStore::NewBricks> down(edit::PieceMove& move) {
    move = put_at(piece.number, piece.centre, servo.piece().pose());
    move.writes = servo.writes_done();
    auto prepared = store.prepare(*bone, move);
    if (prepared.ok()) move.bricks = prepared->bricks->hash;
    return prepared;
  }
  bool put_down() {
    edit::PieceMove move;
    const auto prepared = down(move);
    return prepared.ok() && obeyed(CommandKind::move_piece, move, *prepared);
  }
  void command(CommandKind kind, int count = 600) {
    servo.commands().push({kind, 0});
    ticks(count);
  }
  [[nodiscard]] Vec3 moved() const { return servo.piece().pose().p - piece.centre; }
  // How deep any place of the slab's faces is in the block now, by the formulas  [voxel]. inset: of the
  // places from the edges, as a share of half a side.
  [[nodiscard]] double deepest(double inset) const {
    constexpr int kParts = 12;
    const Pose body = servo.piece().pose();
    double most = -1;
    for (int face = 0; face < 6; ++face)
      for (int u = 0; u <= kParts; ++u)
        for (int v = 0; v <= kParts; ++v) {
          Vec3 at;
          at[face / 2] = face % 2 == 0 ? 1 : -1;
          at[(face / 2 + 1) % 3] = (1 - inset) * (2.0 * u / kParts - 1);
          at[(face / 2 + 2) % 3] = (1 - inset) * (2.0 * v / kParts - 1);
          const Vec3 p = body.p + body.q * Vec3(kSlabAt + kSlab.cwiseProduct(at) - piece.centre);
          most = std::max(most, mother(p) / kVoxel);
        }
    return most;
  }
  [[nodiscard]] std::int64_t missing() const {
    const double unit = std::pow(kVoxel, 3) / static_cast<double>(volume::kVoxelUnits);
    return std::llround((row.ledger.removed - row.ledger.undone + row.ledger.moved) / unit);
  }
};

}  // namespace burr::sim::slab
