// device/device.h - the interface of a hand: a haptic device, a simulated arm or a recording.
//
//     open -> [ state -> (write_torque) -> write_force ] at every tick -> close
//
// Thread: open(), close() on main; state(), write_torque(), write_force() only on the servo thread,
// without allocation and wait-free. Errors: open() says in one sentence what is missing and what to
// do. In the tick, a lost hand is `valid = false`.
#pragma once

#include <string>

#include "burr/base/result.h"
#include "burr/device/hand_state.h"
#include "burr/rt/clock.h"
#include "burr/rt/rt.h"
#include "burr/rt/stats.h"

namespace burr::device {

// How the readings of a link were answered with forces, and how long that took.
struct LinkStats {
  std::uint64_t readings = 0;     // readings that could begin a tick, while there are ticks
  std::uint64_t passed_over = 0;  // readings that came before the next tick was due
  std::uint64_t unanswered = 0;   // readings whose force came after the link's answer timeout
  rt::Durations answers;          // time from reading to force, of all that could begin a tick
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

  // The pose of the hand at this tick. dt: time since the last tick [s]; simulated hands advance by
  // it, real ones ignore it.
  [[nodiscard]] virtual HandState state(double dt) BURR_RT = 0;

  // Pushes the hand with this force at the tip; world frame [N]. haptics/safety/limit.h has limited
  // it.
  virtual void write_force(const math::Vec3& force) BURR_RT = 0;

  // Turns the hand about the tip; world frame [N m]. Limited likewise. Call it before the
  // write_force() with which the torque goes out; afterwards the torque is zero again. Only where
  // spec().peak_torque is above 0.
  virtual void write_torque(const math::Vec3& torque) BURR_RT { static_cast<void>(torque); }

  // The tick has stopped: multiply the present force by scale, 0..1, until the next write_force().
  // Thread: any.
  virtual void scale_force(double scale) BURR_RT { static_cast<void>(scale); }

  // The device's own clock: a tick begins with a fresh reading, and its force goes out in the same
  // exchange. nullptr: the device has none and takes any rate. Only for sessions in real time, and
  // only while the device is open.
  [[nodiscard]] virtual rt::TickClock* clock(double rate_hz) {
    static_cast<void>(rate_hz);
    return nullptr;
  }

  // From now on another device sets the pace of the ticks: the exchanges of this one do not wait
  // for them. Thread: main.
  virtual void stop_pacing() {}

  // When the reading that state() gave last arrived at this computer, CLOCK_MONOTONIC [ns]; 0: not
  // known. Thread: servo.
  [[nodiscard]] virtual std::int64_t arrived_ns() const BURR_RT { return 0; }

  // How the readings were answered, as of some tenths of a second ago. False: nothing new, or the
  // device keeps no such account. Thread: one, any.
  [[nodiscard]] virtual bool take_stats(LinkStats& newest) {
    static_cast<void>(newest);
    return false;
  }

  // What is wrong with the device now and what to do, in one sentence; empty: nothing. Thread:
  // main.
  [[nodiscard]] virtual std::string trouble() const { return {}; }

  // True when a hand that follows a script has come to its end; other hands never finish.
  [[nodiscard]] virtual bool finished() const BURR_RT { return false; }
};

}  // namespace burr::device
