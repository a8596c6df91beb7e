// tool/burr_tool.h - what is in the hand: a round burr head on a shaft.
//
// Units: SI. Frame: the tool's: head centre at the origin, shaft along +z.
#pragma once

#include "burr/rt/rt.h"

namespace burr::tool {

enum class BurrKind {
  cutting,  // fluted steel
  diamond,  // grinds: a quarter as fast, smoother
};

struct Burr {
  double radius = 2.5e-3;  // of the head                                          [m]
  BurrKind kind = BurrKind::cutting;
  int teeth = 8;                 // cutting edges, from pole to shaft; of a cutting burr [-]
  double shaft_radius = 1.2e-3;  // drawn only                                           [m]
  double shaft_length = 60e-3;   // drawn only                                           [m]
};

inline constexpr double kSmallestDiameter = 0.6e-3,
                        kLargestDiameter = 7e-3;  // of round burrs in use  [m]

// How much of the friction power becomes cutting (docs/cutting.md, "Energy law"). Flutes cut one
// way only, grains both.
[[nodiscard]] inline double cutting_efficiency(BurrKind kind, double speed) BURR_RT {
  if (kind == BurrKind::diamond) return 0.25;
  return speed >= 0 ? 1.0 : 0.0;
}

}  // namespace burr::tool
