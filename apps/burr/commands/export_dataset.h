// commands/export_dataset.h - `burr export --part dataset`: a recording as HDF5, for programs that
// learn from sessions (docs/use/datasets.md).
#pragma once

#include <cstdint>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/recipe.h"

namespace CLI {
class App;
}

namespace burr::app {

struct DatasetOptions {
  std::uint64_t chunk = 0;  // samples in a file; 0: all
  int layout = 3;
  double fps = 0;          // 0: not given
  double baseline_mm = 0;  // 0: not given
  double begins = 0;       // [s]
  std::string images;      // "640x480"; empty: none
};

// Adds --images --fps --baseline-mm --chunk --layout --begins.
void add_dataset_options(CLI::App& command, DatasetOptions& options);

// The first of them that was given, "--chunk"; empty: none. They say nothing about other parts.
[[nodiscard]] std::string given_of(const DatasetOptions& options);

// Writes the file, or files, and prints what is in them. volume: of the recording.
[[nodiscard]] Status export_dataset(const std::string& source, const scenario::BoneRecipe& volume,
                                    const std::string& out, const DatasetOptions& options,
                                    bool json, Progress& progress);

}  // namespace burr::app
