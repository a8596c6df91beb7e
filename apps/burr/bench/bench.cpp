#include "bench/bench.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace burr::app {
namespace {

std::vector<std::pair<int, Command::Add>>& benches() {
  static std::vector<std::pair<int, Command::Add>> all;
  return all;
}

void add(CLI::App& app, Todo& todo) {
  auto& all = benches();
  if (all.empty()) return;
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  auto* bench =
      app.add_subcommand("bench", "measure the speed of one part of burr on this machine");
  bench->require_subcommand(1);
  for (const auto& [place, add_one] : all) add_one(*bench, todo);
}

const Command command{80, add};

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::llround(q * static_cast<double>(values.size() - 1)))];
}

BenchCommand::BenchCommand(int place, Command::Add add) { benches().emplace_back(place, add); }

}  // namespace burr::app
