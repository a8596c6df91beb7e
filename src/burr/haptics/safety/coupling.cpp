#include "burr/haptics/safety/coupling.h"

#include <algorithm>
#include <cmath>

#include "burr/haptics/safety/lever.h"

namespace burr::haptics {
namespace {

constexpr double kStiffestTurn = 0.3;  // [N m/rad]
constexpr double kUnknownTurn = 0.1;   // of a device that says nothing of turning  [N m/rad]
constexpr double kFingers = 10e-3;     // from the axis of a handle                   [m]
constexpr double kTurnShare = 1.0 / 3, kMargin = 0.7;  // of lever.h

}  // namespace

Coupling coupling_of(const device::DeviceSpec& device, double wanted, double rate_hz) BURR_RT {
  Coupling chosen;
  chosen.stiffness = std::clamp(wanted, 0.0, device.max_stiffness);
  chosen.border = device.max_stiffness / kMargin;
  if (device.peak_torque <= 0) return chosen;
  const double tick = 1 / rate_hz;
  const bool damped = device.turn_damping > 0;
  double bears = device.turn_damping / (0.5 * tick);  // C
  chosen.measured = damped || device.max_turn_stiffness > 0;
  chosen.turn_stiffness =
      chosen.measured ? kStiffestTurn
                      : std::min(kUnknownTurn, device.max_stiffness * (kFingers * kFingers));
  if (device.max_turn_stiffness > 0)
    chosen.turn_stiffness = std::min(chosen.turn_stiffness, device.max_turn_stiffness);
  if (damped) chosen.turn_stiffness = std::min(chosen.turn_stiffness, kTurnShare * bears);
  if (!damped) bears = chosen.turn_stiffness / kTurnShare;
  if (device.lever > 0) {
    const Wrist wrist = {.damping = 0.5 * tick * chosen.border,
                         .turn_damping = 0.5 * tick * bears,
                         .delay = 0,
                         .rate_hz = rate_hz};
    chosen.border = stiffest_at_lever(wrist, chosen.turn_stiffness, device.lever);
    chosen.stiffness = std::min(chosen.stiffness, kMargin * chosen.border);
  }
  if (chosen.stiffness > 0) chosen.lever = std::sqrt(chosen.turn_stiffness / chosen.stiffness);
  return chosen;
}

}  // namespace burr::haptics
