// What cutting does to the hand, the spindle and the bone's temperature, in whole sessions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/rt/flags.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/flag_words.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"

namespace burr::tick {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;
constexpr double kRadius = 2 * kMm;

std::unique_ptr<volume::Bone> slab(double cutting_energy = 1e9) {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm),
      phantom::bone_that_costs(cutting_energy), phantom::slab(), 256);
}

// A rigid hand that comes down to `deep` in the bone, its shaft lying along x, and waits there.
std::unique_ptr<device::SimulatedHand> pressing(double deep, double seconds, double pedal = 1,
                                                const device::DeviceSpec& spec = {}) {
  device::HandPath path;
  const math::Quat lying(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));  // z to x
  for (const auto& [t, z] : {std::pair{0.0, 1 * kMm}, std::pair{0.8, 1 * kMm},
                             std::pair{1.0, -deep}, std::pair{seconds, -deep}}) {
    device::PathPoint point;
    point.t = t;
    point.world_from_tool.q = lying;
    point.world_from_tool.p = {0, 0, kRadius + z};
    point.pedal = pedal;
    path.points.push_back(point);
  }
  device::ArmSettings rigid;
  rigid.stiffness = INFINITY;
  return std::make_unique<device::SimulatedHand>(path, rigid, spec);
}

constexpr double kNever = 1e18;  // J/m^3: bone that cannot be cut in these times

std::unique_ptr<sim::Session> session(sim::SessionSettings settings,
                                      std::unique_ptr<volume::Bone> bone, double deep = 1 * kMm,
                                      double seconds = 3) {
  NoProgress quiet;
  settings.servo.burr.radius = kRadius;
  settings.servo.undo_bricks = 1024;
  settings.surface.reserve_blocks = 1 << 13;
  auto made = sim::Session::make(std::move(bone), pressing(deep, seconds), settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  return std::move(*made);
}

// The force of the last tenth of the session, in the mean.
Vec3 settled_force(sim::Session& run, int ticks = 2900) {
  Vec3 sum = Vec3::Zero();
  for (int n = 0; n < ticks; ++n) {
    const TickRow& row = run.servo().tick(false);
    if (n >= ticks - 300) sum += row.contact.force;
    run.servo().publish();
  }
  return sum / 300;
}

TEST(Drag, ATurningBurrIsPulledAlongTheSurfaceByItsCuttingFriction) {
  sim::SessionSettings settings;
  settings.servo.friction_turning = 0;  // what friction there is beside it
  const double mu = volume::Tissue{}.cutting_friction;
  const Vec3 forward = settled_force(*session(settings, slab(kNever)));
  EXPECT_NEAR(forward.z(), 1, 0.02);
  EXPECT_NEAR(std::hypot(forward.x(), forward.y()) / forward.z(), mu, 0.01);
  // shaft to the hand along +x; clockwise seen from there: w along -x, the underside (along -z)
  // slides along w x (-z) = -y, so the bone pulls along +y
  EXPECT_NEAR(forward.y() / forward.z(), mu, 0.01);

  settings.servo.burr.kind = tool::BurrKind::diamond;
  const Vec3 diamond = settled_force(*session(settings, slab(kNever)));
  EXPECT_NEAR(diamond.y() / diamond.z(), 0.25 * mu, 0.01);
  settings.servo.spindle_rad_s *= -1;
  const Vec3 backwards = settled_force(*session(settings, slab(kNever)));
  EXPECT_NEAR(backwards.y(), -diamond.y(), 1e-3);
  settings.servo.drag_gain = 0;
  EXPECT_NEAR(settled_force(*session(settings, slab(kNever))).y(), 0, 1e-3);
}

TEST(Drag, IsThatOfTheTissueUnderTheBurr) {
  sim::SessionSettings settings;
  settings.servo.friction_turning = 0;
  auto bone = slab(kNever);
  volume::TissueTable tissues = bone->tissues();
  tissues.tissues[1].cutting_friction = 0.2;
  const Vec3 smooth = settled_force(
      *session(settings, phantom::bone_from_distance(bone->grid(), tissues, phantom::slab(), 256)));
  EXPECT_NEAR(smooth.y() / smooth.z(), 0.2, 0.01);
}

TEST(Drag, IsNeverMoreThanThePushCausesAndGrowsWithoutAStep) {
  sim::SessionSettings settings;
  settings.servo.friction_turning = 0;
  const auto run = session(settings, slab());
  Vec3 last = Vec3::Zero();
  double steepest = 0, most = 0;
  for (int n = 0; n < 2900; ++n) {
    const TickRow& row = run->servo().tick(false);
    const haptics::Contact& contact = row.contact;
    const Vec3 along = contact.force - contact.force.dot(contact.normal) * contact.normal;
    const double push = std::max(0.0, contact.force.dot(contact.normal));
    EXPECT_LE(along.norm(), volume::Tissue{}.cutting_friction * push + 1e-9) << n;
    most = std::max(most, along.norm());
    steepest = std::max(steepest, (along - last).norm());
    last = along;
    run->servo().publish();
  }
  EXPECT_GT(most, 0.2);
  EXPECT_LT(steepest, 0.02) << "[N] in a tick";
}

// In a hole that just takes the burr, the bone's pull is a force across the displacement, of
// mu k = 400 N/m: a mass m with a damper b between walls k bears b sqrt(k / m), 200 N/m for these
// 25 g and 1 N s/m. So a pull without delay winds such a hand up in circles.
TEST(Drag, FollowsSoSlowlyThatALightHandDoesNotWhirlInAHole) {
  const auto swings = [](double drag_gain, double drag_hz) {
    device::HandPath path;
    for (const auto& [t, aside] :
         {std::pair{0.0, 0.0}, {0.4, 0.0}, {0.5, 0.3 * kMm}, {3.0, 0.3 * kMm}}) {
      device::PathPoint point;
      point.t = t;
      point.world_from_tool.p = {aside, 0, -3 * kMm};
      point.pedal = 1;
      path.points.push_back(point);
    }
    sim::SessionSettings settings;
    settings.servo.burr.radius = kRadius;
    settings.servo.friction_turning = 0;
    settings.servo.drag_gain = drag_gain;
    settings.servo.drag_hz = drag_hz;
    settings.surface.reserve_blocks = 1 << 13;
    NoProgress quiet;
    auto run = sim::Session::make(
        phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-6 * kMm), Vec3::Constant(6 * kMm), 0.25 * kMm),
            phantom::bone_that_costs(kNever),
            phantom::without(phantom::slab(), phantom::cylinder(kRadius + 0.01 * kMm, 8 * kMm)),
            256),
        std::make_unique<device::SimulatedHand>(path, device::ArmSettings{0.025, 1, 50}), settings,
        quiet);
    EXPECT_TRUE(run.ok()) << run.error().text;
    double farthest = 0;
    for (int n = 0; n < 2900; ++n) {
      const TickRow& row = (*run)->servo().tick(false);
      const Vec3& at = row.hand.world_from_tool.p;
      if (n >= 2000) farthest = std::max(farthest, std::hypot(at.x(), at.y()));
      (*run)->servo().publish();
    }
    std::printf("drag %.0f at %4.0f Hz: %.3f mm from the middle of the hole\n", drag_gain, drag_hz,
                farthest / kMm);
    return farthest;
  };
  const double none = swings(0, 5), slow = swings(1, 5), quick = swings(1, 400);
  EXPECT_LT(slow, none + 0.05 * kMm);
  EXPECT_GT(quick, none + 0.2 * kMm);
}

TEST(Spindle, GivesWayAndStallsUnderTheHandAndTheSessionSaysSo) {
  sim::SessionSettings settings;
  NoProgress quiet;
  // 1 N at 2 mm with mu 0.4 is 0.8 mN m
  settings.servo.motor.torque = 8e-3;
  settings.servo.motor.friction = 0;
  const auto turning = session(settings, slab(kNever));
  turning->run(3, quiet);
  TickRow row;
  static_cast<void>(turning->view(row));
  EXPECT_NEAR(row.cutting_nm, 0.8e-3, 0.03e-3);
  EXPECT_NEAR(row.spindle_rad_s / settings.servo.spindle_rad_s, 1 - 0.1 * 0.1, 0.003);
  EXPECT_NEAR(row.cutting_w, row.cutting_nm * row.spindle_rad_s, 0.02 * row.cutting_w);
  EXPECT_EQ(turning->outcome().flags & rt::kFlagStalled, 0U);

  settings.servo.motor.torque = 0.4e-3;
  const auto stalled = session(settings, slab());
  stalled->run(3, quiet);
  static_cast<void>(stalled->view(row));
  EXPECT_NE(stalled->outcome().flags & rt::kFlagStalled, 0U);
  EXPECT_EQ(row.spindle_rad_s, 0);
  EXPECT_EQ(row.cutting_w, 0);
  ASSERT_FALSE(words(worth_telling(stalled->outcome().flags)).empty());
  const auto free = session({}, slab());
  free->run(3, quiet);
  EXPECT_LT(stalled->outcome().ledger.removed, 0.5 * free->outcome().ledger.removed);
}

TEST(Spindle, FlutesCutNothingBackwardsGrainsDo) {
  NoProgress quiet;
  sim::SessionSettings settings;
  settings.servo.spindle_rad_s = -4000;
  const auto flutes = session(settings, slab());
  flutes->run(2.9, quiet);
  EXPECT_EQ(flutes->outcome().ledger.removed, 0);
  settings.servo.burr.kind = tool::BurrKind::diamond;
  const auto grains = session(settings, slab());
  grains->run(2.9, quiet);
  EXPECT_GT(grains->outcome().ledger.removed, 1e-10);
}

// ---- the drill twists in the hand

// A hand that can be turned, and keeps what it was told.
class TurnedHand final : public device::Device {
 public:
  explicit TurnedHand(std::unique_ptr<device::SimulatedHand> hand) : hand_(std::move(hand)) {
    torques.reserve(8192);
  }
  Status open() override { return hand_->open(); }
  void close() override { hand_->close(); }
  [[nodiscard]] const device::DeviceSpec& spec() const override { return hand_->spec(); }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override { return hand_->state(dt); }
  void write_force(const Vec3& force) BURR_RT override {
    if (torques.size() < torques.capacity()) torques.push_back(torque_);
    torque_ = Vec3::Zero();
    hand_->write_force(force);
  }
  void write_torque(const Vec3& torque) BURR_RT override { torque_ = torque; }
  std::vector<Vec3> torques;

 private:
  std::unique_ptr<device::SimulatedHand> hand_;
  Vec3 torque_ = Vec3::Zero();
};

const device::DeviceSpec kTurned = {.peak_force = 12, .continuous_force = 12, .peak_torque = 0.2};

// 1 N at 2 mm with mu 0.4 is 0.8 mN m. The shaft lies along +x, to the hand; the burr turns
// clockwise seen from there, so the handpiece is twisted anticlockwise: about +x.
TEST(Twist, IsTheTorqueOfTheBoneAboutTheShaftAndOfTheRotorAsItStarts) {
  NoProgress quiet;
  for (const double way : {1.0, -1.0}) {
    sim::SessionSettings settings;
    settings.servo.burr.radius = kRadius;
    settings.servo.burr.kind = tool::BurrKind::diamond;
    settings.servo.undo_bricks = 1024;
    settings.servo.spindle_rad_s *= way;
    settings.servo.limit.user_force = 12;
    settings.surface.reserve_blocks = 1 << 13;
    auto owned = std::make_unique<TurnedHand>(pressing(1 * kMm, 3, 1, kTurned));
    const TurnedHand& hand = *owned;
    auto run = sim::Session::make(slab(kNever), std::move(owned), settings, quiet);
    ASSERT_TRUE(run.ok()) << run.error().text;
    (*run)->run(2.9, quiet);
    TickRow row;
    ASSERT_TRUE((*run)->view(row));
    EXPECT_NEAR(row.cutting_nm, 0.25 * 0.8e-3, 0.02e-3) << "diamond bites a quarter as much";
    EXPECT_NEAR((row.contact.torque - way * row.cutting_nm * Vec3::UnitX()).norm(), 0, 5e-6);
    double most = 0;
    for (std::size_t n = 1; n < 800; ++n) {
      const double now = way * hand.torques[n].x(), last = way * hand.torques[n - 1].x();
      most = std::max(most, now);
      EXPECT_LE(now - last, 0.2 / 12 * 0.06 + 1e-12) << n << ": the start ramp holds it back";
      EXPECT_LT(std::hypot(hand.torques[n].y(), hand.torques[n].z()), 1e-12);
    }
    EXPECT_GT(most, 10e-3) << "it starts with a jerk";
    EXPECT_LE(most, settings.servo.motor.torque + 1e-9);
    // and at the end it is let go in five steps, not dropped
    const auto count = hand.torques.size();
    for (std::size_t n = 1; n <= 5; ++n)
      EXPECT_NEAR((hand.torques[count - 6 + n] -
                   (1 - 0.2 * static_cast<double>(n)) * hand.torques[count - 6])
                      .norm(),
                  0, 1e-12);
    EXPECT_EQ(hand.torques.back(), Vec3::Zero());
  }
}

TEST(Twist, IsNotForAHandThatCannotBeTurnedOrWantsNone) {
  NoProgress quiet;
  for (const bool can : {false, true}) {
    sim::SessionSettings settings;
    settings.servo.burr.radius = kRadius;
    settings.servo.undo_bricks = 1024;
    settings.servo.torque_gain = can ? 0 : 1;
    settings.surface.reserve_blocks = 1 << 13;
    auto owned =
        std::make_unique<TurnedHand>(pressing(1 * kMm, 3, 1, can ? kTurned : device::DeviceSpec()));
    const TurnedHand& hand = *owned;
    auto run = sim::Session::make(slab(kNever), std::move(owned), settings, quiet);
    ASSERT_TRUE(run.ok()) << run.error().text;
    (*run)->run(2, quiet);
    for (const Vec3& torque : hand.torques) EXPECT_EQ(torque, Vec3::Zero());
    EXPECT_GT(hand.torques.size(), 1900U);
  }
}

TEST(ChipsLaw, CutsInASessionAndTheLedgerBalances) {
  NoProgress quiet;
  sim::SessionSettings settings;
  settings.servo.removal.law = edit::RemovalLaw::chips;
  const auto run = session(settings, slab());
  const double before = volume::volume_of(run->bone());
  run->run(2.9, quiet);
  const edit::Ledger ledger = run->outcome().ledger;
  EXPECT_GT(ledger.removed, 1e-9);
  EXPECT_NEAR(before - volume::volume_of(run->bone()), ledger.removed, 1e-6 * ledger.removed);
  EXPECT_NEAR(ledger.asked, ledger.removed + ledger.debt + ledger.not_cut, 1e-6 * ledger.asked);
}

TEST(ChipsLaw, ASlowSpindleBeatsOncePerToothAsFastAsTheTickCanCarry) {
  for (const double tooth_hz : {40.0, 2000.0}) {
    sim::SessionSettings settings;
    settings.servo.removal.law = edit::RemovalLaw::chips;
    settings.servo.friction_turning = 0;
    settings.servo.burr.teeth = 4;
    settings.servo.spindle_rad_s = 2 * std::numbers::pi * tooth_hz / 4;
    const auto run = session(settings, slab(kNever));
    std::vector<double> force;
    for (int n = 0; n < 2900; ++n) {
      const TickRow& row = run->servo().tick(false);
      if (n >= 1900) force.push_back(row.contact.force.y());
      run->servo().publish();
    }
    double re = 0, im = 0;  // at the tooth's frequency, folded below 500 Hz or not
    for (std::size_t n = 0; n < force.size(); ++n) {
      const double turn = 2 * std::numbers::pi * tooth_hz * static_cast<double>(n) * 1e-3;
      re += force[n] * std::cos(turn) * 2e-3;
      im += force[n] * std::sin(turn) * 2e-3;
    }
    double mean = 0, spread = 0;
    for (const double one : force) mean += one / 1000;
    for (const double one : force) spread += (one - mean) * (one - mean) / 1000;
    EXPECT_GT(mean, 0.3);

    if (tooth_hz < 400) {
      EXPECT_GT(std::hypot(re, im), 0.2 * mean) << "felt";
    } else {
      EXPECT_LT(std::sqrt(spread), 0.02 * mean) << "not folded down to where it is not";
    }
  }
}

// A watt for a second warms by a watt-second; irrigation takes some of it away.
TEST(Heat, WhatTheBurrSpendsWarmsTheBoneAndCoolantTakesItAway) {
  NoProgress quiet;
  double ever[2] = {};
  for (const bool wet : {false, true}) {
    sim::SessionSettings settings;
    settings.servo.irrigated = wet;
    sim::HeatRequest request;
    request.work.extend(Vec3::Constant(-7 * kMm));
    request.work.extend(Vec3::Constant(7 * kMm));
    settings.heat = request;
    const auto run = session(settings, slab(), 1 * kMm, 5);
    double spent = 0;
    for (int n = 0; n < 4901; ++n) {
      spent += 1e-3 * run->servo().tick(false).cutting_w;
      run->servo().publish();
    }
    run->run(0.001, quiet);  // settles
    thermal::HeatSummary summary;
    ASSERT_TRUE(run->heat(summary));
    EXPECT_NEAR(summary.ledger.spent, spent, 0.05 * spent);
    EXPECT_GT(spent, 1) << "[J]";
    const thermal::HeatLedger& ledger = summary.ledger;
    EXPECT_NEAR(ledger.into, ledger.stored + ledger.convected + ledger.conducted + ledger.removed,
                1e-9 * ledger.spent);
    EXPECT_NEAR(ledger.into + ledger.missed, 0.25 * ledger.spent, 0.02 * ledger.spent);
    EXPECT_EQ(ledger.convected > 0, wet);
    ever[wet ? 1 : 0] = summary.tissue[1].ever_c;
    EXPECT_EQ(run->outcome().heat_rows_lost, 0U);
  }
  EXPECT_GT(ever[0], 40);
  EXPECT_LT(ever[1], ever[0]);
}

TEST(Heat, NothingFeltDependsOnIt) {
  NoProgress quiet;
  std::uint64_t hash[2] = {};
  for (const bool heated : {false, true}) {
    sim::SessionSettings settings;
    if (heated) {
      sim::HeatRequest request;
      request.work.extend(Vec3::Constant(-7 * kMm));
      request.work.extend(Vec3::Constant(7 * kMm));
      settings.heat = request;
    }
    const auto run = session(settings, slab());
    run->run(2, quiet);
    TickRow row;
    static_cast<void>(run->view(row));
    hash[heated ? 1 : 0] = row.hash;
  }
  EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace burr::tick
