// rt/lanes.h - arithmetic on sixteen numbers at a time, for the kernels that are compiled once per
// instruction set.
//
// With AVX-512, sixteen numbers are one register: a vector of the extensions of GCC and clang. Other
// sets need two or four registers for them (Wide). A vector of the extensions that is wider than a
// register is no substitute: where two of these are compared, chosen between or converted, g++ works
// on single numbers, and the kernels take three to six times as long. Each lane does the same
// operations on every instruction set, so the results are the same bits.
//
// Nothing here has external linkage: each kernel's translation unit gets its own copy, compiled for
// its own instruction set. Pass lanes by reference only: how they are passed by value depends on the
// instruction set.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace burr::rt::lanes {

inline constexpr int kCount = 16;

typedef std::uint16_t Shorts __attribute__((vector_size(32), may_alias));
typedef std::uint16_t EightShorts __attribute__((vector_size(16), may_alias));
typedef std::int16_t SignedShorts __attribute__((vector_size(32), may_alias));

namespace {

// The same bits as something else. (emscripten's library has no std::bit_cast.)
template <class To, class From>
[[maybe_unused, gnu::always_inline]] inline To bits_as(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

template <class Vector, class Number>
[[maybe_unused]] inline void load(const Number* from, Vector& to) noexcept {
  std::memcpy(&to, from, sizeof to);
}

template <class Vector, class Number>
[[maybe_unused]] inline void store(const Vector& from, Number* to) noexcept {
  std::memcpy(to, &from, sizeof from);
}

}  // namespace

#ifdef __AVX512F__

typedef float Floats __attribute__((vector_size(64), may_alias));
typedef std::int32_t Ints __attribute__((vector_size(64), may_alias));
typedef std::uint32_t Unsigneds __attribute__((vector_size(64), may_alias));

namespace {

inline constexpr __mmask16 kAll = 0xFFFF;

// `one` where a lane of `which` is -1, `other` where it is 0.
template <class Numbers>
[[maybe_unused]] inline Numbers choose(const Ints& which, const Numbers& one,
                                       const Numbers& other) noexcept {
  return which ? one : other;
}

// Floats to Ints: towards zero. Ints to Floats: to the nearest. Ints and Unsigneds: the same bits.
template <class To, class From>
[[maybe_unused]] inline To convert(const From& from) noexcept {
  return __builtin_convertvector(from, To);
}

}  // namespace

#else

namespace {

#ifdef __AVX2__
inline constexpr int kRegisterBytes = 32;
#else
inline constexpr int kRegisterBytes = 16;
#endif
inline constexpr int kRegisters = 64 / kRegisterBytes, kOfRegister = kCount / kRegisters;

// Once for each register. No loop: compilers would keep the numbers in memory for it.
template <class Does>
[[gnu::always_inline]] inline void each_register(const Does& does) noexcept {
  does(0);
  does(1);
  if constexpr (kRegisters == 4) {
    does(2);
    does(3);
  }
}

// Sixteen numbers in several registers, with the operators of a vector of the extensions: a number
// stands for sixteen of it; a comparison gives lanes of 0 and -1. Wide{} is zero.
template <class Number>
struct Wide {
  using Mask = Wide<std::int32_t>;
  typedef Number Register __attribute__((vector_size(kRegisterBytes)));
  Register part[kRegisters];

  Wide() = default;
  [[gnu::always_inline]] inline Wide(
      Number n) noexcept {  // NOLINT: a number stands for sixteen of it
    if constexpr (kOfRegister == 8)
      part[0] = Register{n, n, n, n, n, n, n, n};
    else
      part[0] = Register{n, n, n, n};
    each_register([&](int r) { part[r] = part[0]; });
  }

  // slow: through memory
  Number& operator[](int lane) noexcept { return reinterpret_cast<Number*>(part)[lane]; }
  const Number& operator[](int lane) const noexcept {
    return reinterpret_cast<const Number*>(part)[lane];
  }

  template <class To, class Does>
  [[gnu::always_inline]] static To made_of(const Does& does) noexcept {
    To to;
    each_register([&](int r) { to.part[r] = does(r); });
    return to;
  }

#define BURR_WIDE(RESULT, OPERATOR)                                                       \
  [[gnu::always_inline]] friend inline RESULT operator OPERATOR(const Wide& a,            \
                                                                const Wide& b) noexcept { \
    return made_of<RESULT>([&](int r) { return a.part[r] OPERATOR b.part[r]; });          \
  }
  BURR_WIDE(Wide, +)
  BURR_WIDE(Wide, -)
  BURR_WIDE(Wide, *)
  BURR_WIDE(Wide, /)
  BURR_WIDE(Wide, &)
  BURR_WIDE(Wide, |)
  BURR_WIDE(Mask, <)
  BURR_WIDE(Mask, >)
  BURR_WIDE(Mask, <=)
  BURR_WIDE(Mask, >=)
  BURR_WIDE(Mask, ==)
  BURR_WIDE(Mask, !=)
#undef BURR_WIDE

  [[gnu::always_inline]] inline Wide operator-() const noexcept {
    return made_of<Wide>([&](int r) { return -part[r]; });
  }
  [[gnu::always_inline]] inline Wide operator~() const noexcept {
    return made_of<Wide>([&](int r) { return ~part[r]; });
  }
  [[gnu::always_inline]] inline Wide operator<<(int bits) const noexcept {
    return made_of<Wide>([&](int r) { return part[r] << bits; });
  }
  [[gnu::always_inline]] inline Wide operator>>(int bits) const noexcept {
    return made_of<Wide>([&](int r) { return part[r] >> bits; });
  }
  [[gnu::always_inline]] inline Wide& operator+=(const Wide& b) noexcept {
    return *this = *this + b;
  }
  [[gnu::always_inline]] inline Wide& operator-=(const Wide& b) noexcept {
    return *this = *this - b;
  }
  [[gnu::always_inline]] inline Wide& operator*=(const Wide& b) noexcept {
    return *this = *this * b;
  }
  [[gnu::always_inline]] inline Wide& operator|=(const Wide& b) noexcept {
    return *this = *this | b;
  }
};

using Floats = Wide<float>;
using Ints = Wide<std::int32_t>;
using Unsigneds = Wide<std::uint32_t>;

// register by register: a copy of 64 bytes would keep the numbers in memory
template <class Number, class From>
[[maybe_unused, gnu::always_inline]] inline void load(const From* from, Wide<Number>& to) noexcept {
  each_register(
      [&](int r) { std::memcpy(&to.part[r], from + r * kOfRegister, sizeof to.part[r]); });
}

template <class Number, class To>
[[maybe_unused, gnu::always_inline]] inline void store(const Wide<Number>& from, To* to) noexcept {
  each_register(
      [&](int r) { std::memcpy(to + r * kOfRegister, &from.part[r], sizeof from.part[r]); });
}

// `one` where a lane of `which` is -1, `other` where it is 0.
template <class Number>
[[maybe_unused, gnu::always_inline]] inline Wide<Number> choose(
    const Ints& which, const Wide<Number>& one, const Wide<Number>& other) noexcept {
  using Numbers = Wide<Number>;
  return Numbers::template made_of<Numbers>(
      [&](int r) { return which.part[r] ? one.part[r] : other.part[r]; });
}

// Floats to Ints: towards zero. Ints to Floats: to the nearest. Ints and Unsigneds: the same bits.
template <class To, class From>
[[maybe_unused, gnu::always_inline]] inline To convert(const From& from) noexcept {
  return To::template made_of<To>(
      [&](int r) { return __builtin_convertvector(from.part[r], typename To::Register); });
}

}  // namespace

#endif

namespace {

[[maybe_unused]] inline void root(Floats& v) noexcept {
#if defined __AVX512F__
  alignas(64) float each[kCount];
  store(v, each);
  for (float& one : each) one = std::sqrt(one);
  load(each, v);
#elif defined __AVX2__
  each_register([&](int r) { v.part[r] = _mm256_sqrt_ps(v.part[r]); });
#elif defined __x86_64__
  each_register([&](int r) { v.part[r] = _mm_sqrt_ps(v.part[r]); });
#else
  each_register([&](int r) {
    for (int l = 0; l < kOfRegister; ++l) v.part[r][l] = std::sqrt(v.part[r][l]);
  });
#endif
}

// For lanes that are 0 or -1: one bit per lane, set for -1; the first lane is the lowest bit.
[[maybe_unused]] inline unsigned bits_of(const Ints& lanes) noexcept {
#if defined __AVX512F__
  __m512i v;
  std::memcpy(&v, &lanes, sizeof v);
  return _mm512_test_epi32_mask(v, v);
#elif defined __x86_64__
  unsigned bits = 0;
  each_register([&](int r) {
#ifdef __AVX2__
    const int some = _mm256_movemask_ps(bits_as<__m256>(lanes.part[r]));
#else
    const int some = _mm_movemask_ps(bits_as<__m128>(lanes.part[r]));
#endif
    bits |= static_cast<unsigned>(some) << kOfRegister * r;
  });
  return bits;
#else
  unsigned bits = 0;
  for (int l = 0; l < kCount; ++l) bits |= (static_cast<unsigned>(lanes[l]) & 1U) << l;
  return bits;
#endif
}

// The highest bits of sixteen numbers; the first number is the lowest bit.
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

// Is any lane -1?
[[maybe_unused]] inline bool any(const Ints& lanes) noexcept { return bits_of(lanes) != 0; }

// Is any bit of any lane set?
[[maybe_unused]] inline bool any(const Shorts& lanes) noexcept {
#ifdef __AVX2__
  __m256i v;
  std::memcpy(&v, &lanes, sizeof v);
  return _mm256_testz_si256(v, v) == 0;
#else
  std::uint64_t words[4];
  std::memcpy(words, &lanes, sizeof words);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
#endif
}

// Lanes of 16 bits to 32 bits, and back (keeping the low half). __builtin_convertvector gives the
// same, but compilers make slower code of it. (With AVX-512 the masked form is used because g++ 12
// warns about undefined lanes in the unmasked one.)
[[maybe_unused]] inline void widen(const Shorts& from, Ints& to) noexcept {
#if defined __AVX512F__
  __m256i v;
  std::memcpy(&v, &from, sizeof v);
  const __m512i wide = _mm512_maskz_cvtepu16_epi32(kAll, v);
  std::memcpy(&to, &wide, sizeof to);
#elif defined __AVX2__
  const auto v = bits_as<__m256i>(from);
  to.part[0] = bits_as<Ints::Register>(_mm256_cvtepu16_epi32(_mm256_castsi256_si128(v)));
  to.part[1] = bits_as<Ints::Register>(_mm256_cvtepu16_epi32(_mm256_extracti128_si256(v, 1)));
#else
  const EightShorts none = {};
  EightShorts half[2];
  std::memcpy(half, &from, sizeof half);
  for (int h = 0; h < 2; ++h) {  // low halves first, as memory has them on all our processors
    to.part[2 * h] =
        bits_as<Ints::Register>(__builtin_shufflevector(half[h], none, 0, 8, 1, 9, 2, 10, 3, 11));
    to.part[2 * h + 1] =
        bits_as<Ints::Register>(__builtin_shufflevector(half[h], none, 4, 12, 5, 13, 6, 14, 7, 15));
  }
#endif
}
[[maybe_unused]] inline void widen(const SignedShorts& from, Ints& to) noexcept {
#if defined __AVX512F__
  __m256i v;
  std::memcpy(&v, &from, sizeof v);
  const __m512i wide = _mm512_maskz_cvtepi16_epi32(kAll, v);
  std::memcpy(&to, &wide, sizeof to);
#elif defined __AVX2__
  const auto v = bits_as<__m256i>(from);
  to.part[0] = bits_as<Ints::Register>(_mm256_cvtepi16_epi32(_mm256_castsi256_si128(v)));
  to.part[1] = bits_as<Ints::Register>(_mm256_cvtepi16_epi32(_mm256_extracti128_si256(v, 1)));
#else
  Shorts raw;
  std::memcpy(&raw, &from, sizeof raw);
  widen(raw, to);
  to = to << 16 >> 16;
#endif
}
template <class Narrow>
[[maybe_unused]] inline void narrow(const Ints& from, Narrow& to) noexcept {
#if defined __AVX512F__
  __m512i v;
  std::memcpy(&v, &from, sizeof v);
  const __m256i half = _mm512_maskz_cvtepi32_epi16(kAll, v);
  std::memcpy(&to, &half, sizeof to);
#elif defined __AVX2__
  const Ints low = from & 0xFFFF;
  const __m256i packed =
      _mm256_packus_epi32(bits_as<__m256i>(low.part[0]), bits_as<__m256i>(low.part[1]));
  const __m256i in_order = _mm256_permute4x64_epi64(packed, 0xD8);  // packs go within halves
  std::memcpy(&to, &in_order, sizeof to);
#else
  EightShorts half[2];
  for (int h = 0; h < 2; ++h)
    half[h] = __builtin_shufflevector(bits_as<EightShorts>(from.part[2 * h]),
                                      bits_as<EightShorts>(from.part[2 * h + 1]), 0, 2, 4, 6, 8, 10,
                                      12, 14);
  std::memcpy(&to, half, sizeof to);
#endif
}

// The least of all lanes. Any number where a lane is not a number.
[[maybe_unused]] inline float least(const Floats& v) noexcept {
#ifdef __x86_64__
#ifdef __AVX2__
  __m256 halves[2];
  std::memcpy(halves, &v, sizeof halves);
  const __m256 half = _mm256_min_ps(halves[0], halves[1]);
  __m128 few = _mm_min_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
#else
  __m128 few = _mm_min_ps(_mm_min_ps(v.part[0], v.part[1]), _mm_min_ps(v.part[2], v.part[3]));
#endif
  few = _mm_min_ps(few, _mm_movehl_ps(few, few));
  few = _mm_min_ss(few, _mm_shuffle_ps(few, few, 1));
  return _mm_cvtss_f32(few);
#else
  float least = v[0];
  for (int l = 1; l < kCount; ++l) least = v[l] < least ? v[l] : least;
  return least;
#endif
}

#if defined __AVX2__ && !defined __AVX512F__
// For each set of eight lanes: their numbers, in order and without gaps.
inline constexpr auto kPacked = [] {
  std::array<std::array<std::uint8_t, 8>, 256> packed{};
  for (unsigned which = 0; which < 256; ++which) {
    unsigned at = 0;
    for (unsigned lane = 0; lane < 8; ++lane)
      if ((which >> lane & 1U) != 0) packed[which][at++] = static_cast<std::uint8_t>(lane);
  }
  return packed;
}();
#endif

// Writes the lanes whose bit is set in `which` to `to`, in order and without gaps. `to` must have
// room for sixteen numbers; those after the written ones are undefined.
[[maybe_unused]] inline void pack(const Floats& from, unsigned which, float* to) noexcept {
#if defined __AVX512F__
  __m512 v;
  std::memcpy(&v, &from, sizeof v);
  // first into a register: on some processors compressing straight into memory takes a hundred
  // times as long
  _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(which), v));
#elif defined __AVX2__
  each_register([&](int r) {
    const unsigned some = which >> 8 * r & 0xFFU;
    __m128i order;
    order = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kPacked[some].data()));
    const __m256 packed =
        _mm256_permutevar8x32_ps(bits_as<__m256>(from.part[r]), _mm256_cvtepu8_epi32(order));
    _mm256_storeu_ps(to, packed);
    to += std::popcount(some);
  });
#else
  alignas(64) float each[kCount];
  store(from, each);
  for (; which != 0; which &= which - 1) *to++ = each[std::countr_zero(which)];
#endif
}

// For templates that are for one number or for sixteen (tool/shape_formulas.h).
struct SixteenNumbers {
  using Number = Floats;
  using Real = float;
  using Whole = Ints;
  static void square_root(Number& v) noexcept { root(v); }
  template <class Numbers>
  static Numbers choose(const Whole& which, const Numbers& one, const Numbers& other) noexcept {
    return lanes::choose(which, one, other);
  }
  static Whole whole(const Number& v) noexcept { return convert<Whole>(v); }
  static Number number(const Whole& v) noexcept { return convert<Number>(v); }
};

}  // namespace
}  // namespace burr::rt::lanes
