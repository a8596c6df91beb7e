// workshop/second_tool.h - the tool of the other hand in a picture: a suction tube, or the parts of a
// tool as rods.
//
// Thread: that of the scene.
#pragma once

#include "burr/render/scene.h"
#include "burr/tick/rows.h"
#include "burr/tool/tool.h"

namespace burr::workshop {

// Replaces what was drawn of it before. row: of the second hand; nullptr: it is not there. tool:
// nullptr: a suction tube of the row's radius. Call it after put_tool(), which takes all rods away.
void put_second_tool(render::Scene& scene, const tick::TickRow* row, const tool::Tool* tool);

// Does the tube draw in water and dust in this tick? Its button stops it.
[[nodiscard]] bool sucks(const tick::TickRow& row);

}  // namespace burr::workshop
