// burr phantom - writes a bone that is made by formula to a file.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "burr/base/printable.h"
#include "burr/io/write/write_volume.h"
#include "burr/phantom/phantoms.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/prebuilt_phantom.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  std::string name, out;
  double voxel_mm = 0;
  bool json = false, force = false, landmarks = false;
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
  fmt::print("{}\n",
             json_line(nlohmann::json{{"phantom", options.name},
                                      {"size", {size.x(), size.y(), size.z()}},
                                      {"voxel_mm", 1e3 * bone.grid().voxel},
                                      {"volume_mm3", volume_mm3},
                                      {"tissues", tissues},
                                      {"bone_hash", fmt::format("{:016x}", bone.content_hash())}}));
}

std::string point_text(const math::Vec3& p) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

// "sigmoid sinus   curve of 43 points, 58.0 mm, from (27.00, 44.00, 12.00) to (...)"
std::string text_of(const phantom::Landmark& one) {
  std::string text = fmt::format("{:<30}", one.name);
  if (one.normal)
    return text + fmt::format("plane at {}, normal ({:.3f}, {:.3f}, {:.3f})",
                              point_text(one.points.front()), one.normal->x(), one.normal->y(),
                              one.normal->z());
  if (one.points.size() == 1) return text + "point " + point_text(one.points.front());
  double length = 0;
  for (std::size_t n = 1; n < one.points.size(); ++n)
    length += (one.points[n] - one.points[n - 1]).norm();
  return text + fmt::format("curve of {} points, {:.1f} mm, from {} to {}", one.points.size(),
                            1e3 * length, point_text(one.points.front()),
                            point_text(one.points.back()));
}

Status print_landmarks(const Options& options) {
  if (const Status known = phantom::known(options.name); !known) return known;
  const std::vector<phantom::Landmark> all = phantom::landmarks(options.name);
  if (options.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const phantom::Landmark& one : all) {
      nlohmann::json points = nlohmann::json::array();
      for (const math::Vec3& p : one.points)
        points.push_back({1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()});
      nlohmann::json item = {{"name", one.name}, {"points_mm", points}};
      if (one.normal) item["normal"] = {one.normal->x(), one.normal->y(), one.normal->z()};
      list.push_back(item);
    }
    fmt::print("{}\n", nlohmann::json{{"phantom", options.name}, {"landmarks", list}}.dump());
    return fine();
  }
  fmt::print("{}: {} landmarks, LPS, mm\n", options.name, all.size());
  for (const phantom::Landmark& one : all) fmt::print("  {}\n", text_of(one));
  return fine();
}

Status run(const Options& options) {
  if (options.landmarks) return print_landmarks(options);
  if (options.out.empty())
    return error(Trouble::usage, "nothing to do; give --out FILE, or --landmarks");
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
  auto* command =
      app.add_subcommand("phantom", "write a synthetic bone, made by a formula, to a file");
  auto options = std::make_shared<Options>();
  command
      ->add_option("name", options->name,
                   "one of: " + names() + "; variants follow a question mark: \"jaw?long\"")
      ->required();
  command
      ->add_option("--voxel-mm", options->voxel_mm,
                   "edge of a voxel [mm] (default: suited to the phantom)")
      ->check(CLI::PositiveNumber);
  command->add_option("--out", options->out,
                      ".nrrd: the field; .seg.nrrd: the structures; .bone: both, for burr itself");
  command->add_flag("--landmarks", options->landmarks,
                    "print the named points, curves and planes that the formula knows, and write "
                    "nothing");
  add_force(*command, options->force);
  command->add_flag("--json", options->json, "print a JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{60, add};

}  // namespace
}  // namespace burr::app
