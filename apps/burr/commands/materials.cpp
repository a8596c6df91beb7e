// `burr materials`: the constants of tissues, how certain they are, and their sources.
#include "burr/importing/materials.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/printable.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  std::string file;
  bool json = false;
};

void print(const importing::Materials& materials) {
  std::size_t calibrated = 0, all = 0;
  for (const importing::Material& material : materials.all) {
    fmt::print("{}\n", base::printable(material.name));
    for (const importing::MaterialField& field : importing::material_fields()) {
      const auto& constant = material.*(field.place);
      if (!constant) continue;
      ++all;
      calibrated += constant->calibrated ? 1 : 0;
      const std::string range =
          fmt::format("({:.4g} to {:.4g})", constant->low / field.si, constant->high / field.si);
      fmt::print("  {:<22} {:>8.4g}  {:<16} {:<9} {:<14} {}\n", field.key,
                 constant->value / field.si, range, field.unit,
                 constant->calibrated ? "calibrated" : "not calibrated",
                 base::printable(constant->source, 300));
    }
  }
  fmt::print("{} of {} constants are calibrated\n", calibrated, all);
}

nlohmann::json to_json(const importing::Materials& materials) {
  nlohmann::json list = nlohmann::json::array();
  for (const importing::Material& material : materials.all) {
    nlohmann::json one = {{"name", material.name}};
    for (const importing::MaterialField& field : importing::material_fields())
      if (const auto& constant = material.*(field.place))
        one[field.key] = {{"value", constant->value / field.si},
                          {"low", constant->low / field.si},
                          {"high", constant->high / field.si},
                          {"source", constant->source},
                          {"calibrated", constant->calibrated}};
    list.push_back(one);
  }
  return {{"materials", list}};
}

Status run(const Options& options) {
  importing::Materials materials = importing::built_in_materials();
  if (!options.file.empty()) {
    auto read = importing::read_materials(options.file);
    if (!read) return read.error();
    materials = std::move(*read);
  }
  if (options.json)
    fmt::print("{}\n", json_line(to_json(materials)));
  else
    print(materials);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand(
      "materials", "list the constants of the materials, with their ranges and sources");
  auto options = std::make_shared<Options>();
  command->add_option("--materials", options->file,
                      "TOML table whose values replace the built-in ones");
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{62, add};

}  // namespace
}  // namespace burr::app
