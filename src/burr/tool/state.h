// tool/state.h - the tool in the hand as it is in one tick: what the servo really uses, after each
// command of that tick was obeyed or refused. Every recorded tick holds one (record/tick_columns.cpp).
//
// Plain struct. A round burr is named by its radius, another tool by its number in the session's list. Units: SI. Frame of the mirror: the grid's.
#pragma once

#include "burr/tool/burr_tool.h"

namespace burr::tool {

// restore: back to what the bone was when the session began.
enum class Mode { cut = 0, add = 1, touch = 2, restore = 3, smooth = 4 };
inline constexpr int kModes = 5;

struct ToolState {
  double radius = 0;      // of the burr's head; 0: not known                          [m]
  double full_speed = 0;  // of the spindle at full pedal; below 0: turns backwards    [rad/s]
  BurrKind kind = BurrKind::cutting;
  Mode mode = Mode::cut;
  int mirror_axis = -1;    // of the grid, square to the mirror plane; -1: no mirror   [-]
  int mirror_twice = 0;    // place of that plane along the axis                       [half voxel]
  bool irrigated = false;  // coolant runs
  int number = -1;         // of the tool in the session's list; -1: the round burr

  [[nodiscard]] bool operator==(const ToolState&) const = default;
};

}  // namespace burr::tool
