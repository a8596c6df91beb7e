// rt/latest.h - the newest value of something, from one writer to one reader; older ones are simply
// gone.
//
// A triple buffer. Guarantee: publish() and take() are wait-free; neither ever sees a half-written
// value. Thread: exactly one writer thread, exactly one reader thread. Memory: none taken after
// construction.
#pragma once

#include <array>
#include <atomic>

#include "burr/rt/atoms.h"
#include "burr/rt/rt.h"

namespace burr::rt {

template <class T, class Atoms = StdAtoms>
class Latest {
 public:
  // writer: hands over a copy
  void publish(const T& value) BURR_RT {
    slots_[writing_] = value;
    const unsigned before = middle_.exchange(writing_ | kFresh, std::memory_order_acq_rel);
    writing_ = before & kIndex;
  }

  // reader: true when something newer than last time arrived; `out` is left alone otherwise
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
  unsigned writing_ = 0;                                  // the writer's own
  typename Atoms::template Atomic<unsigned> middle_ = 1;  // exchanged
  unsigned reading_ = 2;                                  // the reader's own
};

}  // namespace burr::rt
