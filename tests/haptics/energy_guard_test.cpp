// The energy guard on made-up ticks: accounts that can be computed by hand, and a hand that moves
// at random.
#include "burr/haptics/safety/energy_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include "burr/haptics/contact.h"
#include "burr/haptics/safety/limit.h"
#include "support/rt_guard.h"

namespace burr::haptics {
namespace {

using math::Vec3;
constexpr double kTick = 1e-3;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A wall below z = 0.
SpringState wall(double z, double stiffness = 1000) {
  SpringState now;
  now.hand = Vec3(0, 0, z);
  now.stretch = Vec3(0, 0, std::max(0.0, -z));
  now.stiffness = stiffness;
  now.force = stiffness * now.stretch;
  return now;
}

// As in the servo, with nothing after the guard.
Vec3 tick(EnergyGuard& guard, const SpringState& now) {
  const Vec3 force = guard.step(now, kTick);
  guard.sent(force);
  return force;
}

TEST(EnergyGuard, CountsTheWorkOfTheForceThatWasReallySent) {
  EnergyGuard guard;
  (void)guard.step(wall(0), kTick);
  guard.sent({1, 2, 3});
  SpringState now = wall(0);
  now.hand = Vec3(1e-4, -2e-4, 1e-4);
  (void)guard.step(now, kTick);
  EXPECT_NEAR(guard.work_in(), -(1 * 1e-4 - 2 * 2e-4 + 3 * 1e-4), 1e-18);
}

TEST(EnergyGuard, ASampledSpringOwesHalfKTimesTheSquareOfTheStep) {
  EnergyGuard guard;
  (void)tick(guard, wall(0));
  for (int n = 1; n <= 20; ++n) {
    const double before = guard.deficit();
    (void)guard.step(wall(-n * 1e-6), kTick);  // 1 mm/s: too slow for damping
    guard.sent(wall(-n * 1e-6).force);
    EXPECT_NEAR(guard.deficit() - before, 0.5 * 1000 * 1e-12, 1e-18);
    EXPECT_EQ(guard.damping(), 0);
  }
}

TEST(EnergyGuard, TheDamperOfKTOverTwoPaysItAndIsNotCountedTwice) {
  EnergyGuard guard;
  (void)tick(guard, wall(0));
  const double step = 5e-5;  // 50 mm/s
  for (int n = 1; n <= 20; ++n) {
    const SpringState now = wall(-n * step);
    const Vec3 force = tick(guard, now);
    EXPECT_NEAR(guard.deficit(), 0.5 * 1000 * step * step, 1e-15) << "of the last tick only";
    EXPECT_NEAR(guard.damping(), 1000 * kTick / 2, 1e-9);
    EXPECT_NEAR(force.z() - now.force.z(), guard.damping() * step / kTick, 1e-12);
  }
}

TEST(EnergyGuard, DampsNoMoreThanTheDeviceBears) {
  // half of m / T; less with delay; less if one encoder step would be felt
  const auto damping_of = [](const EnergyGuardSettings& settings) {
    EnergyGuard guard(settings);
    (void)guard.step(wall(0), kTick);
    guard.sent({0, 0, -3});  // a force that pulls, whatever the spring does
    SpringState now = wall(-3e-3, 100);
    (void)guard.step(now, kTick);
    guard.sent({0, 0, -3});
    now.hand.z() -= 3e-6;
    (void)guard.step(now, kTick);
    return guard.damping();
  };
  EXPECT_NEAR(damping_of({.device_mass = 0.045}), 22.5, 1e-9);
  EXPECT_NEAR(damping_of({.device_mass = 0.090}), 45, 1e-9);
  EXPECT_NEAR(damping_of({.device_mass = 0.045, .delay = 1e-3}), 11.25, 1e-9);
  EXPECT_NEAR(damping_of({.device_mass = 0.045, .encoder_step = 50e-6, .count_force = 0.1}), 2,
              1e-9);
  EXPECT_EQ(damping_of({.least_speed = 4e-3}), 0) << "3 mm/s is below";
  EXPECT_GT(damping_of({.least_speed = 2e-3}), 0) << "3 mm/s is above";
}

// A minute of rubbing with 0.5 N puts 1.5 J on the account of a plain observer: it would let the
// world give all of it back before it acts.
TEST(EnergyGuard, CreditOfALongContactHidesNothing) {
  EnergyGuard guard;
  double plain = 0;
  Vec3 last = Vec3::Zero(), held = Vec3::Zero();
  const auto go = [&](const SpringState& now) {
    plain -= held.dot(now.hand - last);
    held = tick(guard, now);
    last = now.hand;
    return held;
  };
  SpringState now = wall(-1e-3);
  for (int n = 0; n < 60'000; ++n) {
    const double speed = 50e-3 * ((n / 200) % 2 == 0 ? 1 : -1);  // back and forth
    now.hand.x() += speed * kTick;
    now.force = Vec3(-std::copysign(0.5, speed), 0, 1);
    (void)go(now);
  }
  EXPECT_GT(plain, 1.0);
  // now the friction force reverses and drives the hand
  double pushed_out = 0;
  int ticks = 0;
  while (guard.damping() == 0) {
    now.hand.x() += 50e-3 * kTick;
    now.force = Vec3(0.5, 0, 1);
    pushed_out += 0.5 * 50e-3 * kTick;
    (void)go(now);
    ASSERT_LT(++ticks, 10) << "it should have been seen at once";
  }
  EXPECT_LE(pushed_out, 100e-6);
  EXPECT_GT(plain, 1.0) << "the plain form would still wait";
}

TEST(EnergyGuard, APushDeeperThanTheLargestForceIsNoDeficit) {
  EnergyGuard guard({.largest_force = 2});
  (void)tick(guard, wall(0));
  double worst = 0;
  for (int n = 1; n <= 3000; ++n) {
    SpringState now = wall(-n * 2e-6);
    if (now.force.z() > 2) now.force.z() = 2;
    (void)tick(guard, now);
    worst = std::max(worst, guard.deficit());
  }
  EXPECT_LT(worst, 1e-7) << "as a plain spring 9 mJ more would be owed";
  EXPECT_NEAR(guard.stored(), 2 * (6e-3 - 1e-3), 1e-9);
}

TEST(EnergyGuard, KnownDampingOfTheDevicePaysAndAPassiveWallIsLeftAlone) {
  for (const double share : {0.95, 1.05}) {
    EnergyGuard guard({.device_damping = 0.5});
    (void)tick(guard, wall(0));
    double most = 0;
    for (int n = 1; n <= 1000; ++n) {
      (void)tick(guard, wall(-1e-3 * std::sin(2 * std::numbers::pi * 20 * n * kTick),
                             share * 2 * 0.5 / kTick));
      most = std::max(most, guard.damping());
    }
    if (share < 1) {
      EXPECT_LT(most, 1e-9);
    } else {
      EXPECT_GT(most, 1e-3);
    }
  }
}

TEST(EnergyGuard, ForgetsADeficitOnlyAfterFiftyMillisecondsInFreeAir) {
  EnergyGuard guard;
  (void)guard.step(wall(0), kTick);
  guard.sent({0, 0, 1});
  (void)tick(guard, wall(1e-4));  // pushed out with 0.1 mJ that was never received
  const double owed = guard.deficit();
  EXPECT_NEAR(owed, 1e-4, 1e-9);
  for (int n = 2; n < 48; ++n) (void)tick(guard, wall(1e-4));
  EXPECT_NEAR(guard.deficit(), owed, 1e-12);
  for (int n = 48; n <= 52; ++n) (void)tick(guard, wall(1e-4));
  EXPECT_EQ(guard.deficit(), 0);
  EXPECT_NEAR(guard.written_off(), owed, 1e-12);
}

TEST(EnergyGuard, ARestartWritesOffWhatIsOwedAndWhatTheNextContactBeginsWith) {
  EnergyGuard guard = EnergyGuard();
  (void)guard.step(wall(0), kTick);
  guard.sent({0, 0, 1});
  (void)tick(guard, wall(1e-4));
  guard.restart();
  EXPECT_NEAR(guard.written_off(), 1e-4, 1e-12);
  EXPECT_EQ(guard.deficit(), 0);
  (void)tick(guard, wall(-1e-3));  // 0.5 mJ that was never received; written off
  EXPECT_EQ(guard.deficit(), 0);
  EXPECT_NEAR(guard.written_off(), 6e-4, 1e-12);
}

TEST(EnergyGuard, ADeficitIsRememberedUpToATankful) {
  EnergyGuard guard({.tank_full = 2e-3});
  (void)guard.step(wall(0), kTick);
  guard.sent({0, 0, 3});
  (void)tick(guard, wall(4e-3));  // 12 mJ
  EXPECT_NEAR(guard.deficit(), 2e-3, 1e-9);
  EXPECT_NEAR(guard.written_off(), 10e-3, 1e-9);
}

// ---- the tank

// Loses `energy` by friction.
EnergyGuard filled(double energy, const EnergyGuardSettings& settings = {}) {
  EnergyGuard guard(settings);
  SpringState now;
  (void)guard.step(now, kTick);
  for (int n = 0; n < 10; ++n) {
    guard.sent({-1, 0, 0});
    now.hand.x() += energy / 10;
    (void)guard.step(now, kTick);
  }
  guard.sent(Vec3::Zero());
  return guard;
}

TEST(EnergyTank, HoldsWhatWasLostUpToItsSize) {
  EXPECT_NEAR(filled(1e-3).tank(), 1e-3, 1e-12);
  EXPECT_NEAR(filled(1e-1).tank(), 2e-3, 1e-12);
  EXPECT_NEAR(filled(1e-1, {.tank_full = 5e-3}).tank(), 5e-3, 1e-12);
  EXPECT_NEAR(filled(1e-1, {.tank_full = 1}).tank(), 10e-3, 1e-12) << "never more than 10 mJ";
  EXPECT_EQ(EnergyGuard().tank(), 0);
}

TEST(EnergyTank, GivesAllAboveLowAndLessAndLessBelow) {
  EnergyGuard guard = filled(1e-3);
  EXPECT_NEAR(guard.allow(1e-4), 1e-4, 1e-15);
  EXPECT_NEAR(guard.tank(), 0.9e-3, 1e-12);
  guard = filled(0.25e-3);
  EXPECT_NEAR(guard.allow(1e-5), 0.5e-5, 1e-15);
  guard = EnergyGuard();
  EXPECT_EQ(guard.allow(1e-9), 0);
  guard = filled(1e-3);
  double given = 0;
  for (int n = 0; n < 100'000; ++n) given += guard.allow(1e-5);
  EXPECT_LE(given, 1e-3 + 1e-15);
  EXPECT_GE(guard.tank(), 0);
}

TEST(EnergyTank, NoOddRequestEmptiesIt) {
  EnergyGuard guard = filled(1e-3);
  for (const double odd : {kNaN, -1.0, kInfinity, -kInfinity, 0.0}) EXPECT_EQ(guard.allow(odd), 0);
  EXPECT_NEAR(guard.tank(), 1e-3, 1e-12);
  EXPECT_NEAR(guard.allow(1e9), 1e-3, 1e-12) << "no more than there is";
}

TEST(EnergyTank, GrowthThatWasPaidForIsNotDampedAndOtherGrowthIs) {
  for (const bool paid : {true, false}) {
    EnergyGuard guard = filled(1e-3);
    SpringState now = wall(0);
    now.hand.x() = 1e-3;
    (void)tick(guard, now);
    // the surface rises by 1 um under a hand that slides with 10 mm/s
    double most = 0, height = 1e-6;
    for (int n = 0; n < 50; ++n, height += 1e-6) {
      if (paid)
        (void)guard.allow(0.5 * 1000 * (height * height - (height - 1e-6) * (height - 1e-6)));
      now.hand.x() += 1e-5;
      now.stretch.z() = height;
      now.force = 1000 * now.stretch;
      (void)tick(guard, now);
      most = std::max(most, guard.damping());
    }
    if (paid) {
      EXPECT_LT(most, 1e-9);
      EXPECT_NEAR(guard.tank(), 1e-3 - 0.5 * 1000 * 50e-6 * 50e-6, 1e-9);
    } else {
      EXPECT_GT(most, 0.01);
    }
  }
}

TEST(EnergyTank, WhatWasAllowedAndNotUsedFlowsBack) {
  EnergyGuard guard = filled(1e-3);
  EXPECT_NEAR(guard.allow(0.4e-3), 0.4e-3, 1e-12);
  EXPECT_NEAR(guard.tank(), 0.6e-3, 1e-12);
  SpringState now;
  now.hand.x() = 1e-3;
  for (int n = 0; n < 1000; ++n) (void)tick(guard, now);
  EXPECT_NEAR(guard.tank(), 1e-3, 1e-9);
}

// ---- trouble

TEST(EnergyGuard, WhatIsNotANumberGoesThroughAndTheAccountBeginsAnew) {
  for (const double odd : {kNaN, kInfinity}) {
    for (int which = 0; which < 5; ++which) {
      EnergyGuard guard = filled(1e-3);
      SpringState now = wall(-1e-3);
      now.hand.x() = 1e-3;
      (void)tick(guard, now);
      double dt = kTick;
      if (which == 0) now.hand.y() = odd;
      if (which == 1) now.stretch.y() = odd;
      if (which == 2) now.stiffness = odd;
      if (which == 3) now.force.y() = odd;
      if (which == 4) dt = odd;
      const Vec3 force = guard.step(now, dt);
      EXPECT_EQ(std::memcmp(force.data(), now.force.data(), sizeof(double) * 3), 0) << which;
      guard.sent({odd, odd, odd});
      for (int n = 0; n < 10; ++n) {
        const SpringState next = wall(-1e-3 - 1e-5 * n);
        EXPECT_TRUE(tick(guard, next).allFinite());
      }
      for (const double value : {guard.energy(), guard.stored(), guard.tank(), guard.work_in(),
                                 guard.written_off(), guard.damping(), guard.lost_in_device()})
        EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(guard.tank(), 1e-3 - 1e-9);
    }
  }
  EnergyGuard guard({.device_mass = kNaN, .delay = kNaN, .tank_full = kNaN});
  for (int n = 0; n < 10; ++n) EXPECT_TRUE(tick(guard, wall(-1e-4 * n)).allFinite());
}

// The guarantee of the header, with an account kept by the test: a hand that moves at random, a
// spring that jumps, growth that is allowed or not, limits after the guard, and a device whose
// force comes late.
TEST(EnergyGuard, WhateverHappensNoMoreComesOutThanIsOnTheAccount) {
  for (const double delay : {0.0, 0.4e-3, 2.3e-3}) {
    constexpr unsigned kSeed = 20'05;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << " delay " << delay);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> any(-1, 1);
    EnergyGuard guard({.device_damping = 0.2, .delay = delay});
    ForceLimit limit({}, {});
    std::array<Vec3, 4> forces;  // newest first
    forces.fill(Vec3::Zero());
    const double ticks = delay / kTick;
    const auto whole = static_cast<std::size_t>(ticks);
    const double rest = ticks - static_cast<double>(whole);
    double work_in = 0, allowed = 0, lost = 0;
    Vec3 hand = Vec3::Zero(), speed = Vec3::Zero(), last = Vec3::Zero(), proxy = Vec3::Zero();
    for (int n = 0; n < 300'000; ++n) {
      speed += 0.02 * Vec3(any(random), any(random), any(random)) - 0.02 * speed - 0.1 * hand;
      hand += speed * kTick;
      if (n % 1000 == 0) proxy = hand + 2e-3 * Vec3(any(random), any(random), any(random));
      const bool touching = (n / 1500) % 3 != 0;
      SpringState now;
      now.hand = hand;
      now.stiffness = touching ? 500 + 400 * any(random) * (n % 7 == 0) : 0;
      now.stretch = touching ? Vec3(proxy - hand) : Vec3(Vec3::Zero());
      now.force = now.stiffness * now.stretch;
      if (n > 0)
        work_in -= ((1 - rest) * forces[whole] + rest * forces[whole + 1]).dot(hand - last);
      last = hand;

      const Vec3 force = guard.step(now, kTick);
      std::uint32_t flags = 0;
      const Vec3 hum = 0.1 * Vec3(any(random), any(random), any(random));
      const Vec3 sent = limit.apply(force + hum, kTick, flags) - hum;
      guard.sent(sent);
      std::rotate(forces.rbegin(), forces.rbegin() + 1, forces.rend());
      forces[0] = sent;
      if (n % 3 == 0) allowed += guard.allow(1e-5 * std::abs(any(random)));
      lost = guard.lost_in_device();

      ASSERT_NEAR(guard.work_in(), work_in, 1e-9);
      ASSERT_GE(work_in, -guard.deficit() - guard.written_off() - lost - 1e-9) << "tick " << n;
      ASSERT_GE(guard.deficit(), 0);
      ASSERT_GE(guard.tank(), 0);
      ASSERT_LE(guard.tank(), 2e-3 + 1e-15);
      ASSERT_LE(guard.damping(), 22.5 + 1e-12);
    }
    EXPECT_GT(allowed, 1e-3) << "else nothing was tried";
  }
}

// The same without restarts, changes of stiffness or free air to write off: the energy that comes
// out without having been received is bounded by the deficit alone, and allowed growth cannot be
// used to draw more.
TEST(EnergyGuard, AllowedGrowthComesFromWhatWasLostBefore) {
  EnergyGuard guard = filled(1e-3);
  // requests more than there is in each tick, and pushes the hand with it
  SpringState now;
  now.hand.x() = 1e-3;
  double given = 0;
  for (int n = 0; n < 20'000; ++n) {
    given += guard.allow(1e-6);
    now.hand.x() += 2e-6;
    now.force.x() = 0.5;
    (void)tick(guard, now);
  }
  EXPECT_LT(given, 1.05e-3);
}

TEST(EnergyGuard, TakesNoMemoryAndNoLockAndSaysTheSameBitsTwice) {
  EnergyGuard one, two;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<SpringState> ticks(5000);
  double z = 0;
  for (SpringState& now : ticks) now = wall(z += 1e-4 * any(random));
  std::vector<Vec3> first(ticks.size());
  {
    const test::RtGuard guard;
    for (std::size_t n = 0; n < ticks.size(); ++n) {
      first[n] = tick(one, ticks[n]);
      (void)one.allow(1e-7);
    }
    EXPECT_EQ(guard.allocations(), 0);
    EXPECT_EQ(guard.locks(), 0);
  }
  for (std::size_t n = 0; n < ticks.size(); ++n) {
    const Vec3 again = tick(two, ticks[n]);
    (void)two.allow(1e-7);
    ASSERT_EQ(std::memcmp(again.data(), first[n].data(), sizeof(double) * 3), 0);
  }
}

}  // namespace
}  // namespace burr::haptics
