// base/hash.h - a fast 64-bit hash to compare data bit by bit; not for cryptography.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace burr::base {

// The bits of a number, as std::bit_cast gives them, which not every standard library has yet.
[[nodiscard]] constexpr std::uint64_t bits_of(double value) noexcept {
  return __builtin_bit_cast(std::uint64_t, value);
}
[[nodiscard]] constexpr std::uint32_t bits_of(float value) noexcept {
  return __builtin_bit_cast(std::uint32_t, value);
}

// Mixes one word into a running hash (the finaliser of SplitMix64, Steele et al. 2014).
// Allocation-free.
constexpr std::uint64_t mix(std::uint64_t hash, std::uint64_t word) noexcept {
  std::uint64_t z = hash + 0x9e3779b97f4a7c15ULL + word;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}
inline std::uint64_t mix(std::uint64_t hash, double value) noexcept {
  return mix(hash, bits_of(value));
}
inline std::uint64_t mix(std::uint64_t hash, std::span<const std::uint64_t> words) noexcept {
  for (const std::uint64_t word : words) hash = mix(hash, word);
  return hash;
}

}  // namespace burr::base
