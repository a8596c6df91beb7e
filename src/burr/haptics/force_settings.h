// haptics/force_settings.h - the spring that a hand feels (force_law.h), and the limits of every force on
// a hand (safety/limit.h).
//
// Plain structs. Units: in each line.
#pragma once

namespace burr::haptics {

struct ForceSettings {
  double stiffness = 1000;  // [N/m]
  double damping = 0.5;     // [N s/m]
};

struct LimitSettings {
  double user_force = 3.3;    // the user's own limit                                       [N]
  double slew = 300;          // fastest growth of the force                              [N/s]
  double ramp_slew = 60;      // the same during the start ramp                           [N/s]
  double ramp_time = 0.5;     // duration of the start ramp                                 [s]
  double small_force = 0.05;  // engages only after the computed force has been this small  [N]
  double fade_time = 5e-3;    // from detection to zero                                     [s]
  // Largest move of the hand in one tick; a longer one is rejected as a wrong reading  [m]
  double largest_jump = 20e-3;
  // The same of a device that can turn the hand, for its direction  [rad]
  double largest_turn = 0.5;
};

}  // namespace burr::haptics
