// tool/burr_tool.h - what is in the hand: a round burr head on a shaft, turned by a spindle.
//
// Units: SI. Frame: the tool's: head centre at the origin, shaft along +z.
#pragma once

#include <algorithm>
#include <cmath>

#include "burr/rt/rt.h"

namespace burr::tool {

enum class BurrKind {
  cutting,  // fluted steel
  diamond,  // grinds: a quarter as fast, smoother
};

struct Burr {
  double radius = 2.5e-3;  // of the head                                          [m]
  BurrKind kind = BurrKind::cutting;
  double shaft_radius = 1.2e-3;  // drawn only                                           [m]
  double shaft_length = 60e-3;   // drawn only                                           [m]
};

inline constexpr double kSmallestDiameter = 0.6e-3,
                        kLargestDiameter = 7e-3;  // of round burrs in use  [m]

// How much of the friction power becomes cutting (algorithms.md 3e).
[[nodiscard]] inline double cutting_efficiency(BurrKind kind) BURR_RT {
  return kind == BurrKind::cutting ? 1.0 : 0.25;
}

// The spindle follows the pedal like a first-order motor.
struct Spindle {
  double full_speed = 0;        // at full pedal                                          [rad/s]
  double time_constant = 0.05;  // [s]
  double speed = 0;             // now                                                    [rad/s]

  void step(double pedal, double dt) BURR_RT {
    const double wanted = full_speed * std::clamp(pedal, 0.0, 1.0);
    speed += (wanted - speed) * (1 - std::exp(-dt / time_constant));
    if (wanted == 0 && speed < 1) speed = 0;
  }
};

}  // namespace burr::tool
