// The doors in every order of their steps, and with every value that C++ permits a load to see.
// tests/rt/explore.h says what this covers and what not. Not under sanitizers: they cannot follow
// the model's simulated threads.
#include "rt/explore.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "burr/rt/changed_bits.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/versioned.h"

namespace burr::rt::test {
namespace {

#if defined(BURR_SANITIZED)
#define BURR_EXPLORES() GTEST_SKIP() << "explored in the release build"
#else
#define BURR_EXPLORES() static_cast<void>(0)
#endif

void expect_good(const Explored& all, const char* what) {
  std::printf("%s: %llu executions\n", what, static_cast<unsigned long long>(all.executions));
  EXPECT_EQ(all.trouble, "");
  EXPECT_TRUE(all.complete) << "too many orders";
}

// ---- the explorer itself: if it detected nothing, all other tests would pass in vain

// x is written, then a flag; a thread that sees the flag reads x.
Explored message(std::memory_order write, std::memory_order read) {
  return explore([=](Threads& threads) {
    struct Shared {
      ModelAtoms::Atomic<unsigned> x = 0U, flag = 0U;
    };
    auto shared = std::make_shared<Shared>();
    threads.add([=] {
      shared->x.store(1, std::memory_order_relaxed);
      shared->flag.store(1, write);
    });
    threads.add([=] {
      if (shared->flag.load(read) == 1)
        expect(shared->x.load(std::memory_order_relaxed) == 1, "old");
    });
  });
}

TEST(Explorer, FindsAMessageThatComesBeforeWhatItSpeaksOf) {
  BURR_EXPLORES();
  EXPECT_NE(message(std::memory_order_relaxed, std::memory_order_acquire).trouble, "");
  EXPECT_NE(message(std::memory_order_release, std::memory_order_relaxed).trouble, "");
  expect_good(message(std::memory_order_release, std::memory_order_acquire), "message");
}

TEST(Explorer, FindsThatBothMaySeeNothingOfTheOther) {
  BURR_EXPLORES();
  const Explored all = explore([](Threads& threads) {
    struct Shared {
      ModelAtoms::Atomic<unsigned> x = 0U, y = 0U;
      unsigned saw_x = 9, saw_y = 9;
    };
    auto shared = std::make_shared<Shared>();
    threads.add([=] {
      shared->x.store(1, std::memory_order_release);
      shared->saw_y = shared->y.load(std::memory_order_acquire);
    });
    threads.add([=] {
      shared->y.store(1, std::memory_order_release);
      shared->saw_x = shared->x.load(std::memory_order_acquire);
    });
    threads.at_end([=] { expect(shared->saw_x + shared->saw_y > 0, "both old"); });
  });
  EXPECT_NE(all.trouble.find("both old"), std::string::npos);
}

TEST(Explorer, FindsRacesAndLostUpdates) {
  BURR_EXPLORES();
  // written and read without synchronisation
  EXPECT_NE(explore([](Threads& threads) {
              auto cell = std::make_shared<Cell>();
              threads.add([=] { *cell = Cell(1); });
              threads.add([=] { static_cast<void>(cell->value()); });
            }).trouble.find("race"),
            std::string::npos);
  // one thread adds by load and store, one in a single step
  const auto add = [](bool in_one) {
    return explore([=](Threads& threads) {
      auto sum = std::make_shared<ModelAtoms::Atomic<unsigned>>(0U);
      for (int i = 0; i < 2; ++i)
        threads.add([=] {
          if (in_one) {
            sum->fetch_add(1, std::memory_order_relaxed);
          } else {
            sum->store(sum->load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
          }
        });
      threads.at_end([=] { expect(sum->load(std::memory_order_relaxed) == 2, "lost"); });
    });
  };
  EXPECT_NE(add(false).trouble, "");
  expect_good(add(true), "add");
}

// ---- the doors

TEST(ExploredRing, EverythingPushedArrivesOnceInOrderAndWholeOrIsCounted) {
  BURR_EXPLORES();
  for (const int pushes : {3, 4}) {
    const Explored all = explore([=](Threads& threads) {
      struct Shared {
        Ring<Cell, ModelAtoms> ring{2};
        std::vector<std::uint64_t> in, out;
        std::uint64_t refused = 0;
      };
      auto shared = std::make_shared<Shared>();
      threads.add([=] {
        for (int i = 1; i <= pushes; ++i) {
          const auto value = static_cast<std::uint64_t>(i);
          if (shared->ring.push(Cell(value))) {
            shared->in.push_back(value);
          } else {
            ++shared->refused;
          }
        }
      });
      threads.add([=] {
        Cell row;
        for (int i = 0; i < 3; ++i)
          if (shared->ring.pop(row)) shared->out.push_back(row.value());
      });
      threads.at_end([=] {
        Cell row;
        while (shared->ring.pop(row)) shared->out.push_back(row.value());
        expect(shared->in == shared->out, "not what was pushed");
        expect(shared->ring.dropped() == shared->refused, "refused and not counted");
        expect(shared->ring.size() == 0, "empty, and it says otherwise");
      });
    });
    expect_good(all, "ring");
  }
}

TEST(ExploredRing, ARingIsNeverFullerThanItIsWhoeverAsks) {
  BURR_EXPLORES();
  const Explored all = explore([](Threads& threads) {
    auto ring = std::make_shared<Ring<Cell, ModelAtoms>>(2);
    threads.add([=] {
      for (std::uint64_t i = 1; i <= 2; ++i) static_cast<void>(ring->push(Cell(i)));
    });
    threads.add([=] {
      Cell row;
      for (int i = 0; i < 2; ++i) static_cast<void>(ring->pop(row));
    });
    threads.add([=] { expect(ring->size() <= ring->capacity(), "fuller than it can be"); });
  });
  expect_good(all, "ring, asked by a third");
}

TEST(ExploredLatest, OnlyWholeValuesOnlyNewerOnesAndTheLastIsNeverLost) {
  BURR_EXPLORES();
  const Explored all = explore([](Threads& threads) {
    struct Shared {
      Latest<Cell, ModelAtoms> door;
      std::uint64_t newest = 0;
    };
    auto shared = std::make_shared<Shared>();
    threads.add([=] {
      for (std::uint64_t i = 1; i <= 4; ++i) shared->door.publish(Cell(i));
    });
    const auto take = [shared] {
      Cell seen;
      if (!shared->door.take(seen)) return;
      expect(seen.value() > shared->newest, "older than what was seen before");
      shared->newest = seen.value();
    };
    threads.add([=] {
      for (int i = 0; i < 4; ++i) take();
    });
    threads.at_end([=] {
      take();
      expect(shared->newest == 4, "the last one was lost");
    });
  });
  expect_good(all, "latest");
}

TEST(ExploredChangedBits, WhoeverTakesABitSeesWhatWasWrittenAndNoBitIsLost) {
  BURR_EXPLORES();
  const Explored all = explore([](Threads& threads) {
    struct Shared {
      ChangedBitsOf<ModelAtoms> bits{64};  // one word: two writers meet in it
      std::array<ModelAtoms::Atomic<unsigned>, 2> value{};
      std::array<unsigned, 2> seen{};
    };
    auto shared = std::make_shared<Shared>();
    for (const std::size_t who : {std::size_t{0}, std::size_t{1}})
      threads.add([=] {
        for (unsigned round = 1; round <= (who == 0 ? 2U : 1U); ++round) {
          shared->value[who].store(round, std::memory_order_relaxed);
          shared->bits.mark(who);
        }
      });
    const auto take = [shared] {
      shared->bits.take_all([&](std::size_t i) {
        const unsigned value = shared->value[i].load(std::memory_order_relaxed);
        expect(value > 0, "the bit came before the value");
        shared->seen[i] = std::max(shared->seen[i], value);
      });
    };
    threads.add([=] {
      take();
      take();
    });
    threads.at_end([=] {
      take();
      expect(shared->seen[0] == 2 && shared->seen[1] == 1, "a change was lost");
    });
  });
  expect_good(all, "changed bits");
}

TEST(ExploredVersioned, AReaderSeesAWholeBlockNeverAnOlderOneOrIsToldToComeBack) {
  BURR_EXPLORES();
  const Explored all = explore([](Threads& threads) {
    struct Shared {
      VersionOf<ModelAtoms> version = 0U;
      std::uint64_t block[2] = {0, 0};
      std::uint64_t newest = 0;
    };
    auto shared = std::make_shared<Shared>();
    threads.add([=] {
      for (std::uint64_t i = 1; i <= 2; ++i) {
        const std::uint64_t from[2] = {i, i};
        versioned_write<ModelAtoms>(shared->version, shared->block, from, 2);
      }
    });
    const auto read = [shared] {
      std::uint64_t to[2] = {};
      if (!versioned_read<ModelAtoms>(shared->version, shared->block, to, 2)) return false;
      expect(to[0] == to[1], "torn");
      expect(to[0] >= shared->newest, "older than what was seen before");
      shared->newest = to[0];
      return true;
    };
    threads.add([=] {
      read();
      read();
    });
    threads.at_end([=] { expect(read() && shared->newest == 2, "refused without a writer"); });
  });
  expect_good(all, "versioned");
}

}  // namespace
}  // namespace burr::rt::test
