// The page's unpacking of zstd against zstd's library.
#include <gtest/gtest.h>
#include <zstd.h>

#include <random>
#include <vector>

#include "web/page_codecs.h"

namespace burr::web {
namespace {

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

Asked asked(const Bytes& small, std::size_t size) {
  return {Codec::zstd, static_cast<std::uint32_t>(size), 0, small};
}

class PageCodecsZstd : public ::testing::Test {
 protected:
  void SetUp() override {
    if (site_of_page() == nullptr) GTEST_SKIP() << "scripts/checks/page.sh runs this with a site";
  }
};

TEST_F(PageCodecsZstd, UnpacksWhatZstdPacks) {
  std::mt19937 random(7);
  std::vector<Bytes> wanted;
  std::vector<Asked> all;
  for (int n = 0; n < 400; ++n) {
    wanted.push_back(
        made(n % 6, n < 100 ? static_cast<std::size_t>(n) : random() % 300'000, random));
    all.push_back(asked(packed(wanted.back(), 1 + n % 12, n % 3 == 0), wanted.back().size()));
  }
  const std::vector<Answer> back = ask_page(all);
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    ASSERT_TRUE(back[n].good) << n;
    ASSERT_EQ(back[n].bytes, wanted[n]) << n;
  }
}

TEST_F(PageCodecsZstd, RefusesAnotherSize) {
  std::mt19937 random(1);
  const Bytes bytes = made(2, 5000, random), small = packed(bytes, 3);
  const std::vector<Answer> back =
      ask_page({asked(small, bytes.size() - 1), asked(small, bytes.size() + 1), asked({}, 1),
                asked(small, UINT32_MAX), asked(small, bytes.size())});
  for (std::size_t n = 0; n < 4; ++n) EXPECT_FALSE(back[n].good) << n;
  EXPECT_TRUE(back[4].good);
}

TEST_F(PageCodecsZstd, DamagedBytesGiveNoMoreThanTheSize) {
  std::mt19937 random(3);
  std::vector<Asked> all;
  for (int n = 0; n < 2000; ++n) {
    const Bytes bytes = made(n % 6, 1 + random() % 4000, random);
    Bytes small = packed(bytes, 1 + n % 12);
    if (n % 4 == 0)
      small.resize(random() % small.size());
    else
      small[random() % small.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    all.push_back(asked(small, bytes.size()));
  }
  const std::vector<Answer> back = ask_page(all);
  std::size_t refused = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    refused += back[n].good ? 0 : 1;
    if (back[n].good) {
      EXPECT_EQ(back[n].bytes.size(), all[n].columns);
    }
    if (n % 4 == 0) {
      EXPECT_FALSE(back[n].good) << n;  // it is cut off
    }
  }
  EXPECT_GT(refused, 500U);
}

}  // namespace
}  // namespace burr::web
