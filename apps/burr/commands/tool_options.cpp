#include "commands/tool_options.h"

#include "burr/scenario/rack.h"

namespace burr::app {
namespace {

Result<scenario::Rack> rack_of(const ToolOptions& options) {
  if (!options.tools.empty()) return scenario::read_rack(options.tools);
  return scenario::Rack(scenario::built_in_rack());
}

}  // namespace

void add_tool_options(CLI::App& command, ToolOptions& options) {
  command.add_option("--tool", options.tool,
                     "a tool of the rack in place of the round burr (burr tools lists them)");
  command.add_option("--tools", options.tools, "F.toml: tools of one's own for the rack");
}

Status take_tool(const ToolOptions& options, tick::ServoSettings& settings) {
  if (options.tool.empty() && options.tools.empty()) return fine();
  const auto rack = rack_of(options);
  if (!rack) return rack.error();
  if (options.tool.empty())
    return error(Trouble::usage, "--tools " + options.tools +
                                     ": a session takes one tool of the list; name it with --tool");
  const auto tool = rack->get(options.tool);
  if (!tool) return tool.error();
  settings.tools = {{tool->name, tool->tool, tool->cutter}};
  settings.tool = 0;
  return fine();
}

}  // namespace burr::app
