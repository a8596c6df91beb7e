#include "burr/rt/reserved.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>

namespace burr::rt {
namespace {

constexpr std::size_t kMany = 16 * 1024 * 1024;  // elements of 8 bytes

TEST(ReservedArray, GrowsAndGivesBackWithoutLosingAnything) {
  ReservedArray<std::uint64_t> array(1000);
  for (std::size_t n = 0; n < array.size(); ++n) array[n] = n + 1;
  array.grow(kMany);
  EXPECT_EQ(array.size(), kMany);
  for (std::size_t n = 0; n < 1000; ++n) ASSERT_EQ(array[n], n + 1);
  array[kMany - 1] = 7;
  array.decommit(500);
  for (std::size_t n = 0; n < 500; ++n) ASSERT_EQ(array[n], n + 1);
  for (std::size_t n = 500; n < 2000; ++n) ASSERT_EQ(array[n], 0U);
  EXPECT_EQ(array[kMany - 1], 0U);
  array[kMany - 1] = 8;
  EXPECT_EQ(array[kMany - 1], 8U);
}

TEST(ReservedArray, AHelperTakesAheadWhileTheOwnerWrites) {
  ReservedArray<std::uint64_t> array(1'000'000);
  std::atomic<std::size_t> used = 0;
  std::thread helper([&] {
    for (std::size_t seen = 0; seen < array.size();) {
      seen = used.load(std::memory_order_relaxed);
      array.commit(seen + 4096);
    }
  });
  for (std::size_t n = 0; n < array.size(); ++n) {
    array[n] += n;
    used.store(n + 1, std::memory_order_relaxed);
  }
  helper.join();
  for (std::size_t n = 0; n < array.size(); ++n) ASSERT_EQ(array[n], n);
}

}  // namespace
}  // namespace burr::rt
