// rt/changed_bits.h - one bit per item: which items changed since the reader last looked.
//
// Guarantee: mark() and take_all() are wait-free. An item marked twice before it is taken is
// reported once. Thread: any number of writers, one reader per object (one object per consumer).
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "burr/rt/atoms.h"
#include "burr/rt/rt.h"

namespace burr::rt {

template <class Atoms>
class ChangedBitsOf {
 public:
  explicit ChangedBitsOf(std::size_t count)
      : words_((count + 63) / 64), bits_(std::make_unique<Word[]>(words_)) {}

  // release: the reader that takes the bit sees everything written before mark()
  void mark(std::size_t index) BURR_RT {
    bits_[index / 64].fetch_or(1ULL << (index % 64), std::memory_order_release);
  }

  // Calls found(index) for each marked item and clears its mark. Bounded by the number of words.
  template <class Found>
  void take_all(Found&& found) {
    for (std::size_t w = 0; w < words_; ++w) {
      if (bits_[w].load(std::memory_order_relaxed) == 0) continue;
      std::uint64_t word = bits_[w].exchange(0, std::memory_order_acquire);
      for (; word != 0; word &= word - 1)
        found(w * 64 + static_cast<std::size_t>(std::countr_zero(word)));
    }
  }

 private:
  using Word = typename Atoms::template Atomic<std::uint64_t>;

  std::size_t words_;
  std::unique_ptr<Word[]> bits_;
};

using ChangedBits = ChangedBitsOf<StdAtoms>;

}  // namespace burr::rt
