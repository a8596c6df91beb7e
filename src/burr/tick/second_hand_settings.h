// tick/second_hand_settings.h - how the other hand is set (second_hand.h).
//
// A plain struct. Units: in each line.
#pragma once

#include <optional>

#include "burr/haptics/force_settings.h"
#include "burr/tool/shaped_tool.h"

namespace burr::tick {

struct SecondHandSettings {
  double radius = 1.5e-3;        // of the ball at its tip, at least two voxels            [m]
  haptics::ForceSettings force;  // capped by the device's own
  double friction = 0.1;         // of metal on wet bone: hardly any; of a ball             [-]
  double slip_m_s = 30e-3;       // as ServoSettings::slip_m_s                           [m/s]
  double velocity_filter_hz = 100;
  haptics::LimitSettings limit;
  std::optional<tool::ShapedTool> tool = {};  // none: a ball that never cuts
};

}  // namespace burr::tick
