// apps/burr/shared/outputs.h - checks, before the work begins, that a command may write its output
// files without destroying a file of the user.
//
//     const Status possible = check_outputs({options.volume.source, options.path_csv},
//                                           {{"--record", options.record, {".mcap"}},
//                                            {"--picture", options.picture, {".png"}}});
//
// An Error, Trouble::usage or Trouble::io, names the option and the file. Reasons:
//   ending   the command does not write files with this ending
//   place    the folder does not exist, or the name is a folder, a pipe or a device
//   input    the command reads this file, also through a link, or it lies in a folder that it reads
//   kind     the file exists, and its content is not what its ending says
//   twice    two options name the same file
//   kept     a recording or a volume exists, and --force was not given
// Pictures, meshes, sounds, tables and pages are replaced: burr can make them again.
// Thread: main.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"

namespace CLI {
class App;
}

namespace burr::app {

struct Output {
  std::string option;  // "--out"
  std::string path;    // empty: the option was not given
  std::vector<std::string> endings;
};

// Adds --force, which lets a command replace a recording or a volume.
void add_force(CLI::App& command, bool& force);

// inputs: files and folders that the command reads; empty ones and formulas are ignored.
[[nodiscard]] Status check_outputs(const std::vector<std::string>& inputs,
                                   const std::vector<Output>& outputs, bool force = false);

// True: the content of the file is what its ending says, as far as its first bytes show, or it is
// empty.
[[nodiscard]] bool is_what_it_says(const std::string& path);

}  // namespace burr::app
