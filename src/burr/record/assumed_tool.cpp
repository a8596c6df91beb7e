#include "burr/record/assumed_tool.h"

#include <algorithm>
#include <cmath>

#include "burr/edit/mirror.h"
#include "burr/tool/burr_tool.h"

namespace burr::record {
namespace {

// limits of tick/servo.cpp
constexpr double kFastest = 1e5;    // [rad/s]
constexpr double kLeastRadius = 2;  // [voxel]
// of sim/session_words.cpp
constexpr double kMostRadius = 0.05;  // in settings  [m]

tool::BurrKind kind_of(double value) {
  return value > 0 ? tool::BurrKind::diamond : tool::BurrKind::cutting;
}

}  // namespace

AssumedTool::AssumedTool(const SessionInfo& info) : grid_(info.volume.grid) {
  const auto number = [&info](const char* name) {
    const auto found = info.numbers.find(name);
    return found == info.numbers.end() || !std::isfinite(found->second) ? 0.0 : found->second;
  };
  const double radius = number("burr_radius_m");
  if (radius > 0 && radius <= kMostRadius) now_.radius = radius;
  now_.full_speed = number("spindle_rad_s");
  now_.kind = kind_of(number("burr_kind"));
  now_.irrigated = number("irrigated") > 0;
  obey({tick::CommandKind::tool_mode, number("tool_mode")});
}

void AssumedTool::obey(const tick::Command& command) {
  const double value = command.value;
  if (!std::isfinite(value)) return;
  switch (command.kind) {
    case tick::CommandKind::burr_radius:
      if (value >= kLeastRadius * grid_.voxel && value <= 0.5 * tool::kLargestDiameter + 1e-12)
        now_.radius = value;
      break;
    case tick::CommandKind::burr_kind:
      now_.kind = kind_of(value);
      break;
    case tick::CommandKind::tool_mode:
      if (value >= 0 && value < tool::kModes)
        now_.mode = static_cast<tool::Mode>(static_cast<int>(value));
      break;
    case tick::CommandKind::spindle_speed:
      now_.full_speed = std::clamp(value, -kFastest, kFastest);
      break;
    case tick::CommandKind::irrigation:
      now_.irrigated = value > 0;
      break;
    case tick::CommandKind::mirror_i:
    case tick::CommandKind::mirror_j:
    case tick::CommandKind::mirror_k: {
      const int axis =
          static_cast<int>(command.kind) - static_cast<int>(tick::CommandKind::mirror_i);
      const edit::Mirror mirror = edit::mirror_at(axis, value, grid_.size);
      now_.mirror_axis = mirror.axis;
      now_.mirror_twice = mirror.twice;
      break;
    }
    case tick::CommandKind::mirror_off:
      now_.mirror_axis = -1;
      now_.mirror_twice = 0;
      break;
    default:
      break;  // not of the tool
  }
}

}  // namespace burr::record
