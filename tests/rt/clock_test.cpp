#include "burr/rt/clock.h"

#include <gtest/gtest.h>

#include "burr/rt/stats.h"
#include "support/rt_guard.h"

namespace burr::rt {
namespace {

TEST(Clock, PeriodsOfTheRatesWeAllow) {
  EXPECT_EQ(period_from_rate(500), 2'000'000);
  EXPECT_EQ(period_from_rate(1000), 1'000'000);
  EXPECT_EQ(period_from_rate(3000), 333'333);
  EXPECT_EQ(period_from_rate(10'000), 100'000);
}

TEST(NoWaitClock, EveryTickIsExactlyInTime) {
  NoWaitClock clock(4000);
  for (std::int64_t tick = 0; tick < 1000; ++tick) {
    const TickTime time = clock.wait();
    EXPECT_EQ(time.now_ns, tick * 250'000);
    EXPECT_EQ(time.late_ns, 0);
    EXPECT_EQ(time.missed, 0);
    EXPECT_EQ(time.since_last_ns, 250'000);
  }
}

TEST(VirtualClock, WorkShorterThanAPeriodLeavesTheNextTickInTime) {
  VirtualClock clock(1000);
  (void)clock.wait();
  clock.pass(999'999);
  const TickTime time = clock.wait();
  EXPECT_EQ(time.late_ns, 0);
  EXPECT_EQ(time.now_ns, 1'000'000);
  EXPECT_EQ(time.since_last_ns, 1'000'000);
}

TEST(VirtualClock, ALongTickMakesTheNextOneLateAndTheGridStays) {
  VirtualClock clock(1000);
  (void)clock.wait();
  clock.pass(1'400'000);
  const TickTime late = clock.wait();
  EXPECT_EQ(late.late_ns, 400'000);
  EXPECT_EQ(late.missed, 0);
  EXPECT_EQ(late.since_last_ns, 1'400'000);
  const TickTime next = clock.wait();
  EXPECT_EQ(next.now_ns, 2'000'000) << "due times do not drift";
  EXPECT_EQ(next.since_last_ns, 600'000);
}

TEST(VirtualClock, AStallIsCountedAndNotMadeUpForInABurst) {
  VirtualClock clock(1000);
  TickStats stats;
  (void)clock.wait();
  clock.pass(25'300'000);  // the machine was suspended
  const TickTime after = clock.wait();
  stats.add_lateness(after.late_ns, clock.period_ns(), after.missed);
  EXPECT_EQ(after.late_ns, 24'300'000);
  EXPECT_EQ(after.missed, 24);
  EXPECT_EQ(after.since_last_ns, 25'300'000);
  const TickTime next = clock.wait();
  EXPECT_EQ(next.now_ns, 26'000'000);
  EXPECT_EQ(next.missed, 0);
  EXPECT_EQ(stats.summary().missed, 24U);
  EXPECT_EQ(stats.summary().late, 1U);
}

TEST(VirtualClock, ExactlyOnePeriodLateMissesOne) {
  VirtualClock clock(1000);
  (void)clock.wait();
  clock.pass(2'000'000);
  EXPECT_EQ(clock.wait().missed, 1);
  EXPECT_EQ(clock.wait().now_ns, 3'000'000);
}

TEST(WallClock, NeverBeginsATickBeforeItIsDueAndKeepsTheGrid) {
  WallClock clock(2000);
  const std::int64_t start = monotonic_ns();
  std::int64_t before = -1, grid = 0;
  for (int tick = 0; tick < 40; ++tick) {
    const TickTime time = clock.wait();
    EXPECT_GE(time.now_ns, time.due_ns);
    EXPECT_EQ(time.due_ns % 500'000, 0);
    EXPECT_GT(time.now_ns, before);
    before = time.now_ns;
    grid += time.missed + 1;
  }
  // 40 ticks and the missed ones took at least their periods in real time
  EXPECT_GE(monotonic_ns() - start, (grid - 41) * 500'000);
}

TEST(WallClock, WaitTakesNoMemoryAndNoLock) {
  WallClock clock(10'000);
  (void)clock.wait();
  const burr::test::RtGuard guard;
  for (int tick = 0; tick < 20; ++tick) (void)clock.wait();
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

TEST(Clock, ThreadTimeCountsWorkNotWaiting) {
  const std::int64_t cpu = thread_cpu_ns();
  WallClock clock(500);
  for (int tick = 0; tick < 10; ++tick) (void)clock.wait();  // sleeps for 18 ms
  EXPECT_LT(thread_cpu_ns() - cpu, 18'000'000);
  EXPECT_GE(thread_cpu_ns(), cpu);
}

}  // namespace
}  // namespace burr::rt
