// burr phantom - writes a bone that is made by formula to a file.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/io/write/write_volume.h"
#include "burr/phantom/phantoms.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/prebuilt_phantom.h"
#include "commands/command.h"
#include "commands/outputs.h"

namespace burr::app {
namespace {

struct Options {
  std::string name, out;
  double voxel_mm = 0;
  bool json = false, force = false;
};

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string names() {
  std::string all;
  for (const std::string_view name : phantom::phantom_names())
    all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

Status write(const volume::Bone& bone, const std::string& path) {
  if (ends_with(path, ".bone")) return workshop::write_prebuilt_phantom(bone, path);
  return ends_with(path, ".seg.nrrd") ? io::write_labels(bone, path, progress())
                                      : io::write_field(bone, path, progress());
}

void say(const volume::Bone& bone, const Options& options) {
  const math::Ijk& size = bone.grid().size;
  const double volume_mm3 = 1e9 * volume::volume_of(bone);
  if (!options.json) {
    fmt::print("{}: {} x {} x {} voxels of {:g} mm, {:.1f} cm^3 of bone, {} tissues -> {}\n",
               options.name, size.x(), size.y(), size.z(), 1e3 * bone.grid().voxel,
               1e-3 * volume_mm3, bone.tissues().tissues.size() - 1, options.out);
    return;
  }
  nlohmann::json tissues = nlohmann::json::array();
  for (const volume::Tissue& tissue : bone.tissues().tissues)
    if (&tissue != &bone.tissues().tissues.front()) tissues.push_back(tissue.name);
  fmt::print("{}\n", nlohmann::json{{"phantom", options.name},
                                    {"size", {size.x(), size.y(), size.z()}},
                                    {"voxel_mm", 1e3 * bone.grid().voxel},
                                    {"volume_mm3", volume_mm3},
                                    {"tissues", tissues},
                                    {"bone_hash", fmt::format("{:016x}", bone.content_hash())}}
                         .dump());
}

Status run(const Options& options) {
  if (!ends_with(options.out, ".nrrd") && !ends_with(options.out, ".bone"))
    return error(
        Trouble::usage,
        fmt::format("--out {}: a phantom is written as .nrrd (how deep each voxel lies in "
                    "the bone), .seg.nrrd (named structures) or .bone (both, as burr itself keeps "
                    "it); choose one of these endings",
                    options.out));
  const Status possible =
      check_outputs({}, {{"--out", options.out, {".nrrd", ".bone"}}}, options.force);
  if (!possible) return possible;
  auto bone = phantom::phantom(options.name, options.voxel_mm, progress(), 0);
  if (!bone) return bone.error();
  if (Status written = write(**bone, options.out); !written) return written;
  say(**bone, options);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("phantom", "write a bone defined by a formula to a file");
  auto options = std::make_shared<Options>();
  command->add_option("name", options->name, "one of: " + names())->required();
  command
      ->add_option("--voxel-mm", options->voxel_mm,
                   "edge of a voxel [mm] (default: suited to the phantom)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--out", options->out,
                   ".nrrd: the field; .seg.nrrd: the structures; .bone: both, for burr itself")
      ->required();
  add_force(*command, options->force);
  command->add_flag("--json", options->json, "print a JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{60, add};

}  // namespace
}  // namespace burr::app
