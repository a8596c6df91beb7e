// record/tool_json.h - the tools of a session as JSON: every size to the bit, so that a recording can
// be replayed where no rack has such a tool.
//
// Thread: any. Units: SI, in the names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/tool/shaped_tool.h"

namespace burr::record {

[[nodiscard]] std::string tools_to_json(const std::vector<tool::ShapedTool>& tools);
// False: no list of tools, a tool without a part that cuts, sizes that describe no body, or too many.
[[nodiscard]] bool tools_from_json(std::string_view text, std::vector<tool::ShapedTool>& tools);

}  // namespace burr::record
