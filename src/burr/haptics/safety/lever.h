// haptics/safety/lever.h - how stiff a spring at the tip of a tool may be that a hand holds far
// behind, and how a wrench is limited without becoming one that no contact gives.
//
// A force at the tip turns the wrist by its lever l, so it loads the wrist's damping as well. With a
// spring k_t on the tip's place and k_r on its direction, both held for a tick of length T, the
// motion in a plane dies away while
//
//     k_t <= B (C - k_r) / (C - k_r + B l^2),   that is  1/k_t >= 1/B + l^2 / (C - k_r)
//     B = b / (T/2 + t_d),   C = c / (T/2 + t_d)
//
// b and c are the damping of the device in translation and in rotation, t_d the delay from reading
// to force beyond the held tick. For l = 0 it is the border of one axis, 2 b / T (stability.h).
// Derived from the eigenvalues of D^-1/2 K D^-1/2 <= 2 / T, with K the stiffness of the tip seen at
// the wrist and D the damping (docs/understand/safety.md, "A lever"). A device whose turning is not
// actuated gets force only and has no lever: k_t <= B.
//
// Thread: any, also in the tick. Units: SI. Memory: none.
#pragma once

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct Wrist {
  double damping = 0.5;     // b [N s/m]
  double turn_damping = 0;  // c [N m s/rad]; 0: turning is not actuated
  double delay = 0;         // t_d [s]
  double rate_hz = 1000;    // of the ticks
};

// The stiffest k_t for a spring k_r [N m/rad] and a lever [m]; 0: k_r alone is too stiff.  [N/m]
[[nodiscard]] double stiffest_at_lever(const Wrist& wrist, double turn_stiffness,
                                       double lever) BURR_RT;

// Springs for a device: k_r is a third of what turning allows or the wanted one, whichever is less;
// k_t the wanted one or 0.7 of the border, whichever is less.
struct LeverSprings {
  double stiffness = 0;       // k_t [N/m]
  double turn_stiffness = 0;  // k_r [N m/rad]
  double border = 0;          // of k_t at this k_r [N/m]
};
[[nodiscard]] LeverSprings springs_at_lever(const Wrist& wrist, double wanted_stiffness,
                                            double wanted_turn_stiffness, double lever);

// A force with its torque about one place.
struct Wrench {
  math::Vec3 force = math::Vec3::Zero();   // [N]
  math::Vec3 torque = math::Vec3::Zero();  // [N m]
};
// The same about another place, which is `by` away from the first.
[[nodiscard]] Wrench moved(const Wrench& wrench, const math::Vec3& by) BURR_RT;
// Both scaled by one factor, so that neither is above its limit: the line along which the force acts
// stays where it was. A torque limited alone would leave a force without its lever. Not finite: zero.
[[nodiscard]] Wrench limited(const Wrench& wrench, double most_force, double most_torque) BURR_RT;

}  // namespace burr::haptics
