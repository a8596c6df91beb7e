// The force limits on made-up ticks: nothing unbounded, no sudden increase, and the way back always
// by the start ramp.
#include "burr/haptics/safety/limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "burr/haptics/contact.h"
#include "burr/haptics/safety/watchdog.h"
#include "burr/rt/flags.h"

namespace burr::haptics {
namespace {

using math::Vec3;
constexpr double kTick = 1e-3;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

device::DeviceSpec touch() { return {.peak_force = 3.3, .continuous_force = 0.88}; }

// Engages and completes the start ramp.
ForceLimit running(const LimitSettings& settings = {}) {
  ForceLimit limit(touch(), settings);
  std::uint32_t flags = 0;
  for (int n = 0; n < 600; ++n) (void)limit.apply(Vec3::Zero(), kTick, flags);
  return limit;
}

TEST(ForceLimit, WaitsForASmallForceAndThenRampsUp) {
  ForceLimit limit(touch(), {});
  std::uint32_t flags = 0;
  for (int n = 0; n < 100; ++n) EXPECT_EQ(limit.apply({0, 0, 2}, kTick, flags), Vec3::Zero());
  EXPECT_TRUE(flags & rt::kFlagWaiting);
  EXPECT_FALSE(limit.engaged());
  EXPECT_EQ(limit.apply({0, 0, 0.04}, kTick, flags), Vec3::Zero());
  EXPECT_TRUE(limit.engaged());
  double last = 0;
  for (int n = 0; n < 30; ++n) {
    const double now = limit.apply({0, 0, 2}, kTick, flags).z();
    EXPECT_LE(now - last, 60 * kTick + 1e-12);
    last = now;
  }
  EXPECT_NEAR(last, 30 * 60 * kTick, 1e-9);
}

TEST(ForceLimit, ShortensToTheDeviceAndTheUserWithTheDirectionKept) {
  for (const double user : {10.0, 1.5}) {
    ForceLimit limit = running({.user_force = user});
    std::uint32_t flags = 0;
    Vec3 force;
    for (int n = 0; n < 200; ++n) force = limit.apply({6, 0, 8}, kTick, flags);
    EXPECT_NEAR(force.norm(), std::min(3.3, user), 1e-12);
    EXPECT_NEAR(force.x() / force.z(), 0.75, 1e-12);
    EXPECT_TRUE(flags & rt::kFlagForceLimited);
  }
}

TEST(ForceLimit, GrowthAndTurningAreSlewBoundLettingGoIsNot) {
  ForceLimit limit = running();
  std::uint32_t flags = 0;
  Vec3 force = limit.apply({3, 0, 0}, kTick, flags);
  EXPECT_NEAR(force.norm(), 0.3, 1e-12);
  for (int n = 0; n < 20; ++n) force = limit.apply({3, 0, 0}, kTick, flags);
  EXPECT_NEAR(force.x(), 3, 1e-12);
  force = limit.apply({-3, 0, 0}, kTick, flags);
  EXPECT_NEAR(force.x(), -0.3, 1e-12)
      << "what was there is let go at once, the other way grows slowly";
  for (int n = 0; n < 20; ++n) force = limit.apply({3, 0, 0}, kTick, flags);
  force = limit.apply({1, 0, 0}, kTick, flags);
  EXPECT_NEAR(force.x(), 1, 1e-12);
}

TEST(ForceLimit, NotANumberFadesWithinFiveMillisecondsAndTheWayBackIsTheRamp) {
  for (const double rate : {1000.0, 4000.0}) {
    ForceLimit limit = running();
    std::uint32_t flags = 0;
    for (int n = 0; n < 100; ++n) (void)limit.apply({0, 0, 3}, kTick, flags);
    flags = 0;
    double last = 3;
    int ticks = 0;
    while (last > 0) {
      const Vec3 force = limit.apply({kNaN, 0, 1}, 1 / rate, flags);
      ASSERT_TRUE(force.allFinite());
      EXPECT_LE(force.norm(), last + 1e-12);
      last = force.norm();
      ASSERT_LE(++ticks, static_cast<int>(rate * 5e-3 + 1e-9));
    }
    EXPECT_TRUE(flags & rt::kFlagNotFinite);
    EXPECT_EQ(limit.apply({0, 0, 3}, 1 / rate, flags), Vec3::Zero());
    (void)limit.apply(Vec3::Zero(), 1 / rate, flags);
    EXPECT_LE(limit.apply({0, 0, 3}, 1 / rate, flags).norm(), 60 / rate + 1e-12);
  }
}

TEST(ForceLimit, DoesNotBelieveALostHandANaNOrALeap) {
  device::HandState hand;
  std::uint32_t flags = 0;
  ForceLimit limit = running();
  EXPECT_TRUE(limit.accept_reading(hand, flags));
  hand.world_from_tool.p.x() = 0.019;
  EXPECT_TRUE(limit.accept_reading(hand, flags));
  hand.world_from_tool.p.x() = 0.040;
  EXPECT_FALSE(limit.accept_reading(hand, flags));
  EXPECT_TRUE(flags & rt::kFlagJump);
  EXPECT_TRUE(limit.accept_reading(hand, flags)) << "after a fault the next reading is a beginning";
  hand.world_from_tool.p.y() = kNaN;
  EXPECT_FALSE(limit.accept_reading(hand, flags));
  // a finite position may still be invalid: farther away than voxel indices reach
  for (const double far : {1.1e3, -2e303}) {
    hand = {};
    hand.world_from_tool.p.z() = far;
    flags = 0;
    EXPECT_FALSE(limit.accept_reading(hand, flags)) << far;
    EXPECT_TRUE(flags & rt::kFlagNotFinite) << far;
  }
  hand = {};
  hand.valid = false;
  EXPECT_FALSE(limit.accept_reading(hand, flags));
  EXPECT_TRUE(flags & rt::kFlagHandLost);
}

TEST(ForceLimit, WarmMotorsGetTheContinuousForceWithoutAStep) {
  ForceLimit limit = running();
  std::uint32_t flags = 0;
  double last = limit.apply({0, 0, 3.3}, kTick, flags).norm(), biggest_drop = 0;
  for (int n = 0; n < 60'000; ++n) {
    const double now = limit.apply({0, 0, 3.3}, kTick, flags).norm();
    if (n > 20) biggest_drop = std::max(biggest_drop, last - now);
    last = now;
  }
  EXPECT_NEAR(last, 0.88, 0.1);
  EXPECT_TRUE(flags & rt::kFlagThermal);
  EXPECT_LT(biggest_drop, 0.05);
  EXPECT_LE(limit.heat(), touch().thermal_budget * 1.01);
}

TEST(ForceLimit, WhateverComesInTheHandIsSafe) {
  constexpr unsigned kSeed = 4711;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  ForceLimit limit(touch(), {});
  Vec3 last = Vec3::Zero();
  for (int n = 0; n < 200'000; ++n) {
    std::uint32_t flags = 0;
    Vec3 wanted = Vec3(any(random), any(random), any(random)) * std::pow(10, 3 * any(random));
    const int odd = static_cast<int>(random() % 1000);
    if (odd == 0) wanted.x() = kNaN;
    if (odd == 1) wanted.y() = INFINITY;
    if (odd < 300) wanted.setZero();
    device::HandState hand;
    hand.valid = odd != 2;
    hand.world_from_tool.p = Vec3::Constant(odd == 3 ? 1.0 : 0.0);
    (void)limit.accept_reading(hand, flags);
    const Vec3 force = limit.apply(wanted, kTick, flags);
    ASSERT_TRUE(force.allFinite());
    ASSERT_LE(force.norm(), 3.3 + 1e-9);
    // at most one slew step from a reduced copy of the last force
    const double square = last.squaredNorm();
    const Vec3 kept =
        square > 0 ? Vec3(std::clamp(force.dot(last) / square, 0.0, 1.0) * last) : Vec3::Zero();
    ASSERT_LE((force - kept).norm(), 300 * kTick + 1e-9);
    last = force;
  }
}

// ---- the watchdog, on a virtual clock  [ns]

TEST(Watchdog, LetsGoWithinFiveMillisecondsOfDetectionAndStaysThere) {
  Watchdog dog(5'000'000, 5'000'000);
  EXPECT_EQ(dog.poll(1'000'000'000), 1.0) << "nothing has begun yet";
  std::int64_t now = 0;
  for (; now < 50'000'000; now += 1'000'000) {
    dog.beat(now);
    EXPECT_EQ(dog.poll(now + 500'000), 1.0);
  }
  const std::int64_t last_beat = now - 1'000'000;
  EXPECT_EQ(dog.poll(last_beat + 4'900'000), 1.0);
  EXPECT_FALSE(dog.tripped());
  EXPECT_EQ(dog.poll(last_beat + 5'000'000), 1.0) << "detected: the fade begins";
  EXPECT_TRUE(dog.tripped());
  EXPECT_NEAR(dog.poll(last_beat + 7'500'000), 0.5, 1e-9);
  EXPECT_EQ(dog.poll(last_beat + 10'000'000), 0.0);
  dog.beat(last_beat + 11'000'000);
  EXPECT_EQ(dog.poll(last_beat + 11'100'000), 0.0) << "a beat alone does not bring the force back";
  dog.rearm(last_beat + 12'000'000);
  EXPECT_EQ(dog.poll(last_beat + 12'500'000), 1.0);
}

// A device with torque: 0.2 N m and 4 N, a lever of 50 mm.
TEST(TorqueLimit, IsBoundedInTheProportionOfTheForce) {
  const device::DeviceSpec spec = {.peak_force = 4, .continuous_force = 4, .peak_torque = 0.2};
  for (const double user : {10.0, 1.0}) {
    ForceLimit limit(spec, {.user_force = user});
    std::uint32_t flags = 0;
    const auto tick = [&](const Vec3& torque) {
      static_cast<void>(limit.apply(Vec3::Zero(), kTick, flags));
      return limit.apply_torque(torque, kTick, flags);
    };
    EXPECT_EQ(tick({0, 0, 1}), Vec3::Zero()) << "no torque before there is force";
    double last = 0;
    for (int n = 0; n < 500; ++n) {  // 60 N/s in the ramp
      const double now = tick({0.3, 0, 0.4}).norm();
      EXPECT_LE(now - last, 0.05 * 60 * kTick + 1e-12);
      last = now;
    }
    const Vec3 held = tick({0.3, 0, 0.4});
    EXPECT_NEAR(held.norm(), 0.05 * std::min(4.0, user), 1e-12);
    EXPECT_NEAR(held.x() / held.z(), 0.75, 1e-12);
    EXPECT_EQ(tick(Vec3::Zero()), Vec3::Zero()) << "letting go is free";
    EXPECT_NEAR(tick({0, 1, 0}).y(), 0.05 * 300 * kTick, 1e-12);
  }
}

TEST(TorqueLimit, FadesAndComesBackWithTheForce) {
  const device::DeviceSpec spec = {.peak_force = 4, .continuous_force = 4, .peak_torque = 0.2};
  for (const bool of_torque : {false, true}) {
    ForceLimit limit(spec, {.user_force = 4});
    std::uint32_t flags = 0;
    const auto tick = [&](double force, double torque) {
      static_cast<void>(limit.apply({0, 0, force}, kTick, flags));
      return limit.apply_torque({0, 0, torque}, kTick, flags).z();
    };
    for (int n = 0; n < 700; ++n) static_cast<void>(tick(n > 600 ? 2 : 0, 0.1));
    EXPECT_NEAR(tick(2, 0.1), 0.1, 1e-12);
    const double no = kNaN;
    std::vector<double> left;
    left.push_back(of_torque ? tick(2, no) : tick(no, 0.1));
    for (int n = 0; n < 6; ++n) left.push_back(tick(2, 0.1));
    EXPECT_TRUE(flags & rt::kFlagNotFinite);
    // linearly, from the tick of the fault or the one after it
    double is = of_torque ? 0.1 : 0.08;
    for (const double now : left) {
      EXPECT_NEAR(now, is, 1e-12);
      is = std::max(0.0, is - 0.02);
    }
    EXPECT_FALSE(limit.engaged());
    for (int n = 0; n < 100; ++n) EXPECT_EQ(tick(2, 0.1), 0) << "the force is not small yet";
    static_cast<void>(tick(0, 0));
    EXPECT_NEAR(tick(0, 0.1), 0.05 * 60 * kTick, 1e-12);
  }
}

// Force and torque of a contact: 0.2 N m and 4 N.
TEST(WrenchLimit, OneFactorMakesBothSmallerAndEachGrowsAtItsOwnRate) {
  const device::DeviceSpec spec = {.peak_force = 4, .continuous_force = 4, .peak_torque = 0.2};
  ForceLimit limit(spec, {.user_force = 4});
  std::uint32_t flags = 0;
  const auto tick = [&](const Vec3& force, const Vec3& torque, const Vec3& twist = Vec3::Zero()) {
    flags = 0;
    return limit.apply({force, torque}, twist, kTick, flags);
  };
  const Vec3 z = Vec3::UnitZ(), x = Vec3::UnitX();
  for (int n = 0; n < 20; ++n) {
    const Wrench none = tick(Vec3::Zero(), 0.1 * x);
    EXPECT_EQ(none.torque, Vec3::Zero().eval()) << "a couple that is already there waits as well";
  }
  static_cast<void>(tick(Vec3::Zero(), 0.03 * x, 0.03 * x));  // the motor's twist does not
  EXPECT_TRUE(limit.engaged());
  Wrench last;
  for (int n = 0; n < 600; ++n) {
    const Wrench now = tick(2 * z, 0.4 * x);
    EXPECT_LE((now.force - last.force).norm(), 300 * kTick + 1e-12);
    EXPECT_LE((now.torque - last.torque).norm(), 0.05 * 300 * kTick + 1e-12);
    last = now;
  }
  EXPECT_NEAR((last.force - 1 * z).norm(), 0, 1e-12) << "the torque is at its limit";
  EXPECT_NEAR((last.torque - 0.2 * x).norm(), 0, 1e-12);
  EXPECT_NE(flags & rt::kFlagForceLimited, 0U);
  for (int n = 0; n < 100; ++n) last = tick(8 * z, 0.1 * x);
  EXPECT_NEAR((last.force - 4 * z).norm(), 0, 1e-12);
  EXPECT_NEAR((last.torque - 0.05 * x).norm(), 0, 1e-12);
  for (int n = 0; n < 100; ++n) last = tick(2 * z, 0.1 * x);
  EXPECT_EQ(flags & rt::kFlagForceLimited, 0U);
  EXPECT_NEAR((last.torque - 0.1 * x).norm(), 0, 1e-12);
  // not a number in either: both fade
  last = tick(2 * z, Vec3(0, kNaN, 0));
  EXPECT_NEAR((last.force - 1.6 * z).norm(), 0, 1e-12);
  EXPECT_NEAR((last.torque - 0.08 * x).norm(), 0, 1e-12);
  for (int n = 0; n < 4; ++n) last = tick(2 * z, 0.1 * x);
  EXPECT_EQ(last.force, Vec3::Zero().eval());
  EXPECT_EQ(last.torque, Vec3::Zero().eval());
  EXPECT_FALSE(limit.engaged());
}

TEST(WrenchLimit, ATurnThatNoHandMakesIsAJumpWhereTheHandIsTurned) {
  for (const double torque : {0.0, 0.2}) {
    ForceLimit limit({.peak_torque = torque}, {});
    device::HandState hand;
    std::uint32_t flags = 0;
    EXPECT_TRUE(limit.accept_reading(hand, flags));
    hand.world_from_tool.q = math::Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
    EXPECT_TRUE(limit.accept_reading(hand, flags));
    hand.world_from_tool.q = math::Quat(Eigen::AngleAxisd(1.0, Vec3::UnitX()));
    EXPECT_EQ(limit.accept_reading(hand, flags), torque == 0);
    EXPECT_EQ((flags & rt::kFlagJump) != 0, torque > 0);
    EXPECT_TRUE(limit.accept_reading(hand, flags)) << "where it is now";
  }
}

TEST(TorqueLimit, WhatCannotTurnTheHandIsNotAskedTo) {
  ForceLimit limit = running();
  std::uint32_t flags = 0;
  EXPECT_EQ(limit.apply_torque({1, 2, 3}, kTick, flags), Vec3::Zero());
  EXPECT_EQ(limit.apply_torque({kNaN, 2, 3}, kTick, flags), Vec3::Zero());
  EXPECT_EQ(flags & rt::kFlagNotFinite, 0U);
}

}  // namespace
}  // namespace burr::haptics
