// tool/burr_tool.h - the tool in the hand: a round burr head on a shaft.
//
// Units: SI. Frame: of the tool: centre of the head at the origin, shaft along +z.
#pragma once

#include "burr/rt/rt.h"

namespace burr::tool {

enum class BurrKind {
  cutting,  // fluted steel
  diamond,  // covered with grit: removes a quarter as fast, smoother
};

struct Burr {
  double radius = 2.5e-3;  // of the head                                          [m]
  BurrKind kind = BurrKind::cutting;
  int teeth = 8;                 // cutting edges, from pole to shaft; cutting burr only [-]
  double shaft_radius = 1.2e-3;  // for display only                                  [m]
  double shaft_length = 60e-3;   // for display only                                  [m]
};

// A burr must also span four voxels to be felt: the servo ignores a command for a smaller one
// (tick/orders.cpp), and workshop::fit_burr() enlarges it before a session.
inline constexpr double kSmallestDiameter = 0.6e-3,
                        kLargestDiameter = 7e-3;  // of round burrs in use  [m]

// Share of the friction power that goes into cutting (docs/understand/cutting.md, "Energy law"). A
// cutting burr cuts in one direction of rotation only, a diamond burr in both.
[[nodiscard]] inline double cutting_efficiency(BurrKind kind, double speed) BURR_RT {
  if (kind == BurrKind::diamond) return 0.25;
  return speed >= 0 ? 1.0 : 0.0;
}

}  // namespace burr::tool
