#include "burr/record/mcap/crc32.h"

#include <zlib.h>

#ifdef __x86_64__
#include <immintrin.h>

#include <cstddef>
#endif

namespace burr::record {
namespace {

std::uint32_t by_zlib(std::uint32_t crc, ByteSpan bytes) noexcept {
  // crc32_z() takes a null pointer for the question what the start is
  return bytes.empty() ? crc
                       : static_cast<std::uint32_t>(::crc32_z(crc, bytes.data(), bytes.size()));
}

#ifdef __x86_64__

// Products without carries, 64 bytes at a time (Gopal et al., "Fast CRC computation for generic
// polynomials using PCLMULQDQ", Intel 2009). The numbers are x^n modulo the polynomial, bits
// reflected, for the n by which a step moves the bytes before it.
constexpr std::size_t kLeast = 64;  // shorter ones are not worth it [byte]

bool has_products() noexcept {
  static const bool has = [] {
    __builtin_cpu_init();
    return __builtin_cpu_supports("pclmul") != 0 && __builtin_cpu_supports("sse4.1") != 0;
  }();
  return has;
}

__attribute__((target("pclmul,sse4.1"))) __m128i folded(__m128i x, __m128i by,
                                                        __m128i next) noexcept {
  const __m128i low = _mm_clmulepi64_si128(x, by, 0x00);
  const __m128i high = _mm_clmulepi64_si128(x, by, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

// size: at least kLeast, a multiple of 16. crc: as zlib keeps it, without the inversions.
__attribute__((target("pclmul,sse4.1"))) std::uint32_t by_products(std::uint32_t crc,
                                                                   const std::uint8_t* bytes,
                                                                   std::size_t size) noexcept {
  const auto at = [&bytes](int n) __attribute__((target("pclmul,sse4.1"))) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes) + n);
  };
  const __m128i by_512 = _mm_set_epi64x(0x01c6e41596, 0x0154442bd4);
  const __m128i by_128 = _mm_set_epi64x(0x00ccaa009e, 0x01751997d0);
  const __m128i by_64 = _mm_set_epi64x(0, 0x0163cd6124);
  const __m128i last = _mm_set_epi64x(0x01f7011641, 0x01db710641);  // quotient, polynomial
  const __m128i low_32 = _mm_setr_epi32(~0, 0, ~0, 0);

  __m128i x1 = _mm_xor_si128(at(0), _mm_cvtsi32_si128(static_cast<int>(crc)));
  __m128i x2 = at(1), x3 = at(2), x4 = at(3);
  for (bytes += 64, size -= 64; size >= 64; bytes += 64, size -= 64) {
    x1 = folded(x1, by_512, at(0));
    x2 = folded(x2, by_512, at(1));
    x3 = folded(x3, by_512, at(2));
    x4 = folded(x4, by_512, at(3));
  }
  x1 = folded(x1, by_128, x2);
  x1 = folded(x1, by_128, x3);
  x1 = folded(x1, by_128, x4);
  for (; size >= 16; bytes += 16, size -= 16) x1 = folded(x1, by_128, at(0));

  // 128 bits to 64, then to 32 (Barrett)
  x1 = _mm_xor_si128(_mm_srli_si128(x1, 8), _mm_clmulepi64_si128(x1, by_128, 0x10));
  x1 = _mm_xor_si128(_mm_srli_si128(x1, 4),
                     _mm_clmulepi64_si128(_mm_and_si128(x1, low_32), by_64, 0x00));
  __m128i quotient = _mm_clmulepi64_si128(_mm_and_si128(x1, low_32), last, 0x10);
  quotient = _mm_clmulepi64_si128(_mm_and_si128(quotient, low_32), last, 0x00);
  return static_cast<std::uint32_t>(_mm_extract_epi32(_mm_xor_si128(x1, quotient), 1));
}

#endif

}  // namespace

std::uint32_t crc32(std::uint32_t crc, ByteSpan bytes) noexcept {
#ifdef __x86_64__
  if (bytes.size() >= kLeast && has_products()) {
    const std::size_t whole = bytes.size() / 16 * 16;
    crc = ~by_products(~crc, bytes.data(), whole);
    bytes = bytes.subspan(whole);
  }
#endif
  return by_zlib(crc, bytes);
}

}  // namespace burr::record
