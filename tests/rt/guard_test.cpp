// The guard must detect what it is for; if it did not, all other tests would pass in vain.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <thread>

#include "support/rt_guard.h"

namespace burr::test {
namespace {

// Hides a value from the optimiser.
void* volatile hold = nullptr;
void keep(void* p) { hold = p; }

struct alignas(64) Wide {
  double number[8];
};

#define NEEDS_A_GUARD_THAT_SEES() \
  if (!RtGuard::watching()) GTEST_SKIP() << "sanitizers bring their own malloc"

TEST(RtGuard, SeesEveryWayToTheHeap) {
  NEEDS_A_GUARD_THAT_SEES();
  const RtGuard guard;
  long before = 0;
  const auto counted = [&] {
    const long now = guard.allocations() - before;
    before = guard.allocations();
    return now;
  };
  keep(std::malloc(10));
  EXPECT_EQ(counted(), 1) << "malloc";
  keep(std::realloc(hold, 100));
  EXPECT_EQ(counted(), 1) << "realloc";
  std::free(hold);
  EXPECT_EQ(counted(), 1) << "free";
  keep(std::calloc(3, 5));
  std::free(hold);
  EXPECT_EQ(counted(), 2) << "calloc, free";
  keep(std::aligned_alloc(64, 128));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(hold) % 64, 0U);
  std::free(hold);
  EXPECT_EQ(counted(), 2) << "aligned_alloc, free";
  void* aligned = nullptr;
  EXPECT_EQ(posix_memalign(&aligned, 128, 256), 0);
  keep(aligned);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(hold) % 128, 0U);
  std::free(hold);
  EXPECT_EQ(counted(), 2) << "posix_memalign, free";
  keep(memalign(64, 64));
  std::free(hold);
  EXPECT_EQ(counted(), 2) << "memalign, free";
  auto* number = new int(3);
  keep(number);
  delete number;
  EXPECT_EQ(counted(), 2) << "new, delete";
  auto* wide = new Wide();
  keep(wide);
  delete wide;
  EXPECT_EQ(counted(), 2) << "aligned new, delete";
}

TEST(RtGuard, SeesLocks) {
  NEEDS_A_GUARD_THAT_SEES();
  std::mutex mutex;
  const RtGuard guard;
  { const std::lock_guard lock(mutex); }
  EXPECT_EQ(guard.locks(), 1);
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(RtGuard, MindsOnlyItsOwnThreadAndItsOwnLife) {
  NEEDS_A_GUARD_THAT_SEES();
  std::unique_ptr<std::thread> other;
  other = std::make_unique<std::thread>([] { keep(std::malloc(10)); });
  {
    const RtGuard guard;
    while (hold == nullptr) std::this_thread::yield();
    EXPECT_EQ(guard.allocations(), 0);
  }
  other->join();
  std::free(hold);
  const RtGuard fresh;
  EXPECT_EQ(fresh.allocations(), 0) << "what came before is not counted";
}

}  // namespace
}  // namespace burr::test
