#include "burr/scoring/measure_list.h"

#include <fmt/core.h>

namespace burr::scoring {
namespace {

constexpr double kMm = 1e-3, kMm2 = 1e-6, kMm3 = 1e-9;

std::vector<Measure> all_measures() {
  using enum Quantity;
  constexpr Part kProduct = Part::product, kProcess = Part::process;
  return {
      {"identified",
       kProduct,
       share,
       true,
       false,
       true,
       true,
       {{"cover_mm", kMm, 1, 0, 5}, {"share", 1, 0.3, 0, 1}}},
      {"skeletonised",
       kProduct,
       share,
       true,
       false,
       true,
       false,
       {{"lo_mm", kMm, 0.1, 0, 5},
        {"hi_mm", kMm, 1.5, 0, 5},
        {"share", 1, 0.6, 0, 1},
        {"over", 1, 0.1, -1, 1}}},
      {"intact_solid",
       kProduct,
       volume,
       true,
       false,
       false,
       false,
       {{"most_mm3", kMm3, 0.05, 0, 1000}}},
      {"intact_soft", kProduct, length, true, false, false, false, {{"deep_mm", kMm, 0.5, 0, 10}}},
      {"intact_plate", kProduct, area, true, false, true, false, {{"most_mm2", kMm2, 1, 0, 1000}}},
      {"no_cells",
       kProduct,
       share,
       true,
       false,
       true,
       false,
       {{"from_mm", kMm, 1.5, -1, 10},
        {"to_mm", kMm, 3, 0, 10},
        {"left", 1, 0.15, 0, 1},
        {"shut", 1, 0.1, 0, 1}}},
      {"opened", kProduct, length, true, false, true, false, {{"radius_mm", kMm, 1, 0, 5}}},
      {"overhang", kProduct, share, false, false, true, false, {{"share", 1, 0.05, 0, 1}}},
      {"removed", kProduct, share, false, true, true, false, {{"share", 1, 0.8, 0, 1}}},
      {"kept", kProduct, share, false, true, true, false, {{"share", 1, 0.1, 0, 1}}},
      {"burr_choice", kProcess, share, false, false, false, false, {{"share", 1, 0.7, 0, 1}}},
      {"restraint", kProcess, ratio, false, false, false, false, {{"most", 1, 0.7, 0, 10}}},
      {"order", kProcess, count, false, false, false, false, {{"most", 1, 0, -1, 1000}}},
  };
}

}  // namespace

const char* word_of(Part part) { return part == Part::product ? "product" : "process"; }

std::string text_of(Quantity quantity, double value) {
  switch (quantity) {
    case Quantity::share:
      return fmt::format("{:.0f} %", 100 * value);
    case Quantity::length:
      return fmt::format("{:.2f} mm", value / kMm);
    case Quantity::area:
      return fmt::format("{:.2f} mm2", value / kMm2);
    case Quantity::volume:
      return fmt::format("{:.3f} mm3", value / kMm3);
    case Quantity::ratio:
      return fmt::format("{:.2f}", value);
    case Quantity::count:
      return fmt::format("{:.0f}", value);
  }
  return {};
}

std::span<const Measure> measures() {
  static const std::vector<Measure> all = all_measures();
  return all;
}

const Measure* measure_named(std::string_view name) {
  for (const Measure& one : measures())
    if (one.name == name) return &one;
  return nullptr;
}

}  // namespace burr::scoring
