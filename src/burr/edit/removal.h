// edit/removal.h - how much bone a turning burr takes per second: the energy law.
//
//     MRR = min( eta mu_c F_n w r_eff,  P_max ) / u         [m^3/s]
//
// Friction power at the contact, over the energy a volume of this tissue costs to cut (Agus et al.
// 2003; Preston; Archard; algorithms.md 3e level 1). r_eff = r sin(theta), theta between the burr's
// axis and the contact normal: the pole of a burr cuts least. No push, no speed: no cut. Thread:
// servo. Units: SI.
#pragma once

#include <algorithm>

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::edit {

struct RemovalSettings {
  double friction = 0.4;  // mu_c of cutting                                            [-]
  double max_power = 60;  // of the motor at the burr                                   [W]
  double pole = 0.15;     // least sin(theta)                                           [-]
};

// Power that goes into cutting [W].  normal: unit contact normal; axis: unit, of the burr; force_n
// [N]; speed [rad/s]
[[nodiscard]] inline double cutting_power(double force_n, double speed, double radius,
                                          double efficiency, const math::Vec3& normal,
                                          const math::Vec3& axis,
                                          const RemovalSettings& settings) BURR_RT {
  const double sine = std::max(normal.cross(axis).norm(), settings.pole);
  const double power = efficiency * settings.friction * force_n * speed * radius * sine;
  return std::clamp(power, 0.0, settings.max_power);
}

}  // namespace burr::edit
