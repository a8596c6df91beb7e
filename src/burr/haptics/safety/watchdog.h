// haptics/safety/watchdog.h - notices that the tick has stopped, and releases the force.
//
// The servo calls beat() in every tick. A guard thread calls poll() about every millisecond and
// multiplies the device's present force by the result. Once tripped, the scale stays at zero until
// the servo runs again and has started its own ramp from zero force (rearm()). Times are arguments,
// so tests can use a virtual clock. Everything that stops a force: docs/understand/safety.md,
// "Ticks that stop".
//
// Thread: beat() and rearm() servo; poll() guard. Wait-free.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::haptics {

class Watchdog {
 public:
  // timeout: this long without a beat is a loss [ns]; fade: time from detection to zero [ns]
  Watchdog(std::int64_t timeout_ns, std::int64_t fade_ns)
      : timeout_ns_(timeout_ns), fade_ns_(fade_ns) {}

  void beat(std::int64_t now_ns) BURR_RT { last_beat_.store(now_ns, std::memory_order_release); }

  // The factor for the device's present force, 0..1.
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

  // The servo runs again and sends zero force.
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
