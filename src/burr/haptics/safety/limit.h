// haptics/safety/limit.h - the last step before the device: turns whatever was computed into what
// may be sent.
//
//     state       not finite, hand lost, jump -> fade to zero -> waiting
//                 waiting -> small force seen -> start ramp -> running
//     magnitude   limits of device, user and the motors' heat budget; direction kept
//     growth      slew limit
//
// In this order, and after everything else (docs/understand/safety.md, "Limits"). Fading is linear
// and ends 5 ms after detection; afterwards always comes waiting and the start ramp. Nothing here
// repeats an old force, or drops a force at once of its own accord.
//
// A torque is limited like the force, in proportion to the device's maximum: with half of the peak
// force as the user's limit, the torque is limited to half of its peak, and it grows in the same
// proportion. The motor's twist beside a ball is limited by itself; force and torque of a contact are
// made smaller together.
//
// Thread: servo. Frame: any, but always the same. Units: SI. Memory: none.
#pragma once

#include <cstdint>

#include "burr/device/hand_state.h"
#include "burr/haptics/force_settings.h"
#include "burr/haptics/safety/lever.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

class ForceLimit {
 public:
  ForceLimit(const device::DeviceSpec& device, const LimitSettings& settings);

  // Returns the force that may be sent in this tick. `wanted` may be anything, also NaN. dt > 0:
  // this tick [s]. Adds to `flags` (rt/flags.h).
  [[nodiscard]] math::Vec3 apply(const math::Vec3& wanted, double dt, std::uint32_t& flags) BURR_RT;

  // The torque of the same tick; call after apply(). Zero if the device has no torque [N m].
  [[nodiscard]] math::Vec3 apply_torque(const math::Vec3& wanted, double dt,
                                        std::uint32_t& flags) BURR_RT;

  // Force and torque of a contact, in one call instead of the two: where either is above its limit,
  // one factor makes both smaller, so that the force still acts along its line. twist: the part of
  // the torque that is of the motor; it does not hinder the start ramp.
  [[nodiscard]] Wrench apply(const Wrench& wanted, const math::Vec3& twist, double dt,
                             std::uint32_t& flags) BURR_RT;

  // Checks the hand's reading before touch uses it. False, and the force starts to fade: the
  // reading is lost, not finite, or jumped. The first reading after a start or a fault never counts
  // as a jump.
  [[nodiscard]] bool accept_reading(const device::HandState& hand, std::uint32_t& flags) BURR_RT;

  // The hand is set down somewhere else on purpose: the next reading does not count as a jump.
  void forget_reading() BURR_RT { has_last_hand_ = false; }

  // Ticks or the device were lost: fades the force, then waits for a small force and ramps up.
  void fault(std::uint32_t flag, std::uint32_t& flags) BURR_RT;

  // The hand was lifted on purpose: the same as fault(), but without a flag.
  void lift() BURR_RT;

  // The force at the device is already zero (the watchdog faded it): waits and ramps up.
  void restart() BURR_RT;

  void set_user_force(double newton) BURR_RT;
  [[nodiscard]] bool engaged() const BURR_RT {
    return state_ == State::ramp || state_ == State::running;
  }
  // Heat of the motors above what they can bear continuously  [N^2 s]
  [[nodiscard]] double heat() const BURR_RT { return force_.heat; }

 private:
  enum class State { waiting, ramp, running, fading };

  // One set of motors: for the force or for the torque [N].
  struct Channel {
    math::Vec3 sent = math::Vec3::Zero(), fading_from = math::Vec3::Zero();
    double heat = 0;  // [N^2 s]
  };
  [[nodiscard]] double left() const BURR_RT;  // remaining share of the fade, 1..0
  // What this set of motors may give now. hot: 0..1, how far the heat limit has closed  [N]
  [[nodiscard]] double most(const Channel& channel, double& hot) const BURR_RT;
  [[nodiscard]] math::Vec3 bound(Channel& channel, const math::Vec3& wanted, double dt,
                                 std::uint32_t& flags) const BURR_RT;

  device::DeviceSpec device_;
  LimitSettings settings_;
  double lever_ = 0;  // a torque divided by it counts as a force                           [m]
  State state_ = State::waiting;
  double in_state_ = 0;  // [s]
  Channel force_, torque_;
  math::Vec3 last_hand_ = math::Vec3::Zero();
  math::Quat last_turn_ = math::Quat::Identity();
  bool has_last_hand_ = false;
};

}  // namespace burr::haptics
