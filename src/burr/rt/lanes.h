// rt/lanes.h - sixteen numbers at a time, for the kernels that exist once per instruction set.
//
// Vectors of the language (GCC and clang), which the compiler makes one, two or four registers of:
// written as loops the same arithmetic costs up to three times as much, because sums of many lanes
// then live in memory. Every lane does the same everywhere, so the bits cannot differ.
//
// Nothing here has external linkage: a kernel's translation unit has its own copy, in its own
// instruction set. Vectors are passed by reference only; by value their passing would depend on the
// instruction set.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace burr::rt::lanes {

inline constexpr int kCount = 16;

typedef float Floats __attribute__((vector_size(64), may_alias));
typedef std::int32_t Ints __attribute__((vector_size(64), may_alias));
typedef std::uint32_t Unsigneds __attribute__((vector_size(64), may_alias));
typedef std::uint16_t Shorts __attribute__((vector_size(32), may_alias));
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

// Is any bit of any lane set?
template <class Vector>
[[maybe_unused]] inline bool any(const Vector& v) noexcept {
  std::uint64_t words[sizeof(Vector) / 8];
  std::memcpy(words, &v, sizeof v);
  std::uint64_t all = 0;
  for (const std::uint64_t word : words) all |= word;
  return all != 0;
}

}  // namespace
}  // namespace burr::rt::lanes
