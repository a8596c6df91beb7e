// record/grid_json.h - grid and tissue table as JSON. For use of this room only, for .cpp files (it
// shows nlohmann's types).
//
// Thread: any.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "burr/volume/grid.h"
#include "burr/volume/tissue.h"

namespace burr::record {

[[nodiscard]] nlohmann::json json_from_grid(const volume::Grid& grid);
[[nodiscard]] nlohmann::json json_from_tissues(const volume::TissueTable& tissues);

// False: something is missing or impossible. Sizes are limited to 2048^3 voxels and 256 tissues.
[[nodiscard]] bool grid_from_json(const nlohmann::json& object, volume::Grid& grid);
[[nodiscard]] bool tissues_from_json(const nlohmann::json& list, volume::TissueTable& tissues);

}  // namespace burr::record
