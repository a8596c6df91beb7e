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

// Relaxed atomic access to an object whose type is not atomic. std::atomic_ref is not used because
// not every standard library has it yet.
template <class Value>
void store_relaxed(Value& object, Value value) BURR_RT {
  __atomic_store_n(&object, value, __ATOMIC_RELAXED);
}
template <class Value>
[[nodiscard]] Value load_relaxed(const Value& object) BURR_RT {
  return __atomic_load_n(&object, __ATOMIC_RELAXED);
}

struct StdAtoms {
  template <class Value>
  using Atomic = std::atomic<Value>;

  static void fence(std::memory_order order) BURR_RT { std::atomic_thread_fence(order); }

  // Relaxed access to one word of a block that is not declared atomic.
  static void store(std::uint64_t& word, std::uint64_t value) BURR_RT {
    store_relaxed(word, value);
  }
  [[nodiscard]] static std::uint64_t load(const std::uint64_t& word) BURR_RT {
    return load_relaxed(word);
  }
};

}  // namespace burr::rt
