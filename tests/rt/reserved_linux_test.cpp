// Reserved memory, compared with what the kernel of Linux says.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

#include "burr/rt/reserved.h"

namespace burr::rt {
namespace {

constexpr std::size_t kMany = 16 * 1024 * 1024;  // elements of 8 bytes

// The bytes of the array that are in memory, according to the kernel.
template <class T>
std::size_t resident_bytes(const ReservedArray<T>& array) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t pages = (array.size() * sizeof(T) + page - 1) / page;
  std::vector<unsigned char> there(pages);
  if (mincore(const_cast<T*>(array.data()), pages * page, there.data()) != 0) return 0;
  std::size_t count = 0;
  for (const unsigned char one : there) count += one & 1U;
  return count * page;
}

// Kernels before 5.14 cannot take pages ahead: all memory is then taken at the start.
bool takes_ahead() { return resident_bytes(ReservedArray<std::uint64_t>(kMany)) < 8 * kMany; }

TEST(ReservedArray, IsZeroAndTakesOnlyWhatItWasAskedToHave) {
  if (!takes_ahead()) GTEST_SKIP() << "this kernel takes everything at once";
  ReservedArray<std::uint64_t> array(kMany);
  EXPECT_EQ(resident_bytes(array), 0U);
  array.commit(100'000);
  EXPECT_GE(resident_bytes(array), 800'000U);
  EXPECT_LE(resident_bytes(array), 2'000'000U);
  const std::uint64_t* before = array.data();
  array.commit(kMany / 2);
  EXPECT_EQ(array.data(), before) << "the tick holds on to addresses";
  EXPECT_EQ(array[99'999], 0U);
  EXPECT_EQ(array[kMany - 1], 0U) << "what nobody asked for is there all the same";
}

TEST(ReservedArray, WhatIsHadIsWrittenWithoutTheKernel) {
#if defined(BURR_SANITIZED)
  GTEST_SKIP() << "a sanitizer's own books beside the array are written too, and counted";
#endif
  if (!takes_ahead()) GTEST_SKIP() << "this kernel takes everything at once";
  ReservedArray<std::uint64_t> array(kMany);
  const auto faults = [] {
    rusage usage = {};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_minflt;
  };
  array.commit(kMany / 4);
  long before = faults();
  for (std::size_t n = 0; n < kMany / 4; n += 64) array[n] = n;
  const long had = faults() - before;
  before = faults();
  for (std::size_t n = kMany / 4 + 65536; n < kMany / 2; n += 64) array[n] = n;
  const long not_had = faults() - before;
  if (not_had == 0) GTEST_SKIP() << "this kernel does not count faults";
  EXPECT_LE(had, not_had / 100);
}

// A real-time session locks all memory of the program, and the kernel takes none of it back. So
// what is given back must be wiped, or added bricks of the next session would begin with old bone.
TEST(ReservedArray, WhatIsGivenBackIsZeroThoughItIsLocked) {
  ReservedArray<std::uint64_t> array(4096);
  if (mlock(array.data(), 8 * array.size()) != 0) GTEST_SKIP() << "may not lock memory";
  for (std::size_t n = 0; n < array.size(); ++n) array[n] = n + 1;
  array.decommit(100);
  EXPECT_EQ(array[99], 100U);
  for (std::size_t n = 100; n < array.size(); ++n) ASSERT_EQ(array[n], 0U) << n;
  munlock(array.data(), 8 * array.size());
}

}  // namespace
}  // namespace burr::rt
