// The page's own unpacking of zstd against zstd's library.
#include "web/unzstd.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <random>
#include <vector>

namespace burr::web {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes packed(const Bytes& bytes, int level, bool with_sum = false) {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(zstd, ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(zstd, ZSTD_c_checksumFlag, with_sum ? 1 : 0);
  Bytes out(ZSTD_compressBound(bytes.size()));
  out.resize(ZSTD_compress2(zstd, out.data(), out.size(), bytes.data(), bytes.size()));
  ZSTD_freeCCtx(zstd);
  return out;
}

// Noise, few letters, repeats from near and far, runs, repeats from three places in turn: what literals and
// sequences can look like.
Bytes made(int kind, std::size_t size, std::mt19937& random) {
  Bytes out(size);
  constexpr std::size_t lags[] = {37, 101, 353};
  std::size_t lag = lags[0];
  const auto any = [&](std::uint32_t below) {
    return static_cast<std::uint32_t>(random() % below);
  };
  for (std::size_t n = 0; n < size; ++n) {
    std::uint32_t value = 0;
    switch (kind) {
      case 0:
        value = any(256);
        break;
      case 1:
        value = any(5) * any(7);
        break;
      case 2:
        value = n > 100 && any(50) != 0 ? out[n - 1 - any(90)] : any(256);
        break;
      case 3:
        value = any(20) == 0 ? static_cast<std::uint32_t>(1 + n / 97 % 7) : 0;
        break;
      case 4:
        if (any(12) == 0) lag = lags[any(3)];
        value = n > 400 && any(30) != 0 ? out[n - lag] : any(256);
        break;
      default:
        value = n > 1000 ? out[n - 1000] ^ (any(40) == 0 ? 1U : 0U) : any(60);
        break;
    }
    out[n] = static_cast<std::uint8_t>(value);
  }
  return out;
}

TEST(Unzstd, UnpacksWhatZstdPacks) {
  std::mt19937 random(7);
  for (int n = 0; n < 400; ++n) {
    const Bytes bytes =
        made(n % 6, n < 100 ? static_cast<std::size_t>(n) : random() % 300'000, random);
    const Bytes small = packed(bytes, 1 + n % 12, n % 3 == 0);
    Bytes back;
    ASSERT_TRUE(unzstd(small, bytes.size(), back)) << n;
    ASSERT_EQ(back, bytes) << n;
  }
}

TEST(Unzstd, RefusesAnotherSize) {
  std::mt19937 random(1);
  const Bytes bytes = made(2, 5000, random), small = packed(bytes, 3);
  Bytes back;
  EXPECT_FALSE(unzstd(small, bytes.size() - 1, back));
  EXPECT_FALSE(unzstd(small, bytes.size() + 1, back));
  EXPECT_FALSE(unzstd({}, 0, back));
}

TEST(Unzstd, DamagedBytesGiveNoMoreThanTheSize) {
  std::mt19937 random(3);
  for (int n = 0; n < 2000; ++n) {
    const Bytes bytes = made(n % 6, 1 + random() % 4000, random);
    Bytes small = packed(bytes, 1 + n % 12);
    if (n % 4 == 0)
      small.resize(random() % small.size());
    else
      small[random() % small.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    Bytes back;
    if (!unzstd(small, bytes.size(), back)) {
      EXPECT_LE(back.size(), bytes.size());
    } else {
      EXPECT_EQ(back.size(), bytes.size());
    }
  }
}

}  // namespace
}  // namespace burr::web
