#include "shared/tool_options.h"

#include <utility>

#include "burr/tool/shaped_tool.h"
#include "burr/workshop/mesh_shape.h"

namespace burr::app {
namespace {

Result<scenario::Rack> rack_of(const ToolOptions& options) {
  scenario::Rack rack = scenario::built_in_rack();
  if (!options.tools.empty()) {
    auto read = scenario::read_rack(options.tools, workshop::mesh_shape);
    if (!read) return read.error();
    rack = std::move(*read);
  }
  for (const scenario::RackTool& tool : options.own) rack.put(tool);
  return rack;
}

}  // namespace

void add_tool_options(CLI::App& command, ToolOptions& options) {
  command.add_option("--tool", options.tool,
                     "a tool of the rack in place of the round burr (burr tools lists them)");
  command.add_option("--tools", options.tools, "F.toml: custom tools for the rack");
}

Status take_tool(const ToolOptions& options, tick::ServoSettings& settings) {
  if (options.tool.empty() && options.tools.empty()) return fine();
  const auto rack = rack_of(options);
  if (!rack) return rack.error();
  if (options.tool.empty() && !options.second.empty()) return fine();
  if (options.tool.empty())
    return error(Trouble::usage, "--tools " + options.tools +
                                     ": a session takes one tool of the list; name it with --tool");
  const auto tool = rack->get(options.tool);
  if (!tool) return tool.error();
  settings.tools = {{tool->name, tool->tool, tool->cutter}};
  settings.tool = 0;
  return fine();
}

Result<std::optional<scenario::RackTool>> named_tool(const ToolOptions& options) {
  if (options.tool.empty()) return std::optional<scenario::RackTool>();
  const auto rack = rack_of(options);
  if (!rack) return rack.error();
  auto tool = rack->get(options.tool);
  if (!tool) return tool.error();
  return std::optional<scenario::RackTool>(std::move(*tool));
}

CLI::Option* add_second_tool_option(CLI::App& command, ToolOptions& options) {
  return command.add_option("--second-tool", options.second,
                            "a tool of the rack in the second hand, in place of the suction tube");
}

Result<std::optional<tool::ShapedTool>> second_tool(const ToolOptions& options) {
  std::optional<tool::ShapedTool> none;
  if (options.second.empty()) return none;
  const auto rack = rack_of(options);
  if (!rack) return rack.error();
  const auto tool = rack->get(options.second);
  if (!tool) return tool.error();
  return std::optional<tool::ShapedTool>({tool->name, tool->tool, tool->cutter});
}

Result<std::vector<scenario::RackTool>> offer_rack(const ToolOptions& options, double voxel,
                                                   tick::ServoSettings& settings) {
  const auto rack = rack_of(options);
  if (!rack) return rack.error();
  settings.tools.clear();
  settings.tool = -1;
  if (!options.tool.empty())
    if (const auto named = rack->get(options.tool); !named) return named.error();
  std::vector<scenario::RackTool> offered;
  for (const scenario::RackTool& tool : rack->all) {
    // a thinner one is refused by the session with its reason, where the user named it
    const bool named = tool.name == options.tool;
    if (!named && tool::thinnest(tool.tool) < voxel - 1e-9) continue;
    if (named) settings.tool = static_cast<int>(offered.size());
    settings.tools.push_back({tool.name, tool.tool, tool.cutter});
    offered.push_back(tool);
  }
  return offered;
}

}  // namespace burr::app
