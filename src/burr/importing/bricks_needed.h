// importing/bricks_needed.h - which bricks the bone needs, before it is made. Internal to importing.
//
// Thread: any; it starts two workers.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/base/progress.h"
#include "burr/importing/inside_grid.h"
#include "burr/math/vec3.h"

namespace burr::importing {

// Bricks with an inside voxel in them or within 3 voxels, or with a label to keep. 0: not.
[[nodiscard]] std::vector<std::uint8_t> bricks_needed(const InsideGrid& grid,
                                                      const math::Ijk& bricks, Progress& progress,
                                                      bool& cancelled);

}  // namespace burr::importing
