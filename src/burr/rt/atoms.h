// rt/atoms.h - what the doors between threads are made of: the atomics of the standard.
//
// A parameter of every door (ring.h, latest.h, changed_bits.h, versioned.h), so that a test can put
// other atomics in their place: some that dawdle between any two steps, some that try every order
// of them (tests/rt/explore.h). The program uses these.
#pragma once

#include <atomic>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::rt {

struct StdAtoms {
  template <class Value>
  using Atomic = std::atomic<Value>;

  static void fence(std::memory_order order) BURR_RT { std::atomic_thread_fence(order); }

  // one word of a block that nobody declared atomic; relaxed
  static void store(std::uint64_t& word, std::uint64_t value) BURR_RT {
    std::atomic_ref<std::uint64_t>(word).store(value, std::memory_order_relaxed);
  }
  [[nodiscard]] static std::uint64_t load(const std::uint64_t& word) BURR_RT {
    // atomic_ref wants a non-const object; it is only read
    return std::atomic_ref<std::uint64_t>(const_cast<std::uint64_t&>(word))
        .load(std::memory_order_relaxed);
  }
};

}  // namespace burr::rt
