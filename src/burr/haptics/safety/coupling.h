// haptics/safety/coupling.h - the springs between the hand and a tool that touches with all its parts,
// chosen for a device that can turn the hand.
//
//     k_r = min(0.3 N m/rad, the device's table, C / 3)      C = c / (T/2)   c: measured damping
//     k_r = min(0.1 N m/rad, K (10 mm)^2)                    c and table not known: K as below
//     k_t <= 0.7 / (1/B + l^2 / (C - k_r))                   B = K / 0.7     C = 3 k_r if c unknown
//
// K is the stiffest wall of the device's table, which counts as 0.7 of the border: without a lever
// k_t is what it always was. A spring k_r is felt at r beside the axis as k_r / r^2; fingers hold a
// handle some 10 mm from its axis, so there an unknown device gets no stiffer spring than the wall
// that it is known to show. Assumed, not measured: docs/understand/safety.md, "A lever".
//
// Thread: any; also in the tick. Units: SI. Memory: none.
#pragma once

#include "burr/device/hand_state.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

struct Coupling {
  double stiffness = 0;       // k_t [N/m]
  double turn_stiffness = 0;  // k_r [N m/rad]; 0: the device cannot turn the hand
  double border = 0;          // of k_t at this k_r and lever, without the margin [N/m]
  double lever = 0;           // L = sqrt(k_r / k_t) [m]; 0: k_t or k_r is 0
  bool measured = false;      // k_r rests on the device's own numbers, not on the assumption
};

// wanted: k_t [N/m]; rate_hz: of the ticks. A device without torque gets the wanted k_t, or K.
[[nodiscard]] Coupling coupling_of(const device::DeviceSpec& device, double wanted,
                                   double rate_hz) BURR_RT;

}  // namespace burr::haptics
