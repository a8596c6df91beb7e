// Sixteen numbers at a time give the bits of one number at a time, on each instruction set.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "burr/rt/simd.h"
#include "rt/lanes_checks.h"

namespace burr::test {
namespace {

TEST(Lanes, GiveTheBitsOfOneNumberAtATime) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  EXPECT_STREQ(scalar::lanes_differ(seed), nullptr);
  if constexpr (rt::kWideKernels) {
    const rt::Simd was = rt::simd();
    rt::force_simd(rt::Simd::avx512);
    const rt::Simd best = rt::simd();  // of this processor
    rt::force_simd(was);
    if (best == rt::Simd::scalar) GTEST_SKIP() << "this processor has neither AVX2 nor AVX-512";
    EXPECT_STREQ(avx2::lanes_differ(seed), nullptr);
    if (best == rt::Simd::avx512) {
      EXPECT_STREQ(avx512::lanes_differ(seed), nullptr);
    }
  }
}

}  // namespace
}  // namespace burr::test
