// haptics/safety/limit.h - the last word before the hand: whatever was computed, this is what may be sent.
//
//     state       not finite, hand lost, leap -> fade to zero -> waiting
//                 waiting -> small force seen -> start ramp -> running
//     magnitude   device, user and the motors' heat budget, direction kept
//     growth      slew bound
//
// In this order and after everything else (docs/safety.md, "Limits"). Fading is linear and done 5
// ms after detection; the way back is always waiting and the start ramp. Nothing here repeats a
// last force or drops it at once on its own.
//
// A torque is bounded as the force is, in the same proportion to what the device can: in half the
// user's force there is half the torque, and one grows as fast as the other.
//
// Thread: servo. Frame: any one. Units: SI. Memory: none.
#pragma once

#include <cstdint>

#include "burr/device/hand.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct LimitSettings {
  double user_force = 3.3;    // the user's own maximum                                     [N]
  double slew = 300;          // fastest growth of the force                              [N/s]
  double ramp_slew = 60;      // the same during the start ramp                           [N/s]
  double ramp_time = 0.5;     // how long the start ramp lasts                              [s]
  double small_force = 0.05;  // engaged only once the computed force has been this small   [N]
  double fade_time = 5e-3;    // from detection to zero                                     [s]
  // of the hand in one tick; beyond, the reading is not believed  [m]
  double longest_leap = 20e-3;
};

class ForceLimit {
 public:
  ForceLimit(const device::DeviceSpec& device, const LimitSettings& settings);

  // What may be sent this tick. `wanted` may be anything, NaN too. dt > 0: this tick [s]. Adds to
  // `flags` (rt/flags.h).
  [[nodiscard]] math::Vec3 apply(const math::Vec3& wanted, double dt, std::uint32_t& flags) BURR_RT;

  // The torque of the same tick, after apply(); none where the device has none [N m].
  [[nodiscard]] math::Vec3 apply_torque(const math::Vec3& wanted, double dt,
                                        std::uint32_t& flags) BURR_RT;

  // Judges the hand's reading before touch uses it: false, and the force starts to fade, if it is
  // lost, not finite, or leapt. The first reading after a fault or start is always a beginning,
  // never a leap.
  [[nodiscard]] bool believe(const device::HandState& hand, std::uint32_t& flags) BURR_RT;

  // Ticks were lost, or the device was: fade what is left, then wait for a small force and ramp up.
  void fault(std::uint32_t flag, std::uint32_t& flags) BURR_RT;

  // The hand was lifted on purpose: as a fault, without being one.
  void lift() BURR_RT;

  // The force is already zero at the device (the watchdog faded it): wait and ramp up.
  void restart() BURR_RT;

  void set_user_force(double newton) BURR_RT;
  [[nodiscard]] bool engaged() const BURR_RT {
    return state_ == State::ramp || state_ == State::running;
  }
  // of the motors above what is bearable  [N^2 s]
  [[nodiscard]] double heat() const BURR_RT { return force_.heat; }

 private:
  enum class State { waiting, ramp, running, fading };

  // What goes to one set of motors [N].
  struct Channel {
    math::Vec3 sent = math::Vec3::Zero(), fading_from = math::Vec3::Zero();
    double heat = 0;  // [N^2 s]
  };
  [[nodiscard]] double left() const BURR_RT;  // of what fades, 1..0
  [[nodiscard]] math::Vec3 bound(Channel& channel, const math::Vec3& wanted, double dt,
                                 std::uint32_t& flags) const BURR_RT;

  device::DeviceSpec device_;
  LimitSettings settings_;
  double lever_ = 0;  // a torque over it is counted as a force                             [m]
  State state_ = State::waiting;
  double in_state_ = 0;  // [s]
  Channel force_, torque_;
  math::Vec3 last_hand_ = math::Vec3::Zero();
  bool has_last_hand_ = false;
};

}  // namespace burr::haptics
