// The doors between two threads that wait at random between single steps, for half a second each
// (longer with BURR_SLOW_ATOMS_SECONDS). The guarantees of each header must hold all the time. Run
// under ThreadSanitizer too.
#include "rt/slow_atoms.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "burr/rt/changed_bits.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/versioned.h"

namespace burr::rt::test {
namespace {

// Plain data whose copy pauses in the middle: if a door permits it, half of it is old and half new.
struct Slow {
  std::uint64_t first = 0, second = 0;
  Slow() = default;
  explicit Slow(std::uint64_t value) : first(value), second(value) {}
  Slow(const Slow&) = default;
  Slow& operator=(const Slow& other) {
    if (this == &other) return *this;
    first = other.first;
    SlowAtoms::pause_at_random();
    second = other.second;
    return *this;
  }
};

class SlowAtomsTest : public testing::Test {
 protected:
  SlowAtomsTest() {
    const char* given = std::getenv("BURR_SEED");
    seed_ = given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
    std::printf("BURR_SEED=%llu\n", static_cast<unsigned long long>(seed_));
    const char* request = std::getenv("BURR_SLOW_ATOMS_SECONDS");
    end_ = Clock::now() + std::chrono::milliseconds(static_cast<int>(
                              1e3 * (request != nullptr ? std::atof(request) : 0.5)));
    SlowAtoms::seed(seed_);
  }
  using Clock = std::chrono::steady_clock;
  // True until the time is over and `happened` is true; one minute is the upper limit.
  [[nodiscard]] bool go_on(bool happened) const {
    const auto now = Clock::now();
    return now < end_ || (!happened && now < end_ + std::chrono::minutes(1));
  }

  // Starts a second thread, with its own delays.
  template <class Work>
  [[nodiscard]] std::jthread beside(Work work, std::uint64_t who = 1) const {
    return std::jthread([work, seed = seed_ + who]() mutable {
      SlowAtoms::seed(seed);
      work();
    });
  }

 private:
  std::uint64_t seed_ = 0;
  Clock::time_point end_;
};

TEST_F(SlowAtomsTest, RingKeepsOrderAndLosesNothingUncounted) {
  Ring<Slow, SlowAtoms> ring(4);
  std::atomic<bool> done = false;
  std::uint64_t pushed = 0, refused = 0;
  std::jthread writer = beside([&] {
    while (go_on(refused > 0 && pushed > 100))
      if (ring.push(Slow(pushed))) {
        ++pushed;
      } else {
        ++refused;
      }
    done = true;
  });
  std::jthread onlooker = beside(
      [&] {
        while (!done) ASSERT_LE(ring.size(), ring.capacity());
      },
      2);
  Slow row;
  std::uint64_t popped = 0;
  for (;;) {
    const bool last = done;
    if (!ring.pop(row)) {
      if (last) break;
      continue;
    }
    ASSERT_EQ(row.first, row.second) << "torn";
    ASSERT_EQ(row.first, popped);
    ++popped;
  }
  writer.join();
  onlooker.join();
  EXPECT_EQ(popped, pushed);
  EXPECT_EQ(ring.dropped(), refused);
  EXPECT_GT(refused, 0U) << "it was never full: the test shows nothing";
}

TEST_F(SlowAtomsTest, LatestIsNeverTornNeverOlderAndTheLastArrives) {
  Latest<Slow, SlowAtoms> door;
  std::atomic<bool> done = false;
  std::uint64_t published = 0;
  std::atomic<std::uint64_t> taken = 0;
  std::jthread writer = beside([&] {
    while (go_on(taken > 100)) door.publish(Slow(++published));
    done = true;
  });
  Slow seen;
  std::uint64_t newest = 0;
  for (;;) {
    const bool last = done;
    if (!door.take(seen)) {
      if (last) break;
      continue;
    }
    ASSERT_EQ(seen.first, seen.second) << "torn";
    ASSERT_GT(seen.first, newest);
    newest = seen.first;
    ++taken;
  }
  writer.join();
  EXPECT_EQ(newest, published);
  EXPECT_GT(taken, 100U) << "hardly anything arrived: the test shows nothing";
}

TEST_F(SlowAtomsTest, VersionedGivesWholeBlocksOrRefuses) {
  constexpr std::size_t kWords = 6;
  VersionOf<SlowAtoms> version = 0U;
  std::array<std::uint64_t, kWords> shared{};
  std::atomic<bool> done = false;
  std::uint64_t written = 0;
  std::atomic<std::uint64_t> refused = 0, seen = 0;
  std::jthread writer = beside([&] {
    std::array<std::uint64_t, kWords> from{};
    while (go_on(refused > 10 && seen > 100)) {
      from.fill(++written);
      versioned_write<SlowAtoms>(version, shared.data(), from.data(), kWords);
      for (int i = 0; i < 16; ++i) SlowAtoms::pause_at_random();
    }
    done = true;
  });
  std::uint64_t newest = 0;
  for (bool last = false; !last;) {
    last = done;
    std::array<std::uint64_t, kWords> to{};
    if (!versioned_read<SlowAtoms>(version, shared.data(), to.data(), kWords)) {
      ASSERT_FALSE(last) << "refused without a writer";
      ++refused;
      continue;
    }
    for (const std::uint64_t word : to) ASSERT_EQ(word, to[0]) << "torn";
    ASSERT_GE(to[0], newest);
    newest = to[0];
    ++seen;
  }
  writer.join();
  EXPECT_EQ(newest, written);
  EXPECT_GT(refused, 10U) << "they hardly met: the test shows nothing";
  EXPECT_GT(seen, 100U);
}

TEST_F(SlowAtomsTest, ChangedBitsTellOfEveryChangeAndNeverBeforeIt) {
  constexpr std::size_t kThings = 3;  // in one word
  ChangedBitsOf<SlowAtoms> bits(kThings);
  std::array<std::atomic<std::uint64_t>, kThings> value{};
  std::atomic<int> done = 0;
  std::atomic<std::uint64_t> found = 0;
  std::vector<std::jthread> writers;
  for (std::size_t who = 0; who < 2; ++who)
    writers.push_back(beside(
        [&, who] {
          std::uint64_t round = 0;
          while (go_on(found > 100)) {
            value[who].store(++round, std::memory_order_relaxed);
            bits.mark(who);
          }
          ++done;
        },
        1 + who));
  std::array<std::uint64_t, kThings> seen{};
  for (bool last = false; !last;) {
    last = done == 2;
    bits.take_all([&](std::size_t i) {
      ASSERT_LT(i, 2U) << "nobody marked it";
      const std::uint64_t now = value[i].load(std::memory_order_relaxed);
      ASSERT_GT(now, 0U) << "the bit came before the value";
      seen[i] = now;
      ++found;
    });
  }
  for (std::jthread& writer : writers) writer.join();
  for (std::size_t who = 0; who < 2; ++who)
    EXPECT_EQ(seen[who], value[who].load()) << "a change was lost";
}

}  // namespace
}  // namespace burr::rt::test
