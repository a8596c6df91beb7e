// rt/latest.h - passes the newest value from one writer to one reader; older values are dropped.
//
// A triple buffer. Guarantee: publish() and take() are wait-free, and the reader never gets a
// half-written value. Thread: exactly one writer thread, exactly one reader thread. Memory:
// allocates nothing after construction.
#pragma once

#include <array>
#include <atomic>

#include "burr/rt/atoms.h"
#include "burr/rt/rt.h"

namespace burr::rt {

template <class T, class Atoms = StdAtoms>
class Latest {
 public:
  // Writer: publishes a copy of `value`.
  void publish(const T& value) BURR_RT {
    slots_[writing_] = value;
    const unsigned before = middle_.exchange(writing_ | kFresh, std::memory_order_acq_rel);
    writing_ = before & kIndex;
  }

  // Reader: true if a newer value has arrived since the last call; otherwise `out` is unchanged.
  bool take(T& out) BURR_RT {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    const unsigned before = middle_.exchange(reading_, std::memory_order_acq_rel);
    reading_ = before & kIndex;
    out = slots_[reading_];
    return true;
  }

 private:
  static constexpr unsigned kIndex = 3, kFresh = 4;
  std::array<T, 3> slots_{};
  unsigned writing_ = 0;                                  // used by the writer only
  typename Atoms::template Atomic<unsigned> middle_ = 1;  // exchanged between the two
  unsigned reading_ = 2;                                  // used by the reader only
};

}  // namespace burr::rt
