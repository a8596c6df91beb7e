// haptics/safety/stability.h - how stiff a wall may be before the hand trembles: a simulation of
// one axis of a device, with a hand on it if wanted, against a sampled wall.
//
//     arm o--/\/\/--[ m ]--b, f_c      read: encoder step, backward difference, filter
//                     ^  force held for a tick, delay t_d later
//
// Between ticks the mass moves continuously (20 steps of the closed solution), so the energy that a
// held force brings in is simulated as in a real device. The known stability borders:
//
//     linear                              k < 2 (b + B) / T                Colgate & Schenkel 1994
//     linear, with delay                  b + B > k (T/2 + t_d)
//     with an encoder and dry friction    k <= min(2 b / T, 2 f_c / step)  Abbott & Okamura 2005
//
// For tests and for choosing the stiffness on a new device; the tick does not use it. Thread: any.
// Frame: along the axis, bone below zero. Units: SI. Memory: little. Cost: 2 ms per simulated
// second.
#pragma once

#include <functional>

#include "burr/haptics/safety/energy_guard.h"

namespace burr::haptics {

struct AxisSettings {
  double mass = 0.045;            // of the device [kg]
  double damping = 0.5;           // b [N s/m]
  double dry_friction = 0;        // f_c [N]
  double encoder_step = 0;        // [m]; 0: as fine as a double
  double delay = 0;               // t_d, from reading to force; rounded to integration steps [s]
  double rate_hz = 1000;          // of the ticks
  int substeps = 20;              // integration steps per tick
  double velocity_filter_hz = 0;  // first order, on the backward difference; 0: none
  double push = 0;                // constant force of a finger, into the bone [N]
  // An arm that holds the device: its mass moves with the device, its spring pulls to zero.
  double arm_mass = 0;       // [kg]
  double arm_damping = 0;    // [N s/m]
  double arm_stiffness = 0;  // [N/m]
};

// Input of a controller in one tick.
struct Sensed {
  double place = 0;     // from the encoder [m]
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
// The same with an EnergyGuard behind it. `watched` is called with the guard in each tick.
[[nodiscard]] Controller guarded_wall(const WallSettings& settings,
                                      const EnergyGuardSettings& guard,
                                      std::function<void(const EnergyGuard&)> watched = {});

struct Swing {
  double start = 1e-3;  // start of the hand [m]
  double speed = 0;     // its speed there [m/s]
  double duration = 4;  // [s]
  double too_far = 1;   // the simulation ends beyond [m]
};

// The result. Ranges are highest minus lowest place.
struct Swung {
  double early = 0, late = 0;  // range within the second and the last quarter of the time [m]
  double lowest = 0;           // deepest place [m]
  double largest_force = 0;    // [N]
  double top_speed = 0;        // mean over an integration step [m/s]
  // Computed from the real motion between the ticks, from the first tick on [J]:
  double least_work_in = 0;  // smallest value that the hand's work on the wall ever had
  double work_in = 0;        // its value at the end
  bool ran_away = false;     // went beyond too_far, or became NaN

  // True if trembling dies away: the range of the last quarter is smaller than that of the second,
  // or smaller than `quiet`, for example what the encoder can resolve.
  [[nodiscard]] bool stable(double quiet = 1e-9) const {
    return !ran_away && (late < early || late <= quiet);
  }
};
[[nodiscard]] Swung swing(const AxisSettings& axis, const Controller& controller,
                          const Swing& how = {});

// The border between `low`, where the axis is stable, and `high`, where it is not, to 1 part in
// 1000. `make` returns the controller for a stiffness. Returns `low` or `high` if there is no
// border between them.
[[nodiscard]] double stiffness_border(const AxisSettings& axis,
                                      const std::function<Controller(double)>& make, double low,
                                      double high, const Swing& how = {});

}  // namespace burr::haptics
