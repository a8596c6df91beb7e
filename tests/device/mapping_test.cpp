// A real hand mapped into the world: axes, scale, clutch, and the limits for touch.
#include "burr/device/mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "burr/device/axes.h"
#include "support/rt_guard.h"

namespace burr::device {
namespace {

using math::Quat;
using math::Vec3;

// Stays where it is put, and remembers the force.
class Stub final : public Device {
 public:
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] HandState state(double) BURR_RT override { return hand; }
  void write_force(const Vec3& force) BURR_RT override { pushed = force; }
  void write_torque(const Vec3& torque) BURR_RT override { twisted = torque; }
  HandState hand;
  Vec3 pushed = Vec3::Zero(), twisted = Vec3::Zero();

 private:
  DeviceSpec spec_{.max_stiffness = 800,
                   .max_damping = 4,
                   .max_turn_stiffness = 0.2,
                   .turn_damping = 1e-3,
                   .lever = 0.05,
                   .simulated = false};
};

const Vec3 kStart = {0.01, 0.02, 0.03};
// view from above with the head up: right is right, the view's up points away from the viewer's
// feet
const Quat kTurn = Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));

struct Laid {
  Stub* stub = nullptr;
  std::unique_ptr<MappedHand> hand;
  explicit Laid(const MappingSettings& settings = {}) {
    auto device = std::make_unique<Stub>();
    stub = device.get();
    stub->hand.world_from_tool.p = {0.04, -0.05, 0.06};
    hand = std::make_unique<MappedHand>(std::move(device), math::Pose{kStart, Quat::Identity()},
                                        kTurn, settings);
    EXPECT_TRUE(hand->open().ok());
  }
  Vec3 tip() { return hand->state(1e-3).world_from_tool.p; }
  void move(const Vec3& by) { stub->hand.world_from_tool.p += by; }
};

TEST(MappedHand, TenMillimetresAreTenAlongTheAxesOfTheView) {
  Laid laid;
  EXPECT_NEAR((laid.tip() - kStart).norm(), 0, 1e-15) << "the tip begins where it was told";
  for (const auto& [by, is] : {std::pair<Vec3, Vec3>{{0.01, 0, 0}, {0.01, 0, 0}},
                               {{0, 0.01, 0}, {0, 0, 0.01}},
                               {{0, 0, 0.01}, {0, -0.01, 0}}}) {
    const Vec3 before = laid.tip();
    laid.move(by);
    EXPECT_NEAR((laid.tip() - before - is).norm(), 0, 1e-12);
    laid.hand->write_force(is);
    EXPECT_NEAR((laid.stub->pushed - by).norm(), 0, 1e-12) << "the force comes from the same side";
    laid.hand->write_torque(is);
    EXPECT_NEAR((laid.stub->twisted - by).norm(), 0, 1e-12) << "and so does the torque";
    laid.hand->write_force(Vec3::Zero());
  }
}

// The hand feels a wall of stiffness k at the tip as k times the scale: never more than the device
// allows.
TEST(MappedHand, AScaledHandFeelsNoWallStifferThanItCanShow) {
  for (const double scale : {0.25, 1.0, 4.0}) {
    Laid laid({.scale = scale});
    const Vec3 before = laid.tip();
    const Vec3 by = {0, 2e-3, 0};
    laid.move(by);
    const Vec3 way = laid.tip() - before;
    EXPECT_NEAR(way.norm(), scale * by.norm(), 1e-12);
    laid.hand->write_force(-laid.hand->spec().max_stiffness * way);
    const double felt = laid.stub->pushed.norm() / by.norm();
    EXPECT_NEAR(felt, 800, 1e-6) << scale;
    EXPECT_NEAR(laid.hand->spec().max_damping * scale, 4, 1e-12);
  }
}

// Work at the hand is 1 / scale of that in the world, by force and by torque alike.
TEST(MappedHand, AScaledHandDoesTheSameShareOfWorkInBothWays) {
  for (const double scale : {0.5, 4.0}) {
    Laid laid({.scale = scale});
    const DeviceSpec& spec = laid.hand->spec();
    EXPECT_EQ(spec.scale, scale);
    EXPECT_NEAR(spec.max_turn_stiffness, 0.2 * scale, 1e-15);
    EXPECT_NEAR(spec.turn_damping, 1e-3 * scale, 1e-15);
    EXPECT_NEAR(spec.lever, 0.05 * scale, 1e-15);
  }
}

// A jammed tool gives a couple without a force: the axes wait for it too.
TEST(MappedHand, TheAxesDoNotTurnUnderATorque) {
  Laid laid;
  static_cast<void>(laid.tip());
  laid.hand->write_torque({0.01, 0, 0});
  laid.hand->write_force(Vec3::Zero());
  laid.hand->set_axes(Quat::Identity());
  const Quat before = laid.hand->state(1e-3).world_from_tool.q;
  EXPECT_EQ(laid.hand->state(1e-3).world_from_tool.q.coeffs(), before.coeffs());
  EXPECT_LT(before.angularDistance(kTurn), 1e-7);
  laid.hand->write_force(Vec3::Zero());
  EXPECT_LT(laid.hand->state(1e-3).world_from_tool.q.angularDistance(Quat::Identity()), 1e-7);
}

// The view was turned while the tool pressed. If the hand then grabs a piece of bone and lifts the tool off,
// the axes wait, or the piece would turn at once.
TEST(MappedHand, TheAxesDoNotTurnWhileItCarries) {
  for (const bool foot : {false, true}) {
    Laid laid;
    static_cast<void>(laid.tip());
    const auto turn = [&] { return laid.hand->state(1e-3).world_from_tool.q; };
    const auto grab = [&](bool grabs) {
      if (foot)
        laid.hand->press(grabs ? 1 : 0);
      else
        laid.stub->hand.buttons = grabs ? 1 : 0;
    };
    laid.hand->write_force({0, 0, 1});
    laid.hand->set_axes(Quat::Identity());
    laid.hand->carry(true);
    const Quat before = turn();
    grab(true);
    EXPECT_EQ(turn().coeffs(), before.coeffs());
    laid.hand->write_force(Vec3::Zero());  // off the bone
    for (int n = 0; n < 3; ++n) {
      laid.move({0, 0, 0.001});
      EXPECT_EQ(turn().coeffs(), before.coeffs()) << foot;
    }
    const Vec3 tip = laid.tip();
    grab(false);
    EXPECT_LT(turn().angularDistance(Quat::Identity()), 1e-7) << "now it may";
    EXPECT_EQ(laid.hand->state(1e-3).pedal, 0);
    EXPECT_NEAR((laid.tip() - tip).norm(), 0, 1e-12);
    // a tool that runs in free air waits for nothing
    laid.hand->carry(false);
    grab(true);
    laid.hand->set_axes(kTurn);
    EXPECT_LT(turn().angularDistance(kTurn), 1e-7);
  }
}

TEST(MappedHand, RefusesAScaleThatMakesNoSense) {
  for (const double scale : {0.0, -1.0, 100.0, std::numeric_limits<double>::quiet_NaN()}) {
    MappedHand hand(std::make_unique<Stub>(), {}, Quat::Identity(), {.scale = scale});
    const Status opened = hand.open();
    ASSERT_FALSE(opened.ok());
    EXPECT_NE(opened.error().text.find("scale"), std::string::npos);
  }
}

TEST(MappedHand, LiftedTheTipStaysAndGoesOnFromThere) {
  Laid laid({.clutch_button = 1});
  laid.move({0.003, 0, 0});
  const Vec3 before = laid.tip();
  laid.stub->hand.buttons = 2;
  for (int n = 0; n < 20; ++n) {
    laid.move({0.002, 0.001, 0});
    const HandState hand = laid.hand->state(1e-3);
    EXPECT_EQ(hand.world_from_tool.p, before);
    EXPECT_EQ(hand.velocity, Vec3::Zero());
    EXPECT_TRUE((hand.buttons & kLifted) != 0);
    EXPECT_EQ(hand.pedal, 0);
  }
  laid.stub->hand.buttons = 0;
  const HandState down = laid.hand->state(1e-3);
  EXPECT_NEAR((down.world_from_tool.p - before).norm(), 0, 1e-12);
  EXPECT_TRUE((down.buttons & kLifted) == 0);
  laid.move({0.001, 0, 0});
  EXPECT_NEAR((laid.tip() - before - Vec3(0.001, 0, 0)).norm(), 0, 1e-12);
  laid.hand->lift(true);  // by the foot
  EXPECT_TRUE((laid.hand->state(1e-3).buttons & kLifted) != 0);
}

// While there is a force, turning the view would turn the force at once.
TEST(MappedHand, TheAxesFollowTheViewOnlyInFreeAirAndTheTipStays) {
  Laid laid;
  const Vec3 before = laid.tip();
  laid.hand->write_force({0, 0, 1});
  const Vec3 pushed = laid.stub->pushed;
  laid.hand->set_axes(Quat::Identity());
  EXPECT_EQ(laid.tip(), before);
  laid.hand->write_force({0, 0, 1});
  EXPECT_EQ(laid.stub->pushed, pushed);
  laid.hand->write_force(Vec3::Zero());
  EXPECT_NEAR((laid.tip() - before).norm(), 0, 1e-12);
  laid.move({0, 0, 0.01});
  EXPECT_NEAR((laid.tip() - before - Vec3(0, 0, 0.01)).norm(), 0, 1e-12);
}

TEST(MappedHand, WhereverALostHandComesBackTheTipIsWhereItWas) {
  Laid laid;
  const Vec3 before = laid.tip();
  laid.stub->hand.valid = false;
  const HandState lost = laid.hand->state(1e-3);
  EXPECT_FALSE(lost.valid);
  EXPECT_EQ(lost.world_from_tool.p, before);
  laid.move({0.05, 0.05, -0.02});
  laid.stub->hand.valid = true;
  EXPECT_NEAR((laid.tip() - before).norm(), 0, 1e-12);
}

// Not corrected here, because the safety layer must see it.
TEST(MappedHand, WhatIsNoPlaceStaysNone) {
  Laid laid;
  laid.stub->hand.world_from_tool.p.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(laid.hand->state(1e-3).world_from_tool.finite());
}

TEST(MappedHand, TheMillButtonAndTheFootAreThePedal) {
  Laid laid;
  EXPECT_EQ(laid.hand->state(1e-3).pedal, 0);
  laid.stub->hand.buttons = 1;
  EXPECT_EQ(laid.hand->state(1e-3).pedal, 1);
  laid.stub->hand.buttons = 0;
  laid.hand->press(0.4);
  EXPECT_EQ(laid.hand->state(1e-3).pedal, 0.4);
}

// A robot's base looks forward: x far, y left, z up.
TEST(MappedHand, ADevicesAxesAreAsItStands) {
  const auto axes = axes_from_words("far left up");
  ASSERT_TRUE(axes.has_value());
  Laid laid({.axes = *axes});
  static_cast<void>(laid.tip());
  for (const auto& [by, is] : {std::pair<Vec3, Vec3>{{0.01, 0, 0}, {0, 0, -0.01}},
                               {{0, 0.01, 0}, {-0.01, 0, 0}},
                               {{0, 0, 0.01}, {0, 0.01, 0}}}) {
    const Vec3 before = laid.tip();
    laid.move(by);
    EXPECT_NEAR((laid.tip() - before - kTurn * is).norm(), 0, 1e-12);
    laid.hand->write_force(kTurn * (100 * is));
    EXPECT_NEAR((laid.stub->pushed - 100 * by).norm(), 0, 1e-12);
    laid.hand->write_force(Vec3::Zero());
  }
  laid.hand->set_axes(Quat::Identity());  // the view was turned; the device has not moved
  static_cast<void>(laid.tip());
  const Vec3 before = laid.tip();
  laid.move({0.01, 0, 0});
  EXPECT_NEAR((laid.tip() - before - Vec3(0, 0, -0.01)).norm(), 0, 1e-12);
}

TEST(MappedHand, AxesAreWordsOfARightHandedFrame) {
  EXPECT_EQ(words_of_axes(Quat::Identity()), "right up near");
  int frames = 0;
  const char* ways[] = {"right", "left", "up", "down", "near", "far"};
  for (const char* x : ways)
    for (const char* y : ways)
      for (const char* z : ways) {
        const std::string words = std::string(x) + " " + y + " " + z;
        const auto axes = axes_from_words(words);
        if (!axes) continue;
        ++frames;
        EXPECT_EQ(words_of_axes(*axes), words);
      }
  EXPECT_EQ(frames, 24) << "turns of a cube";
  for (const char* bad :
       {"", "right up", "right up far", "right right near", "x y z", "right up near near"})
    EXPECT_FALSE(axes_from_words(bad).has_value()) << bad;
}

TEST(MappedHand, LiftedByTheDeviceItIsLaidElsewhereToo) {
  Laid laid;
  const Vec3 tip = laid.tip();
  laid.stub->hand.buttons = kLifted;
  laid.stub->hand.pedal = 1;
  laid.move({0.02, 0, 0});
  EXPECT_EQ(laid.tip(), tip);
  EXPECT_EQ(laid.hand->state(1e-3).pedal, 0);
  laid.stub->hand.buttons = 0;
  EXPECT_EQ(laid.tip(), tip);
}

TEST(MappedHand, TheTipsSpeedIsScaledAsItsWayAndNoneWhileItIsLifted) {
  Laid laid({.scale = 0.5});
  laid.stub->hand.velocity = {0, 0.2, 0};
  EXPECT_NEAR((laid.hand->state(1e-3).velocity - Vec3(0, 0, 0.1)).norm(), 0, 1e-15);
  laid.hand->lift(true);
  EXPECT_EQ(laid.hand->state(1e-3).velocity, Vec3::Zero());
}

TEST(MappedHand, OfTheFootAndTheDevicesOwnPedalTheLargerCounts) {
  Laid laid;
  const auto pedal = [&] { return laid.hand->state(1e-3).pedal; };
  laid.stub->hand.pedal = 0.3;
  EXPECT_EQ(pedal(), 0.3);
  laid.hand->press(0.1);
  EXPECT_EQ(pedal(), 0.3);
  laid.hand->press(0.8);
  EXPECT_EQ(pedal(), 0.8);
}

// Pressing any of the three shows that the user is there.
TEST(MappedHand, TheDeadManIsAwakeByButtonFootOrTheDevicesOwnPedal) {
  Laid laid({.dead_man = true});
  const auto lifted = [&] { return (laid.hand->state(1e-3).buttons & kLifted) != 0; };
  EXPECT_TRUE(lifted());
  laid.hand->press(0.2);
  EXPECT_FALSE(lifted());
  laid.hand->press(0);
  EXPECT_TRUE(lifted());
  laid.stub->hand.pedal = 0.2;
  EXPECT_FALSE(lifted());
  laid.stub->hand.pedal = 0;
  EXPECT_TRUE(lifted());
  laid.stub->hand.buttons = 1;
  EXPECT_FALSE(lifted());
}

// A fading force keeps its direction, whether the hand is lifted or not.
TEST(MappedHand, TheAxesOfAForceThatFadesAreThoseItBeganWith) {
  Laid laid;
  laid.tip();
  laid.hand->write_force({0, 0, 1});
  const Vec3 pushed = laid.stub->pushed;
  ASSERT_EQ(pushed.norm(), 1);
  laid.hand->lift(true);
  laid.hand->set_axes(kTurn * kTurn);
  laid.tip();
  laid.hand->write_force({0, 0, 0.5});
  EXPECT_NEAR((laid.stub->pushed - 0.5 * pushed).norm(), 0, 1e-12);
  laid.hand->write_force(Vec3::Zero());
  laid.tip();
  laid.hand->write_force({0, 0, 0.5});
  EXPECT_GT((laid.stub->pushed - 0.5 * pushed).norm(), 0.1) << "turned, once nothing was pushed";
}

TEST(MappedHand, TakesNoMemory) {
  Laid laid;
  const test::RtGuard guard;
  for (int n = 0; n < 100; ++n) {
    laid.hand->set_axes(n % 2 == 0 ? Quat(Quat::Identity()) : kTurn);
    static_cast<void>(laid.hand->state(1e-3));
    laid.hand->write_force({0, 0, 0.1 * (n % 3)});
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace burr::device
