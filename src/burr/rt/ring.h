// rt/ring.h - a queue of fixed size from one writer to one reader, in order.
//
// Guarantee: push() and pop() are wait-free. A full ring refuses the value and counts it in
// dropped(): no thread waits, and every loss is counted. Thread: exactly one writer thread, exactly
// one reader thread. Memory: allocated at construction.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/base/check.h"
#include "burr/rt/atoms.h"
#include "burr/rt/rt.h"

namespace burr::rt {

template <class T, class Atoms = StdAtoms>
class Ring {
 public:
  // capacity: rounded up to a power of two
  explicit Ring(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {
    BURR_CHECK(capacity > 0);
  }

  // Writer: false if the ring is full; the value is then counted in dropped().
  bool push(const T& value) BURR_RT {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[head & mask_] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // Reader: false if the ring is empty.
  bool pop(T& out) BURR_RT {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    out = slots_[tail & mask_];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  // Any thread. A snapshot: the writer sees its own pushes exactly, the reader its own pops.
  [[nodiscard]] std::size_t size() const BURR_RT {
    // Load the tail first: it never passes a head that is loaded later. A third thread that is
    // delayed between the two loads may see a head that has moved on; hence the min().
    const std::size_t tail = tail_.load(std::memory_order_acquire);
    return std::min(head_.load(std::memory_order_acquire) - tail, slots_.size());
  }
  [[nodiscard]] std::size_t capacity() const BURR_RT { return slots_.size(); }
  [[nodiscard]] std::uint64_t dropped() const BURR_RT {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  using Index = typename Atoms::template Atomic<std::size_t>;

  std::vector<T> slots_;
  std::size_t mask_;
  alignas(64) Index head_ = 0;  // next to write
  alignas(64) Index tail_ = 0;  // next to read
  alignas(64) typename Atoms::template Atomic<std::uint64_t> dropped_ = 0;
};

}  // namespace burr::rt
