// haptics/safety/watchdog.h - notices that the tick has died, and lets go of the hand.
//
// The servo beats; a guard thread polls about every millisecond and multiplies what the device is
// pushing by scale(). Once tripped it stays at zero until the servo is back and has put its own
// force through the start ramp (rearm()). Time comes from outside, so tests run it on a virtual
// clock. All that stops a force: docs/safety.md, "Ticks that stop".
//
// Thread: beat(), rearm() servo; poll() guard. Wait-free.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::haptics {

class Watchdog {
 public:
  // timeout: no beat for this long is a loss [ns]; fade: from detection to zero [ns]
  Watchdog(std::int64_t timeout_ns, std::int64_t fade_ns)
      : timeout_ns_(timeout_ns), fade_ns_(fade_ns) {}

  void beat(std::int64_t now_ns) BURR_RT { last_beat_.store(now_ns, std::memory_order_release); }

  // What the device's present force is to be multiplied by, 0..1.
  [[nodiscard]] double poll(std::int64_t now_ns) BURR_RT {
    std::int64_t detected = detected_.load(std::memory_order_acquire);
    if (detected == kNever) {
      const std::int64_t last = last_beat_.load(std::memory_order_acquire);
      if (last == kNever || now_ns - last < timeout_ns_) return 1.0;
      detected_.store(now_ns, std::memory_order_release);
      detected = now_ns;
    }
    return std::max(0.0,
                    1.0 - static_cast<double>(now_ns - detected) / static_cast<double>(fade_ns_));
  }

  [[nodiscard]] bool tripped() const BURR_RT {
    return detected_.load(std::memory_order_acquire) != kNever;
  }

  // the servo is alive again and sends zero
  void rearm(std::int64_t now_ns) BURR_RT {
    beat(now_ns);
    detected_.store(kNever, std::memory_order_release);
  }

 private:
  static constexpr std::int64_t kNever = INT64_MIN;
  std::int64_t timeout_ns_, fade_ns_;
  std::atomic<std::int64_t> last_beat_ = kNever, detected_ = kNever;
};

}  // namespace burr::haptics
