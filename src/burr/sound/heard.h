// sound/heard.h - what there is to be heard now. Plain struct; SI.
//
// Whoever knows the session fills it in (apps/burr/workshop/hearing.h). What is not a number is heard as
// nothing.
#pragma once

#include <limits>

namespace burr::sound {

struct Heard {
  double spindle_rad_s = 0;  // as it turns now, so it droops as the burr does; below 0: backwards
  int teeth = 8;             // of the burr; 0: none, it grinds                             [-]
  double cutting_nm = 0;     // torque of the bone on the burr                            [N m]
  double removal_m3_s = 0;   // bone that is cut away now                               [m^3/s]
  double hardness_j_m3 = 0;  // specific cutting energy of that bone                    [J/m^3]
  bool touching = false;     // the burr is on the bone
  bool irrigated = false;    // coolant runs
  // from the burr's surface to the nearest structure to spare; infinity: there is none       [m]
  double to_spare = std::numeric_limits<double>::infinity();
};

}  // namespace burr::sound
