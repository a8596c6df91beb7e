// workshop/tool_picture.h - one tool of the rack as a picture: from the side and a little from above,
// its tip down.
//
// Thread: any. Units: SI.
#pragma once

#include "burr/render/scene.h"
#include "burr/tool/burr_tool.h"
#include "burr/tool/tool.h"

namespace burr::workshop {

// Whole, to a scale that all tools share.
[[nodiscard]] render::Scene tool_picture(const tool::Tool& tool);
// Its working end, as large as the picture allows. aspect: width over height.
[[nodiscard]] render::Scene tip_picture(const tool::Tool& tool, double aspect);
// The same of the round burr.
[[nodiscard]] render::Scene tip_picture(const tool::Burr& burr, double aspect);

}  // namespace burr::workshop
