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

// One object of a block that nobody declared atomic, relaxed. Not std::atomic_ref: not every
// standard library has it yet.
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

  // one word of a block that nobody declared atomic; relaxed
  static void store(std::uint64_t& word, std::uint64_t value) BURR_RT {
    store_relaxed(word, value);
  }
  [[nodiscard]] static std::uint64_t load(const std::uint64_t& word) BURR_RT {
    return load_relaxed(word);
  }
};

}  // namespace burr::rt
