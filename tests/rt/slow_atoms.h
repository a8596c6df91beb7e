// tests/rt/slow_atoms.h - slow atomics: before every step a thread may spin, yield or sleep, at
// random. Two cores then often meet in the few instructions between two steps of a door, where
// otherwise they meet once in a million.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <random>
#include <thread>

#include "burr/rt/atoms.h"

namespace burr::rt::test {

struct SlowAtoms {
  // Call once per thread, before its first step.
  static void seed(std::uint64_t value) { random().seed(value); }

  static void pause_at_random() {
    const std::uint64_t what = random()();
    if (what % 4 != 0) return;
    for (std::uint64_t n = (what >> 8) % 256; n > 0; --n)
      std::atomic_signal_fence(std::memory_order_seq_cst);
    if (what % 64 == 0) std::this_thread::yield();
    if (what % 4096 == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
  }

  template <class Value>
  class Atomic {
   public:
    Atomic(Value value = {}) : value_(value) {}  // NOLINT(google-explicit-constructor): as std's
    [[nodiscard]] Value load(std::memory_order order) const {
      pause_at_random();
      return value_.load(order);
    }
    void store(Value value, std::memory_order order) {
      pause_at_random();
      value_.store(value, order);
    }
    Value exchange(Value value, std::memory_order order) {
      pause_at_random();
      return value_.exchange(value, order);
    }
    Value fetch_add(Value value, std::memory_order order) {
      pause_at_random();
      return value_.fetch_add(value, order);
    }
    Value fetch_or(Value value, std::memory_order order) {
      pause_at_random();
      return value_.fetch_or(value, order);
    }

   private:
    std::atomic<Value> value_;
  };

  static void fence(std::memory_order order) {
    pause_at_random();
    StdAtoms::fence(order);
  }
  static void store(std::uint64_t& word, std::uint64_t value) {
    pause_at_random();
    StdAtoms::store(word, value);
  }
  static std::uint64_t load(const std::uint64_t& word) {
    pause_at_random();
    return StdAtoms::load(word);
  }

 private:
  static std::mt19937_64& random() {
    thread_local std::mt19937_64 random;
    return random;
  }
};

}  // namespace burr::rt::test
