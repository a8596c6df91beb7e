// apps/burr/shared/subcommand.h - a subcommand of the program; one file each, which registers
// itself.
//
//     namespace {
//     void add(CLI::App& app, burr::app::Todo& todo) {
//       auto* command = app.add_subcommand("info", "say what a file holds");
//       auto options = std::make_shared<Options>();
//       command->add_option("volume", options->path)->required();
//       command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
//     }
//     const burr::app::Command command{20, add};     // 20: place in the help
//     }
#pragma once

#include <functional>

#include "burr/base/progress.h"
#include "burr/base/result.h"

namespace CLI {
class App;
}

namespace burr::app {

// The work of the chosen subcommand, done after parsing. Its Error becomes one line on stderr and
// the exit code.
struct Todo {
  std::function<Status()> work;
};

struct Command {
  using Add = void (*)(CLI::App&, Todo&);
  Command(int place, Add add);
};

// Progress of long work: with the remaining time on a terminal, plain lines otherwise, nothing with
// --quiet. Ctrl-C cancels it.
[[nodiscard]] Progress& progress();

}  // namespace burr::app
