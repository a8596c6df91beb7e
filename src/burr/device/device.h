// device/device.h - a hand on the other side: a haptic device, a simulated arm, a recording.
//
//     open -> [ state -> (write_torque) -> write_force ] at every tick -> close
//
// Thread: open/close on main; state/write_force only on the servo thread, allocation-free and
// wait-free. Errors: open() says in one sentence what is missing and what to do; in the tick a lost
// hand is `valid = false`.
#pragma once

#include <string>

#include "burr/base/result.h"
#include "burr/device/hand.h"
#include "burr/rt/clock.h"
#include "burr/rt/rt.h"
#include "burr/rt/stats.h"

namespace burr::device {

// From a reading on the wire to its force on the wire.
struct LinkAccount {
  std::uint64_t readings = 0;     // that may begin a tick, while there are ticks
  std::uint64_t passed_over = 0;  // that came before the next tick
  std::uint64_t unanswered = 0;   // whose force was not there when patience was over
  rt::Durations answers;          // of all readings that may begin a tick
};

class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  virtual Status open() = 0;
  virtual void close() = 0;
  [[nodiscard]] virtual const DeviceSpec& spec() const = 0;

  // Where the hand is at this tick. dt: since the last tick [s]; simulated hands move by it, real
  // ones ignore it.
  [[nodiscard]] virtual HandState state(double dt) BURR_RT = 0;

  // Pushes the hand; world, at the tip [N]. Already bounded by haptics/safety/limit.h.
  virtual void write_force(const math::Vec3& force) BURR_RT = 0;

  // Turns the hand about the tip; world [N m]. Bounded likewise, said before the force it goes out
  // with, and none again after that. Only where spec().peak_torque is above 0.
  virtual void write_torque(const math::Vec3& torque) BURR_RT { static_cast<void>(torque); }

  // The tick has died: multiply whatever is being pushed by scale, 0..1, until the next
  // write_force(). Any thread.
  virtual void hold(double scale) BURR_RT { static_cast<void>(scale); }

  // The pace it sets itself, so that a tick begins with a fresh reading and its force goes out with
  // the same exchange; nullptr: it takes any. Sessions by the clock only, while it is open.
  [[nodiscard]] virtual rt::TickClock* clock(double rate_hz) {
    static_cast<void>(rate_hz);
    return nullptr;
  }

  // Ticks go by another device's pace from now on: its exchanges do not wait for them. Main.
  virtual void follow() {}

  // When the reading that state() gave last reached this computer, CLOCK_MONOTONIC [ns]; 0: not
  // known. Servo.
  [[nodiscard]] virtual std::int64_t arrived_ns() const BURR_RT { return 0; }

  // How its readings were answered, as of some tenths of a second ago; false: nothing new, or it
  // does not say. One thread, any.
  [[nodiscard]] virtual bool account(LinkAccount& newest) {
    static_cast<void>(newest);
    return false;
  }

  // What is wrong with it just now and what to do, one sentence; empty: nothing. Main.
  [[nodiscard]] virtual std::string trouble() const { return {}; }

  // A hand that follows a script has an end; others never do.
  [[nodiscard]] virtual bool finished() const BURR_RT { return false; }
};

}  // namespace burr::device
