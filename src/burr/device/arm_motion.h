// device/arm_motion.h - how a hand of mass on a spring and a damper moves while its goal moves.
//
// Thread: servo. Frame: world. Units: SI. No allocation.
#pragma once

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::device {

struct ArmSettings {
  double mass = 0.1;       // [kg]
  double damping = 10;     // [N s/m]
  double stiffness = 500;  // [N/m]; infinity: rigid
};

struct ArmMotion {
  math::Vec3 position = math::Vec3::Zero(), velocity = math::Vec3::Zero();

  // The goal goes from one place to another within dt; push: the force on the hand  [N].
  void follow(const ArmSettings& arm, const math::Vec3& from, const math::Vec3& to,
              const math::Vec3& push, double dt) BURR_RT {
    // semi-implicit Euler in four substeps: stable while stiffness / mass * (dt/4)^2 < 4
    constexpr int kSteps = 4;
    const double step = dt / kSteps;
    const math::Vec3 pace = (to - from) / dt;
    for (int i = 1; i <= kSteps; ++i) {
      const math::Vec3 aim = from + pace * (step * i);
      const math::Vec3 pull = arm.stiffness * (aim - position) + arm.damping * (pace - velocity);
      velocity += (pull + push) * (step / arm.mass);
      position += velocity * step;
    }
  }
};

}  // namespace burr::device
