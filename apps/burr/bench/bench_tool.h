// apps/burr/bench/bench_tool.h - `burr bench tool`, and `burr bench tick --tool NAME`: the same
// measurement.
#pragma once

#include <string>

#include "burr/base/result.h"

namespace burr::app {

struct ToolBench {
  std::string tool = "all", scene = "all";  // of the rack; one of the scenes
  std::string tools = {};                   // a list of custom tools; empty: none
  int ticks = 2000, size = 256;             // of each scene; voxels along its edge
  double speed = 1;                         // of the hand, over 100 mm/s and 3 rad/s
  bool mill = false, json = false;
};

// Prints a line for each tool and scene, or one JSON array. Error: no tool has this name.
[[nodiscard]] Status bench_tools(const ToolBench& options);

}  // namespace burr::app
