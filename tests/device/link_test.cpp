// The link between a wire and the tick, mostly with a clock that the test advances.
#include "burr/device/link.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "burr/device/wire.h"
#include "support/rt_guard.h"

namespace burr::device {
namespace {

using math::Vec3;

std::atomic<std::int64_t> virtual_ns;
std::int64_t virtual_now() { return virtual_ns; }
// as above, but every look at the clock takes a tenth of a millisecond
std::int64_t passing_now() { return virtual_ns += 100'000; }

void at(double ms) { virtual_ns = std::llround(1e6 * ms); }

HandState hand_at(double x) {
  HandState hand;
  hand.world_from_tool.p = {x, 0, 0};
  return hand;
}

// A link on which nobody waits: the test gives readings and answers.
struct Still {
  Link link{{.answer_timeout = 0}, &virtual_now};
  Still() { at(1000); }
  double x = 0;

  double exchange(double ms) {
    at(ms);
    return link.exchange(hand_at(x += 1e-3)).z();
  }
  double push(double ms) {
    at(ms);
    return link.push().z();
  }
  // a tick: the state of the hand, and its answer
  bool tick(double newton) {
    const bool valid = link.state().valid;
    link.write_force({0, 0, newton});
    return valid;
  }
};

TEST(Link, TheForceOfAReadingGoesOutWithItHoweverLongTheTickTakes) {
  Link link({.answer_timeout = 10, .loss_timeout = 100});
  constexpr int kReadings = 3000;
  std::atomic<bool> done = false;
  std::thread servo([&] {
    while (!done) {
      if (!link.wait(rt::monotonic_ns() + 1'000'000)) continue;
      const HandState hand = link.state();
      link.write_force({hand.world_from_tool.p.x(), 0, 0});
    }
  });
  while (link.exchange(hand_at(-1)).x() != -1) {  // until the servo answers
  }
  int wrong = 0;
  for (int n = 1; n <= kReadings; ++n) wrong += link.exchange(hand_at(n)).x() != n;
  done = true;
  servo.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Link, AForceWithoutAnswersStandsForAWhileAndThenFadesOnce) {
  Still still;
  EXPECT_EQ(still.exchange(1000), 0);
  EXPECT_TRUE(still.tick(2));
  EXPECT_EQ(still.exchange(1001), 2);
  EXPECT_EQ(still.exchange(1005.9), 2);  // taken at 1001
  EXPECT_EQ(still.exchange(1006), 2);    // loss detected
  EXPECT_NEAR(still.exchange(1007), 1.6, 1e-12);
  EXPECT_NEAR(still.push(1008.5), 1.0, 1e-12);
  EXPECT_NEAR(still.exchange(1010.75), 0.1, 1e-12);
  EXPECT_EQ(still.exchange(1011), 0);
  EXPECT_EQ(still.exchange(1100), 0);
}

TEST(Link, ForceComesBackOnlyAfterTheTickItselfWasAtZero) {
  Still still;
  still.exchange(1000);
  still.tick(2);
  still.exchange(1001);
  still.exchange(1010);
  still.exchange(1020);         // it has released the force
  EXPECT_FALSE(still.tick(2));  // the tick sees the loss, and comes down at its own pace
  EXPECT_EQ(still.exchange(1021), 0);
  EXPECT_TRUE(still.tick(1.5));
  EXPECT_EQ(still.exchange(1022), 0);
  still.tick(0);
  EXPECT_EQ(still.exchange(1023), 0);
  still.tick(0.06);
  EXPECT_NEAR(still.exchange(1024), 0.06, 1e-15);
}

// A zero that was written before the loss was known does not show that the servo knows it.
TEST(Link, AZeroFromBeforeTheLossDoesNotCount) {
  Still still;
  still.exchange(1000);
  still.tick(2);
  still.exchange(1001);
  still.link.mark_lost();
  still.tick(0);  // it has seen the loss: the reading was invalid
  still.exchange(1002);
  EXPECT_EQ(still.push(1002.5), 0);
  still.link.mark_lost();
  EXPECT_EQ(still.push(1003), 0);
  still.link.write_force({0, 0, 0});  // for the previous reading
  EXPECT_EQ(still.push(1003.1), 0);
  still.link.write_force({0, 0, 3});
  EXPECT_EQ(still.push(1003.2), 0) << "the tick has not seen the second loss yet";
}

TEST(Link, AHandThatSaysNothingIsLostAfterTheTimeout) {
  Still still;
  EXPECT_FALSE(still.link.state().valid) << "there was no reading yet";
  still.exchange(1000);
  EXPECT_TRUE(still.tick(0));
  at(1004.9);
  EXPECT_TRUE(still.tick(0));
  at(1005);
  EXPECT_FALSE(still.tick(0));
}

TEST(Link, ALostDeviceIsPushedNoMoreAndTheTickLearnsIt) {
  Still still;
  still.exchange(1000);
  still.tick(3);
  EXPECT_EQ(still.push(1001), 3);
  still.link.mark_lost();
  EXPECT_EQ(still.push(1001), 0);
  EXPECT_FALSE(still.tick(3));
  EXPECT_EQ(still.push(1001.1), 0);
}

TEST(Link, ALossIsLearntEvenIfTheNextReadingIsGood) {
  Still still;
  still.exchange(1000);
  still.tick(3);
  still.link.mark_lost();
  still.exchange(1001);
  EXPECT_FALSE(still.tick(3)) << "once, so that the tick comes down to zero";
  still.exchange(1002);
  EXPECT_TRUE(still.tick(0));
}

// On a busy computer the tick may sleep from one late reading to the next, and see none that is too old.
TEST(Link, ReadingsThatComeTooSeldomAreALossThoughEachIsAnsweredAtOnce) {
  Still still;
  still.exchange(1000);
  EXPECT_TRUE(still.tick(0));
  int valid = 0;
  for (int n = 1; n <= 20; ++n) {
    EXPECT_EQ(still.exchange(1000 + 10.0 * n), 0) << n;
    const bool seen = still.tick(0.01 * n);  // a ramp, by a tick that believed every reading
    valid += seen;
  }
  EXPECT_EQ(valid, 0);
  still.exchange(1201);
  EXPECT_TRUE(still.tick(0));
  still.exchange(1202);
  still.tick(2);
  EXPECT_EQ(still.exchange(1203), 2) << "at the usual pace all is well again";
}

TEST(Link, WhatTheGuardHoldsBackIsHeldBackUntilTheNextForce) {
  Still still;
  still.exchange(1000);
  still.tick(2);
  still.link.scale_force(0.25);
  EXPECT_NEAR(still.push(1001), 0.5, 1e-12);
  still.tick(2);
  EXPECT_NEAR(still.push(1002), 2, 1e-12);
}

TEST(Link, AReadingBeforeItsTickIsPassedOver) {
  Still still;
  still.exchange(1000);
  still.tick(1);
  still.link.begin_at(std::llround(1000.9e6));
  still.exchange(1000.5);
  at(1000.6);
  EXPECT_EQ(still.link.state().world_from_tool.p.x(), 1e-3);
  still.exchange(1001);
  EXPECT_EQ(still.link.state().world_from_tool.p.x(), 3e-3);
}

// A second device beside the one whose readings begin the ticks.
TEST(Link, WhereTicksGoByAnothersPaceNothingWaitsForThem) {
  Link link({.answer_timeout = 20, .loss_timeout = 100});
  link.never_wait();
  static_cast<void>(link.exchange(hand_at(0)));
  static_cast<void>(link.state());
  link.write_force({0, 0, 1});
  const std::int64_t began = rt::monotonic_ns();
  for (int n = 0; n < 3; ++n) EXPECT_EQ(link.exchange(hand_at(n)), Vec3(0, 0, 1)) << "the last one";
  EXPECT_LT(rt::monotonic_ns() - began, std::int64_t{5'000'000'000});
}

TEST(Link, TakesNoMemoryAndNoLock) {
  Link link({.answer_timeout = 1e-4});
  const test::RtGuard guard;
  for (int n = 0; n < 100; ++n) {
    static_cast<void>(link.exchange(hand_at(n)));
    static_cast<void>(link.wait(rt::monotonic_ns()));
    static_cast<void>(link.state());
    link.write_force({0, 0, 1});
    link.scale_force(0.5);
    static_cast<void>(link.push());
  }
  link.mark_lost();
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

// ---- the pace

TEST(LinkClock, BeginsWithTheReadingAndCountsWhatDidNotCome) {
  Link link({.answer_timeout = 0}, &virtual_now);
  LinkClock clock(link, 1000);
  const double comes[] = {1000, 1001, 1002.2, 1006, 1007};
  const std::int64_t missed[] = {0, 0, 0, 3, 0};
  const double after[] = {0, 0.1, 0, 0.3, 0};  // delay of its reading
  for (int n = 0; n < 5; ++n) {
    at(comes[n]);
    static_cast<void>(link.exchange(hand_at(n)));
    virtual_ns += std::llround(1e6 * after[n]);
    const rt::TickTime time = clock.wait();
    EXPECT_EQ(time.missed, missed[n]) << n;
    EXPECT_NEAR(1e-6 * static_cast<double>(time.late_ns), after[n], 1e-9) << n;
    EXPECT_TRUE(link.state().valid);
  }
}

// More readings than ticks: a second of ticks is a second, and ticks are as even as the readings
// allow. One reading a tick, a little too fast: all are taken.
TEST(LinkClock, ADeviceThatIsFasterThanTheTickGivesItWhatItCanUse) {
  for (const double rate : {8000.0, 4300.0, 4000.0, 2000.0, 1500.0, 1200.0, 1050.0, 1000.0}) {
    Link link({.answer_timeout = 0}, &virtual_now);
    LinkClock clock(link, 1000);
    int ticks = 0;
    constexpr int kReadings = 20'000, kKnown = 2000;
    double last = -1;
    for (int n = 0; n < kReadings; ++n) {
      at(1000 + 1e3 * n / rate);
      static_cast<void>(link.exchange(hand_at(n)));
      if (!link.wait(virtual_now())) continue;
      static_cast<void>(clock.wait());
      const double x = link.state().world_from_tool.p.x();
      if (n < kKnown) continue;
      if (last >= 0) {
        EXPECT_GE(x - last, std::floor(rate / 1000)) << rate;
        EXPECT_LE(x - last, std::ceil(rate / 1000)) << rate;
      }
      last = x;
      ++ticks;
    }
    const double seconds = (kReadings - kKnown) / rate;
    EXPECT_NEAR(ticks, seconds * (rate < 1100 ? rate : 1000), 2) << rate;
  }
}

// A stall is not made up for by faster ticks.
TEST(LinkClock, AfterAStallItIsNoFaster) {
  Link link({.answer_timeout = 0}, &virtual_now);
  LinkClock clock(link, 1000);
  int ticks = 0;
  for (int n = 0; n < 8000; ++n) {
    at(1000 + 0.25 * n + (n > 4000 ? 30 : 0));
    static_cast<void>(link.exchange(hand_at(n)));
    if (!link.wait(virtual_now())) continue;
    static_cast<void>(clock.wait());
    static_cast<void>(link.state());
    ticks += n > 4001 && n <= 4400 ? 1 : 0;
  }
  EXPECT_NEAR(ticks, 100, 2);
}

// One reading a tick, 0.6 ms or 1.4 ms after the previous one: each begins a tick.
TEST(LinkClock, ReadingsThatComeUnevenlyEachBeginATickOnceTheirPaceIsKnown) {
  Link link({.answer_timeout = 0}, &virtual_now);
  LinkClock clock(link, 1000);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uneven(-0.2, 0.2);
  int left_out = 0;
  for (int n = 0; n < 3000; ++n) {
    at(1000 + n + uneven(random));
    static_cast<void>(link.exchange(hand_at(n)));
    if (!link.wait(virtual_now())) {
      left_out += n >= 300 ? 1 : 0;
      continue;
    }
    const rt::TickTime time = clock.wait();
    if (n >= 301) {
      EXPECT_EQ(time.missed, 0) << n;
    }
    static_cast<void>(link.state());
  }
  EXPECT_EQ(left_out, 0);
  EXPECT_NEAR(1e-6 * static_cast<double>(link.reading_period_ns()), 1, 0.1);
}

TEST(LinkClock, GoesOnWithoutReadingsSoThatForceCanFade) {
  Link link({.answer_timeout = 0}, &passing_now);
  LinkClock clock(link, 1000);
  at(1000);
  static_cast<void>(link.exchange(hand_at(1)));
  static_cast<void>(clock.wait());
  EXPECT_TRUE(link.state().valid);
  const rt::TickTime first = clock.wait();  // waits for the timeout
  EXPECT_NEAR(1e-6 * static_cast<double>(first.since_last_ns), 5, 0.5);
  EXPECT_EQ(first.missed, 4);
  EXPECT_FALSE(link.state().valid);
  for (int n = 0; n < 10; ++n) {
    const rt::TickTime time = clock.wait();
    EXPECT_NEAR(1e-6 * static_cast<double>(time.since_last_ns), 1, 0.35);
    EXPECT_EQ(time.missed, 0);
  }
}

// ---- the last limit of a wire

TEST(Bounded, AMillionForcesOfAnySizeKeepTheirDirectionOrAreNone) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  constexpr double kPeak = 3.3, kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinite = std::numeric_limits<double>::infinity();
  const test::RtGuard guard;
  for (int n = 0; n < 1'000'000; ++n) {
    const double scale = std::pow(10, 300 * any(random) * std::abs(any(random)));
    Vec3 force = scale * Vec3(any(random), any(random), any(random));
    if (n % 100 == 7) force[n % 3] = kNan;
    if (n % 100 == 8) force[n % 3] = kInfinite;
    const Vec3 sent = bounded(force, kPeak);
    ASSERT_TRUE(sent.allFinite() && sent.norm() <= kPeak * (1 + 1e-12)) << "seed " << seed;
    if (!force.allFinite()) {
      ASSERT_EQ(sent, Vec3::Zero());
    } else if (force.norm() <= kPeak) {
      ASSERT_EQ(sent, force);
    } else if (std::isfinite(force.squaredNorm())) {
      ASSERT_NEAR(sent.norm(), kPeak, 1e-9) << "seed " << seed;
      ASSERT_LT(sent.cross(force.normalized()).norm(), 1e-9) << "seed " << seed;
    }
  }
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(Link, ATorqueGoesWithItsForceAndFadesWithIt) {
  Still still;
  const auto twist = [&] { return still.link.torque().x(); };
  const auto tick = [&](double newton, double newton_metre) {
    static_cast<void>(still.link.state());
    still.link.write_torque({newton_metre, 0, 0});
    still.link.write_force({0, 0, newton});
  };
  EXPECT_EQ(still.exchange(1000), 0);
  EXPECT_EQ(twist(), 0);
  tick(2, 0.1);
  EXPECT_EQ(still.exchange(1001), 2);
  EXPECT_EQ(twist(), 0.1);
  still.link.scale_force(0.5);
  EXPECT_EQ(still.exchange(1001.5), 1);
  EXPECT_EQ(twist(), 0.05);
  still.link.scale_force(1);
  EXPECT_EQ(still.exchange(1002), 2);
  still.exchange(1006);  // nobody has answered for five milliseconds
  EXPECT_EQ(still.exchange(1008), 1.2);
  EXPECT_NEAR(twist(), 0.06, 1e-12);
  EXPECT_EQ(still.exchange(1011), 0);
  EXPECT_EQ(twist(), 0);
  tick(0, 0.1);  // a torque alone does not mean that the force was released
  EXPECT_EQ(still.exchange(1012), 0);
  EXPECT_EQ(twist(), 0);
  tick(0, 0);
  still.exchange(1013);
  tick(0, 0.1);
  still.exchange(1014);
  EXPECT_EQ(twist(), 0.1);
  still.tick(1);  // writes no torque
  EXPECT_EQ(still.exchange(1015), 1);
  EXPECT_EQ(twist(), 0);
  tick(0, 0.1);
  still.exchange(1016);
  still.exchange(1021);  // a torque without force fades as well
  still.exchange(1023.5);
  EXPECT_NEAR(twist(), 0.05, 1e-12);
  still.link.mark_lost();
  EXPECT_EQ(twist(), 0);
}

}  // namespace
}  // namespace burr::device
