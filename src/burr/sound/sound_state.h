// sound/sound_state.h - what can be heard at one moment. Plain struct; SI.
//
// Filled in by the code that knows the session (workshop/sound_tracker.h). A value that is not
// finite makes no sound.
#pragma once

#include <limits>

namespace burr::sound {

struct SoundState {
  double spindle_rad_s = 0;  // present speed, so it drops when the burr does; below 0: backwards
  int teeth = 8;             // of the burr; 0: none, it grinds [-]
  bool strokes = false;  // the tool goes to and fro: a period is a stroke, and it bites twice in it
  bool struck = false;   // a mallet drives the tool into bone now
  double cutting_nm = 0;     // torque of the bone on the burr [N m]
  double removal_m3_s = 0;   // present rate of removal [m^3/s]
  double hardness_j_m3 = 0;  // specific cutting energy of that bone [J/m^3]
  bool touching = false;     // the burr is on the bone
  bool irrigated = false;    // coolant runs
  // from the burr's surface to the nearest structure to spare; infinity: there is none [m]
  double to_spare = std::numeric_limits<double>::infinity();
  bool injured = false;  // the burr is in that structure and turns: its tone is an octave lower
};

}  // namespace burr::sound
