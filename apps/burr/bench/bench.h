// apps/burr/bench/bench.h - `burr bench NAME`: measures how fast burr is; one file per measurement,
// which registers itself.
//
//     namespace {
//     void add(CLI::App& bench, burr::app::Todo& todo) {
//       auto* command = bench.add_subcommand("surface", "the whole surface of a phantom");
//       ...                                            // as in subcommand.h
//     }
//     const burr::app::BenchCommand command{20, add};  // 20: place in the help
//     }
#pragma once

#include <chrono>
#include <vector>

#include "shared/subcommand.h"

namespace burr::app {

struct BenchCommand {
  BenchCommand(int place, Command::Add add);
};

// The quantile q, 0..1: the value below which this share of them lies; 0 for no values.
[[nodiscard]] double quantile(std::vector<double> values, double q);

[[nodiscard]] inline double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace burr::app
