// workshop/second_tool.h - the tool of the other hand in a picture: a suction tube as a rod, any other
// tool as its own surface.
//
// Thread: that of the scene.
#pragma once

#include <memory>

#include "burr/render/scene.h"
#include "burr/tick/rows.h"
#include "burr/tool/tool.h"

namespace burr::workshop {

class SecondTool {
 public:
  // Replaces what was drawn of it before. row: of the second hand; nullptr: it is not there. tool:
  // nullptr: a suction tube of the row's radius; otherwise the same in every call. Call it after
  // put_tool(), which takes all rods away. The first call makes the surface: some milliseconds.
  void put(render::Scene& scene, const tick::TickRow* row, const tool::Tool* tool);

 private:
  std::shared_ptr<const render::ToolLook> look_;
};

// Does the tube draw in water and dust in this tick? Its button stops it.
[[nodiscard]] bool sucks(const tick::TickRow& row);

}  // namespace burr::workshop
