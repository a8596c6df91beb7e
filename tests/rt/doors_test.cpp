// The doors between threads. Run under ThreadSanitizer too: a report is a failure.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "burr/rt/changed_bits.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/versioned.h"
#include "support/rt_guard.h"

namespace burr::rt {
namespace {

// Wide enough that a torn copy shows.
struct Wide {
  std::uint64_t word[24] = {};
  Wide() = default;
  explicit Wide(std::uint64_t value) {
    for (std::uint64_t& w : word) w = value;
  }
  [[nodiscard]] bool whole() const {
    for (const std::uint64_t w : word)
      if (w != word[0]) return false;
    return true;
  }
};

TEST(Latest, GivesTheNewestOnceAndLeavesTheRestAlone) {
  Latest<int> door;
  int seen = -1;
  EXPECT_FALSE(door.take(seen));
  EXPECT_EQ(seen, -1);
  door.publish(1);
  door.publish(2);
  door.publish(3);
  EXPECT_TRUE(door.take(seen));
  EXPECT_EQ(seen, 3);
  EXPECT_FALSE(door.take(seen));
}

TEST(Latest, BetweenThreadsNothingIsTornAndTimeOnlyGoesForward) {
  constexpr std::uint64_t kLast = 200'000;
  Latest<Wide> door;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) door.publish(Wide(i));
  });
  std::uint64_t newest = 0;
  Wide seen;
  while (newest < kLast) {
    if (!door.take(seen)) continue;
    ASSERT_TRUE(seen.whole());
    ASSERT_GT(seen.word[0], newest);
    newest = seen.word[0];
  }
  writer.join();
}

TEST(Ring, KeepsOrderRefusesWhenFullAndCounts) {
  Ring<int> ring(3);
  EXPECT_EQ(ring.capacity(), 4U) << "rounded up to a power of two";
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(9));
  EXPECT_FALSE(ring.push(9));
  EXPECT_EQ(ring.dropped(), 2U);
  EXPECT_EQ(ring.size(), 4U);
  int out = -1;
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(ring.pop(out));
    EXPECT_EQ(out, i);
  }
  EXPECT_FALSE(ring.pop(out));
  EXPECT_TRUE(ring.push(5)) << "room again";
}

TEST(Ring, BetweenThreadsEverythingPushedArrivesOnceInOrder) {
  constexpr std::uint64_t kRows = 300'000;
  Ring<Wide> ring(256);
  std::uint64_t refused = 0;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kRows;) {
      if (ring.push(Wide(i))) {
        ++i;
      } else {
        ++refused;
        std::this_thread::yield();
      }
    }
  });
  Wide seen;
  for (std::uint64_t expected = 0; expected < kRows;) {
    if (!ring.pop(seen)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_TRUE(seen.whole());
    ASSERT_EQ(seen.word[0], expected);
    ++expected;
  }
  writer.join();
  EXPECT_EQ(ring.dropped(), refused);
}

TEST(ChangedBits, MarkedTwiceIsTakenOnceAndAllIndicesWork) {
  ChangedBits bits(130);
  for (const std::size_t i : {std::size_t{0}, std::size_t{63}, std::size_t{64}, std::size_t{129}}) {
    bits.mark(i);
    bits.mark(i);
  }
  std::vector<std::size_t> seen;
  bits.take_all([&](std::size_t i) { seen.push_back(i); });
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 63, 64, 129}));
  bits.take_all([](std::size_t) { FAIL() << "taken twice"; });
}

TEST(ChangedBits, WhoeverTakesTheBitSeesWhatWasWrittenBeforeIt) {
  constexpr int kRounds = 20'000;
  ChangedBits bits(100);
  std::vector<std::atomic<int>> value(100);
  std::thread writer([&] {
    for (int round = 1; round <= kRounds; ++round) {
      const auto i = static_cast<std::size_t>(round % 100);
      value[i].store(round, std::memory_order_relaxed);
      bits.mark(i);
    }
  });
  int newest = 0;
  while (newest < kRounds) {
    bits.take_all([&](std::size_t i) {
      const int seen = value[i].load(std::memory_order_relaxed);
      EXPECT_GT(seen, 0) << "the bit came before the value";
      newest = std::max(newest, seen);
    });
  }
  writer.join();
}

TEST(Versioned, AReaderSeesAWholeBlockOrIsToldToComeBack) {
  constexpr std::size_t kWords = 128;
  constexpr std::uint64_t kLast = 50'000;
  Version version = 0;
  std::vector<std::uint64_t> shared(kWords);
  std::atomic<bool> done = false;
  std::thread writer([&] {
    std::vector<std::uint64_t> block(kWords);
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      for (std::uint64_t& w : block) w = i;
      versioned_write(version, shared.data(), block.data(), kWords);
      if (i % 16 == 0) std::this_thread::yield();
    }
    done = true;
  });
  std::vector<std::uint64_t> seen(kWords);
  std::uint64_t newest = 0;
  while (newest < kLast) {
    if (!versioned_read(version, shared.data(), seen.data(), kWords)) continue;
    for (const std::uint64_t w : seen) ASSERT_EQ(w, seen[0]);
    ASSERT_GE(seen[0], newest);
    newest = seen[0];
  }
  writer.join();
  EXPECT_TRUE(done);
}

TEST(Versioned, WhileItIsBeingWrittenReadersAreRefused) {
  Version version = 3;  // odd: a write is in progress
  std::uint64_t shared[2] = {1, 2}, to[2] = {};
  EXPECT_FALSE(versioned_read(version, shared, to, 2));
  version = 4;
  EXPECT_TRUE(versioned_read(version, shared, to, 2));
  EXPECT_EQ(to[1], 2U);
}

TEST(Doors, TakeNoMemoryAndNoLock) {
  Latest<Wide> latest;
  Ring<Wide> ring(8);
  ChangedBits bits(64);
  Version version = 0;
  std::uint64_t shared[4] = {}, block[4] = {1, 2, 3, 4};
  Wide out;
  const burr::test::RtGuard guard;
  latest.publish(Wide(1));
  (void)latest.take(out);
  for (int i = 0; i < 20; ++i) (void)ring.push(Wide(2));  // fills up, and refuses
  (void)ring.pop(out);
  bits.mark(5);
  bits.take_all([](std::size_t) {});
  versioned_write(version, shared, block, 4);
  (void)versioned_read(version, shared, block, 4);
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

}  // namespace
}  // namespace burr::rt
