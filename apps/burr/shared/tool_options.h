// apps/burr/shared/tool_options.h - the options that name a tool of the rack.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/scenario/rack.h"
#include "burr/tick/settings.h"

namespace burr::app {

struct ToolOptions {
  std::string tool;   // of the rack; empty: the round burr
  std::string tools;  // a TOML list of custom tools; empty: none
  // of the rack, in the second hand; empty: a suction tube
  std::string second = {};
  // of a case, before those of the rack
  std::vector<scenario::RackTool> own = {};
};

// --tool, --tools
void add_tool_options(CLI::App& command, ToolOptions& options);
// The tool that was named, alone in the session's list; without one nothing changes. Error: an
// unknown name, with those that there are; a mistake in the list; a list without a name.
[[nodiscard]] Status take_tool(const ToolOptions& options, tick::ServoSettings& settings);

// The tool that was named, as the rack has it; none: the round burr. Error: as take_tool().
[[nodiscard]] Result<std::optional<scenario::RackTool>> named_tool(const ToolOptions& options);

// --second-tool
CLI::Option* add_second_tool_option(CLI::App& command, ToolOptions& options);
// none: a suction tube. Error: as take_tool().
[[nodiscard]] Result<std::optional<tool::ShapedTool>> second_tool(const ToolOptions& options);

// For a session in the window, where the user changes the tool: all tools of the rack whose parts are
// as thick as a voxel [m] or thicker go into the session's list, and the named one, if any, into the
// hand. Returns them in the same order. Error: as above, but a list without a name is none.
[[nodiscard]] Result<std::vector<scenario::RackTool>> offer_rack(const ToolOptions& options,
                                                                 double voxel,
                                                                 tick::ServoSettings& settings);

}  // namespace burr::app
