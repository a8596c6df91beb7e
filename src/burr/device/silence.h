// device/silence.h - for how long a wire has listened, and for how long in vain.
//
//     silence.ended(now);                          // a reading has come
//     if (silence.lasts(now)) return Read::lost;   // none has
//
// A machine that stood still meanwhile has not listened: what its device said is still on its way,
// so of the time between two calls no more than one reading's counts. Times are of a clock that
// never goes back. Thread: its wire's.
#pragma once

#include <algorithm>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::device {

class Listened {
 public:
  static constexpr std::int64_t kOneReadingNs = 10'000'000;  // readings wait for 2 ms each

  void begin(std::int64_t now_ns) BURR_RT {
    so_far_ns_ = 0;
    asked_ns_ = now_ns;
  }
  // After every reading.
  [[nodiscard]] std::int64_t until(std::int64_t now_ns) BURR_RT {
    so_far_ns_ += std::min(now_ns - asked_ns_, kOneReadingNs);
    asked_ns_ = now_ns;
    return so_far_ns_;
  }

 private:
  std::int64_t so_far_ns_ = 0, asked_ns_ = 0;
};

class Silence {
 public:
  static constexpr std::int64_t kLongestNs = 200'000'000;  // then nobody is there any more

  // Something has come, or one begins to listen.
  void ended(std::int64_t now_ns) BURR_RT { listened_.begin(now_ns); }
  // After a reading that brought nothing: whether that has been so for too long.
  [[nodiscard]] bool lasts(std::int64_t now_ns) BURR_RT {
    return listened_.until(now_ns) >= kLongestNs;
  }

 private:
  Listened listened_;
};

}  // namespace burr::device
