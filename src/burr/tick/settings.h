// tick/settings.h - how a session is set. As commands have changed it since: controls.h.
//
// A plain struct. Units: SI.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/edit/carve_settings.h"
#include "burr/edit/laws/removal.h"
#include "burr/haptics/force_settings.h"
#include "burr/haptics/method.h"
#include "burr/tool/burr_tool.h"
#include "burr/tool/shaped_tool.h"
#include "burr/tool/spindle.h"
#include "burr/tool/state.h"
#include "burr/volume/tissue.h"

namespace burr::tick {

class OwnLaw;

using ToolMode = tool::Mode;
inline constexpr int kToolModes = tool::kModes;

struct ServoSettings {
  double rate_hz = 1000;
  haptics::Method touch = haptics::Method::constraint;
  tool::Burr burr;
  std::vector<tool::ShapedTool> tools;  // that the session may take
  int tool = -1;                        // number of the one in the hand; -1: the burr
  double spindle_rad_s = 4188.79;       // at full pedal: 40 000 rpm; below 0: backwards
  tool::Motor motor;
  haptics::ForceSettings force;
  bool guarded = false;        // by the energy guard; not by default: docs/status.md
  double guard_slack = 60e-6;  // that the guard lets pass, energy_guard.h               [J]
  bool irrigated = false;      // coolant runs from the start
  double drag_gain = 1;        // of the bone's drag on the turning burr in the hand
  double drag_hz = 5;          // it follows no faster, first order: see docs/develop/decisions
  double vibration_gain = 0;   // of the spindle in the hand: 1 as haptics/vibration.h says, 0 none
  double torque_gain = 1;  // of the motor on the hand, where the device can turn it; 0: no torque
                           // at all
  bool turn_hand = true;   // the torque of a contact turns the hand, where the device can
  haptics::LimitSettings limit;
  edit::RemovalSettings removal;
  edit::CarveSettings carve;
  ToolMode mode = ToolMode::cut;
  double friction_scale = 1;       // of the tissues' own friction
  double friction_turning = 0.05;  // what is left of it while the spindle turns            [-]
  double kinetic_share = 0.9;      // sliding friction over sticking friction               [-]
  bool tool_friction = true;       // holds tools of several parts too (six/six_friction.h)
  double tool_close = 1e-7;        // a tool's move shorter than this ends the search of a tick [m]
  // Tools of the rack rest on planes of the bone (six/row_kernel.h). Off: a saw then cuts less deep.
  bool tool_planes = false;
  double wedge = 2;  // friction counts at most so many times the push; 0: no limit  [-]
  // The stretch of the spring changes by the hand's own move and so much more; 0: no limit. A
  // handpiece of 100 g on a spring of 1000 N/m that slips off swings over in 31 ms, so it moves
  // about so fast.
  double slip_m_s = 30e-3;          //                                  [m/s]
  double velocity_filter_hz = 100;  // of the hand's velocity, first order
  double deposit_rate = 5e-9;  // at full pedal                                          [m^3/s]
  volume::TissueId deposit_tissue = 1;
  double stroke_pause = 0.3;  // a stroke ends after so long without contact           [s]
  double lift_speed = 50e-3;  // of the burr before an undo                             [m/s]
  OwnLaw* law =
      nullptr;  // a custom law, in place of the force law (own_law.h); it outlives the servo
  std::size_t undo_bricks = 16384;  // that all remembered strokes may touch together
};

}  // namespace burr::tick
