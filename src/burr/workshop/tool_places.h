// workshop/tool_places.h - some places on the cutting parts of a tool, for distances from it.
//
// Thread: any. Frame: of the tool. Units: m.
#pragma once

#include <vector>

#include "burr/math/vec3.h"
#include "burr/tool/tool.h"

namespace burr::workshop {

// About `count` places, spread over the corners of the surface that is drawn.
[[nodiscard]] std::vector<math::Vec3> places_on(const tool::Tool& tool, std::size_t count = 48);

}  // namespace burr::workshop
