// apps/burr/bench.h - `burr bench NAME`: what is fast enough and what is not; one file per
// measurement, which registers itself.
//
//     namespace {
//     void add(CLI::App& bench, burr::app::Todo& todo) {
//       auto* command = bench.add_subcommand("surface", "the whole surface of a phantom");
//       ...                                            // as in command.h
//     }
//     const burr::app::BenchCommand command{20, add};  // 20: place in the help
//     }
#pragma once

#include "command.h"

namespace burr::app {

struct BenchCommand {
  BenchCommand(int place, Command::Add add);
};

}  // namespace burr::app
