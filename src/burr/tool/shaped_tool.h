// tool/shaped_tool.h - a tool that is more than a round burr: its parts, and how it moves.
//
// A session holds a list of them, of which one may be in the hand; a recording holds the list, so it
// can be replayed where no rack has such a tool. Frame and units: tool.h. Thread: any.
#pragma once

#include <string>

#include "burr/tool/cutter.h"
#include "burr/tool/tool.h"

namespace burr::tool {

struct ShapedTool {
  std::string name;  // "sagittal-saw"
  Tool tool;
  Cutter cutter;
};

// Of the drive at full pedal: turns or strokes as an angle; 0: the hand alone moves it.  [rad/s]
[[nodiscard]] double full_speed(const Cutter& cutter);

// The smallest thickness of a part that touches; a wedge's edge, a tip and a cone's end do not count.
// Of a grid it is the diameter of the largest ball inside.
// A thinner part could slip between the points of bone, which are a voxel apart.  [m]
[[nodiscard]] double thinnest(const Tool& tool);

}  // namespace burr::tool
