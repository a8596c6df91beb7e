// device/silence.h - measures for how long a wire has listened without an answer.
//
//     silence.ended(now);                          // a reading has come
//     if (silence.lasts(now)) return Read::lost;   // none has
//
// Time in which the computer itself stood still does not count: what the device sent is still on
// its way. So between two calls at most the time of one reading counts. Times are of a clock that
// never goes back. Thread: the wire's.
#pragma once

#include <algorithm>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::device {

class ListeningTime {
 public:
  static constexpr std::int64_t kOneReadingNs = 10'000'000;  // a reading waits for 2 ms

  void begin(std::int64_t now_ns) BURR_RT {
    so_far_ns_ = 0;
    asked_ns_ = now_ns;
  }
  // Call after every reading. Returns the time listened since begin() [ns].
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
  static constexpr std::int64_t kLongestNs = 200'000'000;  // after this the device counts as lost

  // A reading has come, or listening begins.
  void ended(std::int64_t now_ns) BURR_RT { listening_time_.begin(now_ns); }
  // Call after a wait that brought no reading. True: this has lasted too long.
  [[nodiscard]] bool lasts(std::int64_t now_ns) BURR_RT {
    return listening_time_.until(now_ns) >= kLongestNs;
  }

 private:
  ListeningTime listening_time_;
};

}  // namespace burr::device
