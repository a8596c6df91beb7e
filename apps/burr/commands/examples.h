// apps/burr/commands/examples.h - lines to type, at the end of the help of each command.
//
// scripts/checks/examples.py runs each with --dry, so that none names an option that is gone.
#pragma once

namespace CLI {
class App;
}

namespace burr::app {

// Call it when all commands were added.
void add_examples(CLI::App& program);

}  // namespace burr::app
