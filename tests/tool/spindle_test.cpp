// The spindle, compared with solutions by hand of its motor's equation: J dw/dt = torque - load - b
// w.
#include "burr/tool/spindle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace burr::tool {
namespace {

constexpr double kFull = 4000;  // [rad/s]
constexpr Motor kFree = {.torque = 0.02, .droop = 0.1, .inertia = 4e-7, .friction = 0};
constexpr double kSteep = kFree.torque / (kFull * kFree.droop);  // K  [N m s]

Spindle spindle(const Motor& motor = kFree, double full = kFull) {
  Spindle made;
  made.full_speed = full;
  made.motor = motor;
  return made;
}

void run(Spindle& one, double seconds, double pedal, double cutting, double dt = 1e-4) {
  for (int n = 0; n < std::lround(seconds / dt); ++n) one.step(pedal, cutting, dt);
}

TEST(Spindle, RunsUpWithItsWholeTorqueUntilItsSpringBegins) {
  const double until = kFree.inertia * kFull * (1 - kFree.droop) / kFree.torque;  // 72 ms
  Spindle one = spindle();
  run(one, 0.5 * until, 1, 0);
  EXPECT_NEAR(one.speed(), 0.5 * (1 - kFree.droop) * kFull, 0.01 * kFull);
  run(one, 0.5 * until, 1, 0);
  EXPECT_NEAR(one.speed(), (1 - kFree.droop) * kFull, 0.01 * kFull);
  // then the remaining difference decays with J / K
  run(one, kFree.inertia / kSteep, 1, 0);
  EXPECT_NEAR(one.speed(), kFull * (1 - kFree.droop * std::exp(-1)), 0.004 * kFull);
  run(one, 1, 1, 0);
  EXPECT_NEAR(one.speed(), kFull, 1e-6 * kFull);
}

TEST(Spindle, GivesWayInProportionToTheLoad) {
  for (const double load : {0.002, 0.01, 0.018}) {
    Spindle one = spindle();
    run(one, 2, 1, load);
    EXPECT_NEAR(one.speed(), kFull - load / kSteep, 1e-6 * kFull) << load;
    EXPECT_FALSE(one.stalled());
  }
  // with friction of the motor: K (w_set - w) = load + b w
  Motor rubbing = kFree;
  rubbing.friction = 1e-6;
  Spindle one = spindle(rubbing);
  run(one, 2, 1, 0.01);
  EXPECT_NEAR(one.speed(), (kSteep * kFull - 0.01) / (kSteep + 1e-6), 1e-6 * kFull);
}

TEST(Spindle, StallsUnderMoreThanItsTorqueAndTurnsAgainWhenLetGo) {
  Spindle one = spindle();
  run(one, 1, 1, 0);
  // slows down by load - torque from 0.9 w on: takes at most 1.2 J w / torque
  run(one, 1.2 * kFree.inertia * kFull / (0.04 - kFree.torque), 1, 0.04);
  EXPECT_EQ(one.speed(), 0);
  EXPECT_TRUE(one.stalled());
  run(one, 1, 1, 1.01 * kFree.torque);
  EXPECT_TRUE(one.stalled());
  run(one, 1, 1, 0.9 * kFree.torque);
  EXPECT_FALSE(one.stalled());
  EXPECT_NEAR(one.speed(), kFull - 0.9 * kFree.torque / kSteep, 1e-3 * kFull);
}

TEST(Spindle, TheBoneBrakesAndNeverDrives) {
  Spindle one = spindle();
  run(one, 1, 1, 0);
  for (int n = 0; n < 10000; ++n) {
    one.step(0, 0.05, 1e-4);
    ASSERT_GE(one.speed(), 0);
  }
  EXPECT_EQ(one.speed(), 0);
  EXPECT_FALSE(one.stalled()) << "nobody wants it to turn";
}

TEST(Spindle, TurnsBackwardsJustAsWell) {
  Spindle one = spindle(), back = spindle(kFree, -kFull);
  for (int n = 0; n < 5000; ++n) {
    const double load = n < 2000 ? 0.005 : 0.03;
    one.step(n < 4000 ? 1 : 0.5, load, 1e-4);
    back.step(n < 4000 ? 1 : 0.5, load, 1e-4);
    ASSERT_EQ(one.speed(), -back.speed()) << n;
    ASSERT_EQ(one.stalled(), back.stalled()) << n;
  }
}

TEST(Spindle, DoesNotDependOnTheRateOfTicks) {
  Spindle slow = spindle(), quick = spindle();
  for (int n = 0; n < 300; ++n) {
    const double load = n < 150 ? 0 : 0.012;
    slow.step(1, load, 1e-3);
    for (int k = 0; k < 10; ++k) quick.step(1, load, 1e-4);
    EXPECT_NEAR(slow.speed(), quick.speed(), 0.02 * kFull) << n;
  }
}

TEST(Spindle, WithoutAMotorGoesAsCommandedWhateverTheLoad) {
  Motor none;
  none.torque = 0;
  Spindle one = spindle(none);
  one.step(0.5, 1, 1e-3);
  EXPECT_EQ(one.speed(), 0.5 * kFull);
}

// The hand feels the bone's torque plus the rotor's: over any time the angular impulse on the
// handpiece is that of the bone plus J times the change of speed.
TEST(Spindle, TheHandpieceTwistsAgainstWhatTheBurrMeets) {
  Motor rubbing = kFree;
  rubbing.friction = 1e-6;
  for (const double full : {kFull, -kFull})
    for (const Motor& motor : {kFree, rubbing}) {
      Spindle one = spindle(motor, full);
      constexpr double kDt = 1e-5;
      const double way = full > 0 ? 1 : -1;
      double twist = 0, bone = 0, most = 0;
      const auto go = [&](double seconds, double pedal, double cutting) {
        for (int n = 0; n < std::lround(seconds / kDt); ++n) {
          one.step(pedal, cutting, kDt);
          twist += one.reaction() * kDt;
          bone += way * cutting * kDt;
          most = std::max(most, std::abs(one.reaction()));
        }
      };
      go(0.02, 1, 0);
      EXPECT_NEAR(one.reaction(), way * motor.torque, 0.1 * motor.torque) << "it starts";
      go(0.7, 1, 0);
      EXPECT_NEAR(one.reaction(), 0, 1e-3 * motor.torque) << "it idles";
      go(0.7, 1, 0.01);
      EXPECT_NEAR(one.reaction(), way * 0.01, 1e-5) << "it cuts";
      go(0.01, 0, 0.01);
      EXPECT_NEAR(twist, bone + motor.inertia * one.speed(), 0.01 * std::abs(bone));
      EXPECT_LE(most, motor.torque + motor.friction * kFull + 1e-12);
    }
  Spindle held = spindle();
  run(held, 0.1, 1, 1);
  EXPECT_TRUE(held.stalled());
  EXPECT_NEAR(held.reaction(), kFree.torque, 1e-15)
      << "the bone holds the burr, the hand the drill";
  Spindle none = spindle({.torque = 0}, -kFull);
  none.step(1, 0.01, 1e-3);
  EXPECT_EQ(none.reaction(), -0.01);
}

}  // namespace
}  // namespace burr::tool
