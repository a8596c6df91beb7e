#include "burr/thermal/heat_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include "support/rt_guard.h"
#include "thermal/blocks.h"

namespace burr::thermal {
namespace {

using math::Ijk;
using math::Vec3;
using test::block;
using test::everything;

constexpr std::int64_t kTickNs = 1'000'000;

// A burr that moves over a slab for this many ticks, with coolant now and then.
std::vector<HeatRow> milling(int ticks, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<> step(-1e-4, 1e-4);
  std::vector<HeatRow> rows;
  Vec3 p(10e-3, 10e-3, 9.5e-3);
  for (int tick = 0; tick < ticks; ++tick) {
    p.x() = std::clamp(p.x() + step(random), 2e-3, 18e-3);
    p.y() = std::clamp(p.y() + step(random), 2e-3, 18e-3);
    rows.push_back({.time_ns = 5'000'000'000 + tick * kTickNs,
                    .place = p,
                    .energy = tick % 500 < 400 ? 3e-3 : 0,
                    .radius = 2e-3,
                    .edge = static_cast<Edge>(tick / 700 % 3),
                    .irrigated = tick / 300 % 2 == 1});
  }
  return rows;
}

std::unique_ptr<volume::Bone> slab() { return block({40, 40, 20}, 0.5e-3); }

void expect_same(const HeatSummary& a, const HeatSummary& b) {
  EXPECT_EQ(a.time_ns, b.time_ns);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.hottest_c, b.hottest_c);
  EXPECT_EQ(a.hottest, b.hottest);
  EXPECT_EQ(std::memcmp(&a.ledger, &b.ledger, sizeof a.ledger), 0);
  for (std::size_t id = 0; id < a.tissue.size(); ++id) {
    EXPECT_EQ(a.tissue[id].there, b.tissue[id].there);
    EXPECT_EQ(a.tissue[id].now_c, b.tissue[id].now_c);
    EXPECT_EQ(a.tissue[id].ever_c, b.tissue[id].ever_c);
    EXPECT_EQ(a.tissue[id].cem43_min, b.tissue[id].cem43_min);
    EXPECT_EQ(a.tissue[id].warm_m3, b.tissue[id].warm_m3);
  }
}

TEST(Heating, KeepsTheAccountOfTheBurr) {
  const auto bone = slab();
  Heating heating(*bone, everything(*bone), {});
  int summaries = 0;
  double spent = 0, stays = 0;
  for (const HeatRow& row : milling(3000, 1)) {
    summaries += heating.take(row) ? 1 : 0;
    spent += row.energy;
    stays += row.energy * (row.edge == Edge::flute ? 0.25 : 0.5);
  }
  const HeatSummary& summary = heating.sum_up();
  EXPECT_EQ(summaries, 29);  // the last tenth of a second is not complete
  EXPECT_EQ(summary.rows, 3000U);
  EXPECT_NEAR(summary.ledger.spent, spent, 1e-12);
  EXPECT_NEAR(summary.ledger.into, stays, 1e-12);
  EXPECT_EQ(summary.ledger.missed, 0);
  EXPECT_LT(test::imbalance(summary.ledger), 1e-9);
  EXPECT_GT(summary.hottest_c, 45);
  EXPECT_GT(summary.tissue[1].cem43_min, 0);
}

TEST(Heating, ARowForTenTicksIsAsGoodAsTen) {
  const auto a_bone = slab(), b_bone = slab();
  Heating a(*a_bone, everything(*a_bone), {}), b(*b_bone, everything(*b_bone), {});
  HeatRow row = {.place = {10e-3, 10e-3, 9.5e-3}, .energy = 2e-3, .radius = 2e-3};
  for (int tick = 0; tick < 2000; ++tick) {
    row.time_ns = tick * kTickNs;
    static_cast<void>(a.take(row));
    if (tick % 10 != 0) continue;
    HeatRow ten = row;
    ten.energy *= 10;
    static_cast<void>(b.take(ten));
  }
  EXPECT_NEAR(a.sum_up().hottest_c, b.sum_up().hottest_c, 1e-9);
}

TEST(Heating, StartsOverWhenToldTo) {
  const auto bone = slab();
  Heating heating(*bone, everything(*bone), {});
  const auto rows = milling(1000, 1);
  for (const HeatRow& row : rows) static_cast<void>(heating.take(row));
  EXPECT_GT(heating.sum_up().hottest_c, 40);
  static_cast<void>(heating.take({.time_ns = 0, .start_over = true}));
  EXPECT_EQ(heating.sum_up().hottest_c, 37);
  EXPECT_EQ(heating.summary().ledger.spent, 0);
  // and is then like a new one
  const auto other_bone = slab();
  Heating other(*other_bone, everything(*other_bone), {});
  for (HeatRow row : rows) {
    row.time_ns -= rows.front().time_ns;
    static_cast<void>(heating.take(row));
    static_cast<void>(other.take(row));
  }
  EXPECT_EQ(heating.sum_up().hottest_c, other.sum_up().hottest_c);
  EXPECT_EQ(heating.summary().ledger.stored, other.summary().ledger.stored);
}

TEST(Heating, TimeThatJumpsIsNotWorkedOffForEver) {
  const auto bone = slab();
  Heating heating(*bone, everything(*bone), {});
  HeatRow row = {
      .time_ns = 1'000'000'000, .place = {10e-3, 10e-3, 9.5e-3}, .energy = 0.5, .radius = 2e-3};
  static_cast<void>(heating.take(row));
  const double hot = heating.sum_up().hottest_c;
  row.energy = 0;
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::max(),
                                  std::numeric_limits<std::int64_t>::min(), std::int64_t{5}}) {
    row.time_ns = time;
    static_cast<void>(heating.take(row));
    EXPECT_LT(heating.sum_up().hottest_c, hot);
    EXPECT_GT(heating.sum_up().hottest_c, 37) << "a minute at most has passed";
  }
}

TEST(HeatWorker, SaysWhatTheBatchSays) {
  const auto rows = milling(3500, 2);
  const auto batch_bone = slab(), bone = slab();
  Heating batch(*batch_bone, everything(*batch_bone), {});
  for (const HeatRow& row : rows) static_cast<void>(batch.take(row));

  Worker worker(*bone, everything(*bone), {});
  for (const HeatRow& row : rows) ASSERT_TRUE(worker.push(row));
  worker.settle();
  HeatSummary summary;
  ASSERT_TRUE(worker.take(summary));
  EXPECT_FALSE(worker.take(summary));
  expect_same(summary, batch.summary());
  EXPECT_EQ(worker.dropped(), 0U);
}

TEST(HeatWorker, SeesWhatWasCutBetweenTheRows) {
  const auto rows = milling(2000, 3);
  const auto batch_bone = slab(), bone = slab();
  Heating batch(*batch_bone, everything(*batch_bone), {});
  Worker worker(*bone, everything(*bone), {});
  HeatSummary summary;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (n % 100 == 0) {
      worker.settle();
      const Ijk at(static_cast<int>(n / 100), 18, 16);
      test::cut_out(*bone, at, at + Ijk(4, 4, 4));
      test::cut_out(*batch_bone, at, at + Ijk(4, 4, 4));
    }
    static_cast<void>(batch.take(rows[n]));
    ASSERT_TRUE(worker.push(rows[n]));
  }
  worker.settle();
  ASSERT_TRUE(worker.take(summary));
  expect_same(summary, batch.summary());
  EXPECT_GT(std::abs(summary.ledger.removed), 1e-6);
  EXPECT_LT(test::imbalance(summary.ledger), 1e-6);
}

// The order is not fixed, so only this is checked: the account balances and no thread hangs.
TEST(HeatWorker, KeepsItsAccountWhileTheServoCuts) {
  const auto bone = slab();
  Worker worker(*bone, everything(*bone), {}, 1 << 14);
  const auto rows = milling(3000, 4);
  std::thread servo([&] {
    std::mt19937 random(4);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      if (n % 3 == 0) {
        const Ijk at(static_cast<int>(random() % 40), static_cast<int>(random() % 40), 12);
        test::cut_out(*bone, at, at + Ijk(3, 3, 8));
      }
      static_cast<void>(worker.push(rows[n]));
      if (n % 16 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  HeatSummary summary;
  for (int n = 0; n < 20; ++n) {
    if (worker.take(summary)) {
      EXPECT_LT(test::imbalance(summary.ledger), 1e-6);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  servo.join();
  worker.settle();
  static_cast<void>(worker.take(summary));
  EXPECT_LT(test::imbalance(summary.ledger), 1e-6);
  EXPECT_GT(std::abs(summary.ledger.removed), 1e-6);
}

TEST(HeatWorker, AFullRingRefusesAndCounts) {
  const auto bone = block({120, 120, 60}, 0.5e-3);
  Worker worker(*bone, everything(*bone), {.cell = 0.5e-3}, 4);
  int lost = 0;
  HeatRow row;
  for (int n = 0; n < 2000; ++n) {
    row.time_ns = n * 50 * kTickNs;  // one step each: more than it can process
    lost += worker.push(row) ? 0 : 1;
  }
  EXPECT_GT(lost, 0);
  EXPECT_EQ(worker.dropped(), static_cast<std::uint64_t>(lost));
}

TEST(HeatWorker, ThePushTakesNeitherMemoryNorLock) {
  const auto bone = slab();
  Worker worker(*bone, everything(*bone), {}, 64);
  const auto rows = milling(500, 5);
  const test::RtGuard guard;
  for (const HeatRow& row : rows) static_cast<void>(worker.push(row));
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

}  // namespace
}  // namespace burr::thermal
