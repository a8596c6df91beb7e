// `burr tools`: the tools of the rack, with what they are and how they move.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "burr/base/printable.h"
#include "burr/render/picture.h"
#include "burr/render/renderer.h"
#include "burr/scenario/rack.h"
#include "burr/workshop/mesh_shape.h"
#include "burr/workshop/tool_picture.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using scenario::RackTool;
using tool::Drive;

constexpr int kAcross = 5, kTileWide = 240, kTileHigh = 320;  // [pixel]

struct Options {
  std::string file, picture;
  bool json = false;
};

const char* word_of(Drive drive) {
  switch (drive) {
    case Drive::turning:
      break;
    case Drive::oscillating:
      return "oscillating";
    case Drive::reciprocating:
      return "reciprocating";
    case Drive::pushed:
      return "pushed";
    case Drive::struck:
      return "struck";
  }
  return "turning";
}

double rpm_of(const tool::Cutter& cutter) { return cutter.speed_rad_s * 30 / std::numbers::pi; }

std::string motion_of(const tool::Cutter& cutter) {
  switch (cutter.drive) {
    case Drive::turning:
      return fmt::format("turns at {:.0f} rpm", rpm_of(cutter));
    case Drive::oscillating:
    case Drive::reciprocating:
      return fmt::format("{:.0f} strokes a minute of {:.1f} mm, {:.2f} m/s on average",
                         60 * cutter.cycles_hz, 2e3 * cutter.amplitude_m,
                         tool::stroke_speed(cutter));
    case Drive::pushed:
      break;
    case Drive::struck:
      return fmt::format("struck, {:g} J a blow", cutter.blow_j);
  }
  return "pushed by the hand";
}

void print(const scenario::Rack& rack) {
  std::string group;
  for (const RackTool& tool : rack.all) {
    if (tool.group != group) fmt::print("{}\n", base::printable(group = tool.group));
    fmt::print("  {:<18} {:<36} cuts {:>4.1f} mm wide; {}\n", tool.name,
               base::printable(tool.title.in("en")), 1e3 * scenario::cutting_width(tool),
               motion_of(tool.cutter));
  }
}

nlohmann::json to_json(const scenario::Rack& rack) {
  nlohmann::json list = nlohmann::json::array();
  for (const RackTool& tool : rack.all) {
    nlohmann::json one = {{"name", tool.name},
                          {"title", tool.title.in("en")},
                          {"group", tool.group},
                          {"source", tool.source},
                          {"width_mm", 1e3 * scenario::cutting_width(tool)},
                          {"drive", word_of(tool.cutter.drive)},
                          {"parts", tool.tool.count}};
    if (tool.cutter.drive == Drive::turning) one["rpm"] = rpm_of(tool.cutter);
    if (tool.cutter.cycles_hz > 0) one["mean_speed_m_s"] = tool::stroke_speed(tool.cutter);
    list.push_back(std::move(one));
  }
  return {{"tools", list}};
}

render::Scene scene_of(const RackTool& tool) {
  render::Scene scene = workshop::tool_picture(tool.tool);
  scene.text = {tool.name};
  scene.scale_bar = true;
  return scene;
}

// All tools, to the same scale, in rows.
Status draw(const scenario::Rack& rack, const std::string& path) {
  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  const int count = static_cast<int>(rack.all.size()), rows = (count + kAcross - 1) / kAcross;
  render::Image all;
  all.width = kAcross * kTileWide;
  all.height = rows * kTileHigh;
  all.rgb.assign(static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height) * 3,
                 255);
  for (int n = 0; n < count; ++n) {
    const auto tile =
        (*renderer)->image(scene_of(rack.all[static_cast<std::size_t>(n)]), kTileWide, kTileHigh);
    if (!tile) return tile.error();
    for (int y = 0; y < kTileHigh; ++y) {
      const auto row = static_cast<std::size_t>(n / kAcross * kTileHigh + y),
                 column = static_cast<std::size_t>(n % kAcross * kTileWide);
      std::copy_n(tile->rgb.begin() + static_cast<std::ptrdiff_t>(y) * kTileWide * 3, 3 * kTileWide,
                  all.rgb.begin() + static_cast<std::ptrdiff_t>(
                                        3 * (row * static_cast<std::size_t>(all.width) + column)));
    }
  }
  return render::write_png(all, path);
}

Status run(const Options& options) {
  const Status possible = check_outputs({options.file}, {{"--picture", options.picture, {".png"}}});
  if (!possible) return possible;
  scenario::Rack rack = scenario::built_in_rack();
  if (!options.file.empty()) {
    auto read = scenario::read_rack(options.file, workshop::mesh_shape);
    if (!read) return read.error();
    rack = std::move(*read);
  }
  if (options.json)
    fmt::print("{}\n", json_line(to_json(rack)));
  else
    print(rack);
  if (!options.picture.empty()) return draw(rack, options.picture);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command =
      app.add_subcommand("tools", "list the tools of the rack: shape, width and motion of each");
  auto options = std::make_shared<Options>();
  command->add_option("--tools", options->file,
                      "TOML list whose tools are added to the built-in ones");
  command->add_option("--picture", options->picture, "PNG to write: all tools, to the same scale");
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{63, add};

}  // namespace
}  // namespace burr::app
