#include "commands/export_dataset.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <nlohmann/json.hpp>
#include <vector>

#include "burr/dataset/dataset.h"
#include "burr/record/chain.h"
#include "burr/record/player.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/outputs.h"

namespace burr::app {
namespace {

constexpr int kLargest = 4096;  // side of a picture

// "640x480"
bool read_size(const std::string& text, int& width, int& height) {
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto first = std::from_chars(begin, end, width);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') return false;
  const auto second = std::from_chars(first.ptr + 1, end, height);
  return second.ec == std::errc() && second.ptr == end && width >= 16 && height >= 16 &&
         width <= kLargest && height <= kLargest;
}

std::string voxels_text(std::uint64_t many) {
  return many == 1 ? "1 voxel" : fmt::format("{} voxels", many);
}

void tell(const dataset::Written& account, bool json) {
  if (json) {
    nlohmann::ordered_json row;
    row["part"] = "dataset";
    row["files"] = account.files;
    row["ticks"] = account.ticks;
    row["samples"] = account.samples;
    row["voxels_removed"] = account.removed;
    row["voxels_added"] = account.added;
    row["every_tick"] = account.late.empty();
    fmt::print("{}\n", json_line(row));
    return;
  }
  const std::string where = account.files.size() == 1
                                ? account.files.front()
                                : fmt::format("{} ... {}, {} files", account.files.front(),
                                              account.files.back(), account.files.size());
  fmt::print("{}: {} ticks, {} samples, {} removed{}\n", where, account.ticks, account.samples,
             voxels_text(account.removed),
             account.added > 0 ? fmt::format(", {} came back", voxels_text(account.added)) : "");
}

}  // namespace

void add_dataset_options(CLI::App& command, DatasetOptions& options) {
  command.add_option(
      "--images", options.images,
      "of --part dataset: pictures of two eyes, depth and labels, for example 640x480");
  command.add_option("--fps", options.fps, "of --part dataset: samples a second; default: 50")
      ->check(CLI::Range(0.1, 240.0));
  command
      .add_option("--baseline-mm", options.baseline_mm,
                  "of --part dataset: distance of the two eyes; default: 4")
      ->check(CLI::Range(0.01, 100.0));
  command
      .add_option("--chunk", options.chunk,
                  "of --part dataset: a new file after so many samples; default: one file")
      ->check(CLI::Range(1, 1'000'000'000));
  command
      .add_option("--layout", options.layout,
                  "of --part dataset: 3, or 2: also the names of the older layout, as links")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  command
      .add_option("--begins", options.begins,
                  "of --part dataset: time of the first tick, in seconds since 1970; a recording "
                  "holds no time of day")
      ->check(CLI::Range(0.0, 1e11));
}

std::string given_of(const DatasetOptions& options) {
  if (!options.images.empty()) return "--images";
  if (options.fps > 0) return "--fps";
  if (options.baseline_mm > 0) return "--baseline-mm";
  if (options.chunk > 0) return "--chunk";
  if (options.layout != 3) return "--layout";
  if (options.begins > 0) return "--begins";
  return "";
}

Status export_dataset(const std::string& source, const scenario::BoneRecipe& volume,
                      const std::string& out, const DatasetOptions& options, bool json,
                      Progress& progress) {
  dataset::Options wanted;
  wanted.samples_per_file = options.chunk;
  wanted.old_names = options.layout == 2;
  wanted.begins = options.begins;
  if (options.fps > 0) wanted.fps = options.fps;
  if (options.baseline_mm > 0) wanted.baseline = 1e-3 * options.baseline_mm;
  if (!options.images.empty() && !read_size(options.images, wanted.width, wanted.height))
    return error(Trouble::usage,
                 fmt::format("--images {}: give width and height, 16 to {} each, such as 640x480",
                             options.images, kLargest));
  const std::vector<std::string> endings = {".hdf5", ".h5"};
  const std::vector<std::string> inputs = {source, volume.source, volume.labels, volume.materials};
  Status allowed = check_outputs(inputs, {{"--out", out, endings}});
  if (!allowed) return allowed;
  auto player = record::Player::open(source);
  if (!player) return player.error();
  if (const Status whole = record::check_chain(**player, progress); !whole) return whole.error();
  for (const std::string& name : dataset::files_of(**player, out, wanted)) {
    allowed = check_outputs(inputs, {{"--out", name, endings}});
    if (!allowed) return allowed;
  }
  auto before = workshop::bone_of(**player, volume, progress);
  if (!before) return before.error();
  const auto written = dataset::write(**player, **before, out, wanted, progress);
  if (!written) return written.error();
  print_notices((*player)->notices());
  if (!written->late.empty())
    fmt::print(
        stderr,
        "the session could not be simulated again ({}): times of voxels are up to 0.1 s late\n",
        written->late);
  tell(*written, json);
  return fine();
}

}  // namespace burr::app
