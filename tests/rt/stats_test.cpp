#include "burr/rt/stats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/rt_guard.h"

namespace burr::rt {
namespace {

// Nearest rank, on the values themselves.
double exact_us(std::vector<std::int64_t> values, double q) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return static_cast<double>(values[std::max<std::size_t>(rank, 1) - 1]) * 1e-3;
}

TEST(TickStats, QuantilesAgreeWithSortingToEightTenthsOfAPercent) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  std::lognormal_distribution<double> took(std::log(8e3), 1.5);  // 8 us, with a long tail
  for (const int count : {1, 2, 10, 999, 100'000}) {
    TickStats stats;
    std::vector<std::int64_t> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(static_cast<std::int64_t>(took(random)));
      stats.add(values.back());
    }
    for (const double q : {0.0, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const double truth = exact_us(values, q);
      EXPECT_NEAR(stats.quantile_us(q), truth, 0.008 * truth + 1e-3) << q << " of " << count;
    }
    EXPECT_EQ(stats.summary().max_us,
              static_cast<double>(*std::max_element(values.begin(), values.end())) * 1e-3);
    EXPECT_EQ(stats.ticks(), static_cast<std::uint64_t>(count));
  }
}

TEST(TickStats, ShortTimesAreExact) {
  for (int ns = 0; ns < 128; ++ns) {
    TickStats stats;
    stats.add(ns);
    stats.add(1'000'000);
    EXPECT_EQ(stats.quantile_us(0.5), ns * 1e-3);
  }
}

TEST(TickStats, EveryMagnitudeHasItsBucket) {
  for (double ns = 1; ns < 4e12; ns *= 1.01) {
    TickStats stats;
    const auto whole = static_cast<std::int64_t>(ns);
    stats.add(whole);
    stats.add(std::int64_t{1} << 41);
    const double truth = static_cast<double>(whole) * 1e-3;
    if (whole < (std::int64_t{1} << 41)) {
      EXPECT_NEAR(stats.quantile_us(0.5), truth, 0.008 * truth);
    }
  }
}

TEST(TickStats, ImpossibleTimesAreHeldWithinBounds) {
  TickStats stats;
  stats.add(-5);
  stats.add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(stats.quantile_us(0.5), 0);
  EXPECT_GT(stats.quantile_us(1), 4e9);
  EXPECT_EQ(stats.quantile_us(-1), 0);
  EXPECT_EQ(stats.quantile_us(7), stats.quantile_us(1));
}

TEST(TickStats, NothingMeasuredIsZero) {
  const TickSummary nothing = TickStats().summary();
  EXPECT_EQ(nothing.ticks, 0U);
  EXPECT_EQ(nothing.p50_us, 0);
  EXPECT_EQ(nothing.mean_us, 0);
  EXPECT_EQ(nothing.max_us, 0);
}

TEST(TickStats, CountsLateAndMissedTicks) {
  TickStats stats;
  stats.add_lateness(0, 1'000'000, 0);
  stats.add_lateness(100'000, 1'000'000, 0);  // a tenth of a period: still in time
  stats.add_lateness(100'001, 1'000'000, 0);
  stats.add_lateness(3'200'000, 1'000'000, 3);
  const TickSummary s = stats.summary();
  EXPECT_EQ(s.late, 2U);
  EXPECT_EQ(s.missed, 3U);
  EXPECT_EQ(s.worst_lateness_us, 3200);
}

TEST(TickStats, TellsHowLateTicksBeganByTheSameQuantiles) {
  TickStats stats;
  for (std::int64_t i = 1; i <= 1000; ++i) {
    stats.add(1);  // the duration is counted separately
    stats.add_lateness(i * 1000, 1'000'000, 0);
  }
  const TickSummary s = stats.summary();
  EXPECT_NEAR(s.late_p50_us, 500, 4);
  EXPECT_NEAR(s.late_p99_us, 990, 8);
  EXPECT_NEAR(s.late_p999_us, 999, 8);
  EXPECT_EQ(s.p999_us, 1e-3);
}

TEST(TickStats, CountsTicksOverOneMillisecondAndTheMean) {
  TickStats stats;
  for (const std::int64_t ns : {1'000'000, 1'000'001, 2'000'000, 3'000}) stats.add(ns);
  EXPECT_EQ(stats.summary().over_1ms, 2U);
  EXPECT_NEAR(stats.summary().mean_us, 4'003.001 / 4, 1e-9);
}

TEST(TickStats, AddTakesNoMemoryAndNoLock) {
  TickStats stats;
  const burr::test::RtGuard guard;
  for (std::int64_t i = 0; i < 10'000; ++i) {
    stats.add(i * 37);
    stats.add_lateness(i, 1'000'000, 0);
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

}  // namespace
}  // namespace burr::rt
