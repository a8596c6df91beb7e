#include "shared/volume_words.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace burr::app {
namespace {

// Converts a text of the command line. An error is thrown in the form of CLI11, which writes the
// name of the option before it, where the library wrote that of the field.
template <class Value>
Value taken(const std::string& option, Result<Value> read) {
  if (read) return std::move(*read);
  std::string text = read.error().text;
  const std::size_t named = text.starts_with('`') ? text.find("`: ") : std::string::npos;
  if (named != std::string::npos) text.erase(0, named + 3);
  throw CLI::ValidationError(option, text);
}

}  // namespace

void add_volume_options(CLI::App& command, scenario::BoneRecipe& recipe) {
  const auto words = [&command](const char* option, auto take, const char* help) {
    command.add_option_function<std::string>(option, take, help)->type_name("TEXT");
  };
  const auto least = [](double most_wrong, const char* says) {
    return CLI::Validator(
        [=](const std::string& text) {
          double value = 0;
          return CLI::detail::lexical_cast(text, value) && value >= most_wrong ? std::string()
                                                                               : says;
        },
        "", "least");
  };
  command.add_option("--series", recipe.series,
                     "volume of a DICOM folder: #2 as in the list of burr info, a Series Instance "
                     "UID or its beginning, UID#2 for the second volume of that series, or \"70 "
                     "keV\" of a spectral scan; of a file of several volumes: 2");
  command.add_flag("--allow-missing", recipe.allow_missing,
                   "make bone of a scan though some of its files cannot be read, or are not there");
  command.add_flag("--as-it-is", recipe.as_it_is,
                   "make bone of a scan though it contradicts itself, or is no CT");
  command.add_option("--voxel-mm", recipe.voxel_mm,
                     "edge of the cubic voxels (default: the finest axis)");
  words(
      "--spacing-mm",
      [&recipe](const std::string& text) {
        recipe.spacing_mm = taken("--spacing-mm", scenario::parse_spacing(text));
      },
      "X,Y,Z: replaces a wrong spacing in the file");
  words(
      "--iso",
      [&recipe](const std::string& text) {
        recipe.iso = taken("--iso", scenario::parse_level(text));
      },
      "level of the bone surface, in HU or the file's unit (default: 300 HU, otherwise by Otsu)");
  words(
      "--roi",
      [&recipe](const std::string& text) {
        recipe.region = taken("--roi", scenario::parse_region(text));
      },
      "I0,I1,J0,J1,K0,K1: use only these voxels of the file (first and last, counted from 0)");
  command
      .add_option_function<std::vector<std::string>>(
          "--keep",
          [&recipe](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const scenario::Keep one = taken("--keep", scenario::parse_keep(text));
              recipe.keep.largest = std::max(recipe.keep.largest, one.largest);
              recipe.keep.at_mm.insert(recipe.keep.at_mm.end(), one.at_mm.begin(), one.at_mm.end());
            }
          },
          "which separate parts of the bone to keep: largest, a number of the largest, or \"at "
          "X,Y,Z\", the part at this point in mm LPS; can be repeated (default: all)")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  command
      .add_option("--drop-islands-mm3", recipe.drop_islands_mm3,
                  "remove separate parts of the bone that are smaller than this [mm3]")
      ->check(least(0, "must be a number of 0 or more"));
  command.add_option("--tissues,--labels", recipe.labels,
                     "which labels are solid, soft or air: a TOML table, or names as ITK-SNAP or "
                     "FreeSurfer list them");
  command.add_option("--materials", recipe.materials,
                     "TOML table: constants of the materials (default: burr materials)");
  command.add_option(
      "--smooth", recipe.smooth,
      "noise to smooth, in HU or the file's unit; 0: no smoothing (default: as measured)");
  command
      .add_option("--memory-mb", recipe.memory_mb, "memory budget of the import (default: 2048)")
      ->check(least(16, "must be at least 16 MB"));
  command
      .add_option("--read-seconds", recipe.read_seconds,
                  "limit of the processor time for reading (default: by the size of the files)")
      ->check(least(0, "must be a number above 0"));
  command
      .add_option("--read-memory-mb", recipe.read_memory_mb,
                  "limit of the memory for reading (default: by the size of the files)")
      ->check(least(0, "must be a number above 0"));
}

}  // namespace burr::app
