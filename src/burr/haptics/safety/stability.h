// haptics/safety/stability.h - how stiff a wall may be before the hand trembles: one axis of a device, a
// hand on it if wanted, and a wall that is sampled.
//
//     arm o--/\/\/--[ m ]--b, f_c      read: encoder step, backward difference, filter
//                     ^  force held for a tick, delay t_d later
//
// Between ticks the mass moves continuously (20 steps of the closed solution), so that the energy a
// held force brings in is there as in a real device. The known borders:
//
//     linear                              k < 2 (b + B) / T                Colgate & Schenkel 1994
//     linear, with delay                  b + B > k (T/2 + t_d)
//     with an encoder and dry friction    k <= min(2 b / T, 2 f_c / step)  Abbott & Okamura 2005
//
// For tests and for the wall a new device may show; nothing of the tick uses it. Thread: any.
// Frame: along the axis, bone below zero. Units: SI. Memory: little. Cost: 2 ms per second of hand.
#pragma once

#include <functional>

#include "burr/haptics/safety/energy_guard.h"

namespace burr::haptics {

struct AxisSettings {
  double mass = 0.045;            // of the device [kg]
  double damping = 0.5;           // b [N s/m]
  double dry_friction = 0;        // f_c [N]
  double encoder_step = 0;        // [m]; 0: as fine as a double
  double delay = 0;               // t_d, from reading to force, in steps of the integration [s]
  double rate_hz = 1000;          // of the ticks
  int substeps = 20;              // of the integration in a tick
  double velocity_filter_hz = 0;  // first order on the backward difference; 0: none
  double push = 0;                // constant, of a finger, into the bone [N]
  // an arm that holds the device: its mass moves with it, its spring pulls to zero
  double arm_mass = 0;       // [kg]
  double arm_damping = 0;    // [N s/m]
  double arm_stiffness = 0;  // [N/m]
};

// What a controller is told each tick.
struct Sensed {
  double place = 0;     // as the encoder says [m]
  double velocity = 0;  // backward difference, filtered [m/s]
  double dt = 0;        // [s]
};
using Controller = std::function<double(const Sensed&)>;  // -> force on the hand [N]

struct WallSettings {
  double stiffness = 1000;  // k [N/m]
  double damping = 0;       // B [N s/m]
  bool one_sided = false;   // only below zero, and damped only on approach, as in force_law.h;
                            // else a spring to zero, where linear theory holds
};
[[nodiscard]] Controller wall(const WallSettings& settings);
// The same with an EnergyGuard behind it. `watched`: called each tick with the guard.
[[nodiscard]] Controller guarded_wall(const WallSettings& settings,
                                      const EnergyGuardSettings& guard,
                                      std::function<void(const EnergyGuard&)> watched = {});

struct Swing {
  double start = 1e-3;  // where the hand begins [m]
  double speed = 0;     // and how fast [m/s]
  double duration = 4;  // [s]
  double too_far = 1;   // given up beyond [m]
};

// What came of it. Ranges are highest minus lowest place.
struct Swung {
  double early = 0, late = 0;  // range within the second and the last quarter of the time [m]
  double lowest = 0;           // deepest place [m]
  double largest_force = 0;    // [N]
  double top_speed = 0;        // mean of a step of the integration [m/s]
  // By the real motion between the ticks, from the first tick on [J]:
  double least_work_in = 0;  // least ever of the work that the hand did on the wall
  double work_in = 0;        // the same at the end
  bool ran_away = false;     // went too_far, or was no longer a number

  // Trembling dies away: the range of the last quarter is less than that of the second, or below
  // what an encoder of this step can tell.
  [[nodiscard]] bool stable(double quiet = 1e-9) const {
    return !ran_away && (late < early || late <= quiet);
  }
};
[[nodiscard]] Swung swing(const AxisSettings& axis, const Controller& controller,
                          const Swing& how = {});

// The stiffness between `low`, at which it is stable, and `high`, at which it is not, at which that
// changes, to 1 part in 1000. `make` gives the controller for a stiffness. Returns `low` or `high`
// where there is no change between them.
[[nodiscard]] double stiffness_border(const AxisSettings& axis,
                                      const std::function<Controller(double)>& make, double low,
                                      double high, const Swing& how = {});

}  // namespace burr::haptics
