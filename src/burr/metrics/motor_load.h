// metrics/motor_load.h - how hard the bone held the motor.
//
//     slowed    time of contact with the foot on the pedal and the spindle below 0.8 of what the pedal asks for
//     stalled   time in which the bone held the spindle still (flag 17 of a tick)
//
// Torque and power are those of the session's own law of cutting, whose constants nobody has calibrated:
// for comparison between sessions only. Units: SI. Thread: one. Memory: fixed.
#pragma once

#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"

namespace burr::metrics {

inline constexpr double kSlowed = 0.8;  // share of the speed that pedal and setting command [-]

struct MotorLoad {
  double contact = 0;              // with the foot on the pedal [s]
  double slowed = 0, stalled = 0;  // [s]
  double energy = 0;               // that went into the bone [J]
  double peak_torque = 0;          // [N m]
  double peak_at = 0;              // [s]
};

class MotorLoadMaker {
 public:
  void add(const Moment& now) {
    if (!now.touching || !(now.asked_speed > 0)) return;
    found_.contact += now.dt;
    if (now.speed < kSlowed * now.asked_speed) found_.slowed += now.dt;
    if (now.stalled) found_.stalled += now.dt;
    if (now.power > 0) found_.energy += now.power * now.dt;
    if (now.torque <= found_.peak_torque) return;
    found_.peak_torque = now.torque;
    found_.peak_at = now.t;
  }
  // Not assessable: the burr never touched bone with the foot on the pedal.
  [[nodiscard]] Assessed<MotorLoad> finish() const {
    if (!(found_.contact > 0))
      return NotAssessable{"the burr never touched bone with the foot on the pedal"};
    return found_;
  }

 private:
  MotorLoad found_;
};

}  // namespace burr::metrics
