// tool/spindle.h - the motor that turns the burr: it accelerates, slows down under load, stalls,
// and turns in both directions.
//
//     J dw/dt = tau_m - tau_cut - b w,    tau_m = K (w_set - w), at most `torque` either way
//
// A speed-controlled motor behaves like a stiff spring around its set speed
// (docs/understand/cutting.md, "Spindle"): at full torque it has lost the share `droop` of the set
// speed. The bone's torque only ever brakes: where it exceeds the motor's torque, the burr stands
// still. Within a tick all torques are constant, so the step is exact, and stable however short J/K
// is.
//
// The reaction of the motor acts on the handpiece. The hand feels
//     tau_m - b w = tau_cut + J dw/dt        [N m]    about the shaft:
// the twist of the drill when it starts and when it bites, and nothing while it idles.
//
// Speeds have a sign: above 0 the burr turns clockwise seen from the hand, as drills do; below 0 it
// turns the other way. Units: SI. Thread: servo. Memory: none.
#pragma once

#include <algorithm>
#include <cmath>

#include "burr/math/elementary.h"
#include "burr/rt/rt.h"

namespace burr::tool {

// Defaults of an electric otologic handpiece; assumed, not from a manufacturer's data sheet.
struct Motor {
  double torque = 30e-3;   // largest                                           [N m]
  double droop = 0.1;      // of the set speed, at that torque; an air turbine: 0.105 [-]
  double inertia = 5e-7;   // of rotor, chuck and burr                          [kg m^2]
  double friction = 2e-7;  // b                                                 [N m s]
};

class Spindle {
 public:
  double full_speed = 0;  // with the pedal fully down                          [rad/s]
  Motor motor;

  // pedal: 0..1; cutting: braking torque of the bone, >= 0 [N m]; dt: this tick [s]
  void step(double pedal, double cutting, double dt) BURR_RT {
    const double set = full_speed * std::clamp(pedal, 0.0, 1.0);
    stalled_ = false;
    if (!(motor.torque > 0) || !(motor.inertia > 0)) {  // no motor: as commanded
      speed_ = set;
      reaction_ = std::copysign(cutting, set);
      return;
    }
    const double steep = motor.torque / std::max(std::abs(full_speed) * motor.droop, 1.0);
    const double driven = std::clamp(steep * (set - speed_), -motor.torque, motor.torque);
    reaction_ = driven - motor.friction * speed_;
    // direction of rotation, or of the next one; a standing burr is held by the bone until the
    // motor's torque is larger
    const double way = speed_ != 0 ? std::copysign(1.0, speed_) : std::copysign(1.0, driven);
    if (speed_ == 0 && std::abs(driven) <= cutting) {
      stalled_ = cutting > 0 && set != 0;
      return;
    }
    const bool whole = std::abs(driven) >= motor.torque;  // then the torque does not fall with w
    const double pull = (whole ? driven : steep * set) - way * cutting;
    const double brake = motor.friction + (whole ? 0.0 : steep);
    const double rest = brake > 0 ? pull / brake : 0;
    const double share = 1 - math::exponential(-brake * dt / motor.inertia);
    const double before = speed_;
    speed_ += brake > 0 ? (rest - speed_) * share : pull * dt / motor.inertia;
    // full torque ends where the spring characteristic begins: no overshoot past the set speed
    if (whole && (set - before) * (set - speed_) < 0) speed_ = set;
    if (before * speed_ < 0 && cutting > 0) speed_ = 0;  // the bone brakes, it does not drive
    if (set == 0 && std::abs(speed_) < 1) speed_ = 0;
    stalled_ = speed_ == 0 && cutting > 0 && set != 0;
  }

  [[nodiscard]] double speed() const BURR_RT { return speed_; }  // [rad/s]
  // Torque on the handpiece at the start of the tick; positive turns it anticlockwise seen from the
  // hand, about +z of the tool. At most the motor's torque plus its friction [N m]
  [[nodiscard]] double reaction() const BURR_RT { return reaction_; }
  [[nodiscard]] bool stalled() const BURR_RT { return stalled_; }

 private:
  double speed_ = 0;
  double reaction_ = 0;
  bool stalled_ = false;
};

}  // namespace burr::tool
