// tool/cutter.h - how the cutting parts of a tool move over the bone, and how well they cut.
//
//     turning         v = omega x w                          burr, fissure bur, drill, wheel
//     oscillating     v = 4 a f, along `way`                 sagittal saw; a: amplitude at the teeth
//     reciprocating   v = 4 a f, along `way`                 jig saw, rasp
//     pushed          v = the hand's own, along `way`        curette, gouge, chisel by hand
//     struck          one blow at a time, along `way`        osteotome under a mallet
//
// 4 a f is the mean speed of a sine of amplitude a and frequency f.
// Frame: of the tool (tool.h). Units: SI. Thread: any. Memory: none.
#pragma once

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::tool {

enum class Drive { turning, oscillating, reciprocating, pushed, struck };

struct Cutter {
  Drive drive = Drive::turning;
  double speed_rad_s = 4000;  // turning: at full speed                              [rad/s]
  double amplitude_m = 0;     // oscillating, reciprocating: half the stroke         [m]
  double cycles_hz = 0;       // oscillating, reciprocating                          [1/s]
  double blow_j = 0;          // struck: energy of one blow                          [J]
  math::Vec3 way = -math::Vec3::UnitZ();  // unit: of the stroke, or in which an edge cuts
  double efficiency = 1;                  // share of the friction power that cuts               [-]
  double least_weight = 0.15;             // turning: of a place on the axis (edit/tool_body.h)  [-]
  int teeth = 8;                          // that pass in a turn or a stroke                     [-]
};

// Mean speed of the teeth along `way`; 0 for what turns or is moved by the hand alone.  [m/s]
[[nodiscard]] inline double stroke_speed(const Cutter& cutter) BURR_RT {
  const bool strokes = cutter.drive == Drive::oscillating || cutter.drive == Drive::reciprocating;
  return strokes ? 4 * cutter.amplitude_m * cutter.cycles_hz : 0;
}

}  // namespace burr::tool
