// device/device.h - a hand on the other side: a haptic device, a simulated arm, a recording.
//
//     open -> [ state -> write_force ] at every tick -> close
//
// Thread: open/close on main; state/write_force only on the servo thread, allocation-free and
// wait-free. Errors: open() says in one sentence what is missing and what to do; in the tick a lost
// hand is `valid = false`.
#pragma once

#include "burr/base/result.h"
#include "burr/device/hand.h"
#include "burr/rt/rt.h"

namespace burr::device {

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

  // Pushes the hand; world, at the tip [N]. Already bounded by haptics/limit.h.
  virtual void write_force(const math::Vec3& force) BURR_RT = 0;

  // The tick has died: multiply whatever is being pushed by scale, 0..1, until the next
  // write_force(). Any thread.
  virtual void hold(double scale) BURR_RT { static_cast<void>(scale); }

  // A hand that follows a script has an end; others never do.
  [[nodiscard]] virtual bool finished() const BURR_RT { return false; }
};

}  // namespace burr::device
