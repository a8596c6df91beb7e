// tool/cutting_places.h - places on the cutting parts of a tool, for distances from it.
//
// Thread: any. Frame: of the tool. Units: m.
#pragma once

#include <vector>

#include "burr/math/vec3.h"
#include "burr/tool/tool.h"

namespace burr::tool {

struct Places {
  std::vector<math::Vec3>
      on;                 // the surface; neighbours are about a tenth of the part's length apart
  double reach = 0;       // of the farthest of them from the origin
  double half_width = 0;  // across the handle: what it cuts, as a round burr's radius
};

// All cutting parts; at most 128 places for each.
[[nodiscard]] Places places_on_surface(const Tool& tool);

}  // namespace burr::tool
