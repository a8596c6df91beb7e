// apps/burr/commands/tool_options.h - the options that name a tool of the rack.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "burr/base/result.h"
#include "burr/tick/settings.h"

namespace burr::app {

struct ToolOptions {
  std::string tool;   // of the rack; empty: the round burr
  std::string tools;  // a TOML list of tools of one's own; empty: none
};

// --tool, --tools
void add_tool_options(CLI::App& command, ToolOptions& options);
// The tool that was named, alone in the session's list; without one nothing changes. Error: an
// unknown name, with those that there are; a mistake in the list; a list without a name.
[[nodiscard]] Status take_tool(const ToolOptions& options, tick::ServoSettings& settings);

}  // namespace burr::app
