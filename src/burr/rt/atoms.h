// rt/atoms.h - the atomic operations that the doors between threads are built from.
//
// A template parameter of every door (ring.h, latest.h, changed_bits.h, versioned.h), so that a
// test can replace them: by atomics that wait at random between steps, or by atomics that try every
// order of the steps (tests/rt/explore.h). The program uses StdAtoms.
#pragma once

#include <atomic>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::rt {

struct StdAtoms {
  template <class Value>
  using Atomic = std::atomic<Value>;

  static void fence(std::memory_order order) BURR_RT { std::atomic_thread_fence(order); }

  // Relaxed access to one word of a block that is not declared atomic.
  static void store(std::uint64_t& word, std::uint64_t value) BURR_RT {
    std::atomic_ref<std::uint64_t>(word).store(value, std::memory_order_relaxed);
  }
  [[nodiscard]] static std::uint64_t load(const std::uint64_t& word) BURR_RT {
    // atomic_ref needs a non-const object; the word is only read
    return std::atomic_ref<std::uint64_t>(const_cast<std::uint64_t&>(word))
        .load(std::memory_order_relaxed);
  }
};

}  // namespace burr::rt
