// apps/burr/batch/row_command.h - a command that `burr batch` can do for a row of a manifest, in place of a person who types
// it. The command's own file registers it, with the options that it has on the command line:
//
//     const RowCommand row_command{"surgeon", add_row};
//
// Thread: main.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "burr/base/result.h"

namespace CLI {
class App;
}

namespace burr::app {

// What a command has found, as --json prints it.
struct CommandResult {
  nlohmann::json result;  // the same to the bit whenever and wherever this build does it
  nlohmann::json times;   // what depends on the machine and its load

  [[nodiscard]] nlohmann::json whole() const {
    nlohmann::json both = result;
    if (times.is_object()) both.update(times);
    return both;
  }
};

// Set when a command line was parsed.
struct RowTodo {
  std::function<Status(CommandResult&)> work;
  // Opens the bone of this row and says how much memory its work needs [MB]; none: nobody knows.
  std::function<Result<double>()> memory_mb = {};
};

// An upper bound by the voxels of the grid, after a quarter of an hour of work: measured on the built-in cases, where it was
// 6 bytes a voxel (bench/results/batch.md).
[[nodiscard]] constexpr double memory_mb(double voxels) {
  constexpr double kProgram = 60, kBytesAVoxel = 8;  // [MB], [byte]
  return kProgram + 1e-6 * kBytesAVoxel * voxels;
}

struct RowCommand {
  using Add = void (*)(CLI::App&, RowTodo&);
  RowCommand(const char* name, Add add);
};

// Their names, sorted.
[[nodiscard]] std::vector<std::string> row_commands();
// Adds all of them. `todo` must outlive the parsing.
void add_row_commands(CLI::App& app, RowTodo& todo);

}  // namespace burr::app
