// rt/lanes.h - arithmetic on sixteen numbers at a time, for the kernels that are compiled once per
// instruction set.
//
// Uses the vector extensions of GCC and clang, which the compiler turns into one, two or four
// registers. The same arithmetic written as loops takes up to three times as long, because sums of
// many lanes then live in memory. Each lane does the same operations on every instruction set, so
// the results are the same bits.
//
// Nothing here has external linkage: each kernel's translation unit gets its own copy, compiled for
// its own instruction set. Pass vectors by reference only: how they are passed by value depends on
// the instruction set.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace burr::rt::lanes {

inline constexpr int kCount = 16;
#ifdef __AVX512F__
inline constexpr __mmask16 kAll = 0xFFFF;
#endif

typedef float Floats __attribute__((vector_size(64), may_alias));
typedef std::int32_t Ints __attribute__((vector_size(64), may_alias));
typedef std::uint32_t Unsigneds __attribute__((vector_size(64), may_alias));
typedef std::uint16_t Shorts __attribute__((vector_size(32), may_alias));
typedef std::uint16_t EightShorts __attribute__((vector_size(16), may_alias));
typedef std::int16_t SignedShorts __attribute__((vector_size(32), may_alias));

namespace {

template <class Vector, class Number>
[[maybe_unused]] inline void load(const Number* from, Vector& to) noexcept {
  std::memcpy(&to, from, sizeof to);
}

template <class Vector, class Number>
[[maybe_unused]] inline void store(const Vector& from, Number* to) noexcept {
  std::memcpy(to, &from, sizeof from);
}

[[maybe_unused]] inline void root(Floats& v) noexcept {
  alignas(64) float each[kCount];
  store(v, each);
  for (float& one : each) one = std::sqrt(one);
  load(each, v);
}

// For lanes that are 0 or -1: one bit per lane, set for -1; the first lane is the lowest bit.
[[maybe_unused]] inline unsigned bits_of(const Ints& lanes) noexcept {
#if defined __AVX512F__
  __m512i v;
  std::memcpy(&v, &lanes, sizeof v);
  return _mm512_test_epi32_mask(v, v);
#elif defined __AVX__
  __m256 v[2];
  std::memcpy(v, &lanes, sizeof v);
  return static_cast<unsigned>(_mm256_movemask_ps(v[0])) |
         static_cast<unsigned>(_mm256_movemask_ps(v[1])) << 8;
#elif defined __x86_64__
  __m128 v[4];
  std::memcpy(v, &lanes, sizeof v);
  unsigned bits = 0;
  for (int n = 0; n < 4; ++n) bits |= static_cast<unsigned>(_mm_movemask_ps(v[n])) << 4 * n;
  return bits;
#else
  unsigned bits = 0;
  for (int l = 0; l < kCount; ++l) bits |= (static_cast<unsigned>(lanes[l]) & 1U) << l;
  return bits;
#endif
}

// True if any bit of any lane is set; for Ints: if any lane is -1.
[[maybe_unused]] inline unsigned top_bits(const std::uint16_t* from) noexcept {
#ifdef __x86_64__
  __m128i low, high;
  std::memcpy(&low, from, sizeof low);
  std::memcpy(&high, from + 8, sizeof high);
  return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
#else
  unsigned bits = 0;
  for (int l = 0; l < kCount; ++l) bits |= static_cast<unsigned>(from[l] >> 15) << l;
  return bits;
#endif
}

// Eight words, each of two numbers: low ones in the low half, high ones in the high half.
[[maybe_unused]] inline void store_pairs(const EightShorts& low, const EightShorts& high,
                                         std::uint32_t* to) noexcept {
  store(__builtin_shufflevector(low, high, 0, 8, 1, 9, 2, 10, 3, 11), to);
  store(__builtin_shufflevector(low, high, 4, 12, 5, 13, 6, 14, 7, 15), to + 4);
}

// Is any bit of any lane set? Of Ints: is any lane -1?
template <class Vector>
[[maybe_unused]] inline bool any(const Vector& v) noexcept {
  std::uint64_t words[sizeof(Vector) / 8];
  std::memcpy(words, &v, sizeof v);
  std::uint64_t all = 0;
  for (const std::uint64_t word : words) all |= word;
  return all != 0;
}
[[maybe_unused]] inline bool any(const Ints& lanes) noexcept { return bits_of(lanes) != 0; }

[[maybe_unused]] inline bool any(const Shorts& lanes) noexcept {
#ifdef __AVX__
  __m256i v;
  std::memcpy(&v, &lanes, sizeof v);
  return _mm256_testz_si256(v, v) == 0;
#else
  return any<Shorts>(lanes);
#endif
}

// Converts lanes of 16 bits to 32 bits, and back (keeping the low half). __builtin_convertvector
// gives the same, but compilers make slower code of it. (The masked form is used because g++ 12
// warns about undefined lanes in the unmasked one.)
[[maybe_unused]] inline void widen(const Shorts& from, Ints& to) noexcept {
#ifdef __AVX512F__
  __m256i v;
  std::memcpy(&v, &from, sizeof v);
  const __m512i wide = _mm512_maskz_cvtepu16_epi32(kAll, v);
  std::memcpy(&to, &wide, sizeof to);
#else
  to = __builtin_convertvector(from, Ints);
#endif
}
[[maybe_unused]] inline void widen(const SignedShorts& from, Ints& to) noexcept {
#ifdef __AVX512F__
  __m256i v;
  std::memcpy(&v, &from, sizeof v);
  const __m512i wide = _mm512_maskz_cvtepi16_epi32(kAll, v);
  std::memcpy(&to, &wide, sizeof to);
#else
  to = __builtin_convertvector(from, Ints);
#endif
}
template <class Narrow>
[[maybe_unused]] inline void narrow(const Ints& from, Narrow& to) noexcept {
#ifdef __AVX512F__
  __m512i v;
  std::memcpy(&v, &from, sizeof v);
  const __m256i half = _mm512_maskz_cvtepi32_epi16(kAll, v);
  std::memcpy(&to, &half, sizeof to);
#else
  to = __builtin_convertvector(from, Narrow);
#endif
}

// Writes the lanes whose bit is set in `which` to `to`, in order and without gaps. `to` must have
// room for sixteen numbers; those after the written ones are undefined.
[[maybe_unused]] inline void pack(const Floats& from, unsigned which, float* to) noexcept {
#if defined __AVX512F__
  __m512 v;
  std::memcpy(&v, &from, sizeof v);
  // first into a register: on some processors compressing straight into memory takes a hundred
  // times as long
  _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(which), v));
#else
  alignas(64) float each[kCount];
  store(from, each);
  for (; which != 0; which &= which - 1) *to++ = each[std::countr_zero(which)];
#endif
}

}  // namespace
}  // namespace burr::rt::lanes
