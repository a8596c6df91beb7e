// rt/ring.h - a queue of fixed size from one writer to one reader, in order.
//
// Guarantee: push() and pop() are wait-free. A full ring refuses and counts: nothing waits, nothing
// is lost unseen. Thread: exactly one writer thread, exactly one reader thread. Memory: taken at
// construction.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/base/check.h"
#include "burr/rt/rt.h"

namespace burr::rt {

template <class T>
class Ring {
 public:
  // capacity: rounded up to a power of two
  explicit Ring(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {
    BURR_CHECK(capacity > 0);
  }

  // writer: false when full; the row is then counted in dropped()
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

  // reader: false when empty
  bool pop(T& out) BURR_RT {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    out = slots_[tail & mask_];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  // any thread; a snapshot
  [[nodiscard]] std::size_t size() const BURR_RT {
    return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::size_t capacity() const BURR_RT { return slots_.size(); }
  [[nodiscard]] std::uint64_t dropped() const BURR_RT {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  std::vector<T> slots_;
  std::size_t mask_;
  alignas(64) std::atomic<std::size_t> head_ = 0;  // next to write
  alignas(64) std::atomic<std::size_t> tail_ = 0;  // next to read
  alignas(64) std::atomic<std::uint64_t> dropped_ = 0;
};

}  // namespace burr::rt
