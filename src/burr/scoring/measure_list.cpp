#include "burr/scoring/measure_list.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace burr::scoring {
namespace {

constexpr double kMm = 1e-3, kMm2 = 1e-6, kMm3 = 1e-9, kDegree = std::numbers::pi / 180;

// What became of structures and regions.
std::vector<Measure> measures_of_anatomy() {
  using enum Quantity;
  constexpr Part kProduct = Part::product;
  return {
      {.name = "identified",
       .part = kProduct,
       .quantity = share,
       .structure = true,
       .anywhere = true,
       .along = true,
       .limits = {{"cover_mm", kMm, 1, 0, 5}, {"share", 1, 0.3, 0, 1}}},
      {.name = "skeletonised",
       .part = kProduct,
       .quantity = share,
       .structure = true,
       .anywhere = true,
       .limits = {{"lo_mm", kMm, 0.1, 0, 5},
                  {"hi_mm", kMm, 1.5, 0, 5},
                  {"share", 1, 0.6, 0, 1},
                  {"over", 1, 0.1, -1, 1}}},
      {.name = "intact_solid",
       .part = kProduct,
       .quantity = volume,
       .structure = true,
       .guards = true,
       .limits = {{"most_mm3", kMm3, 0.05, 0, 1000}}},
      {.name = "intact_soft",
       .part = kProduct,
       .quantity = length,
       .structure = true,
       .guards = true,
       .limits = {{"deep_mm", kMm, 0.5, 0, 10}}},
      {.name = "intact_plate",
       .part = kProduct,
       .quantity = area,
       .structure = true,
       .anywhere = true,
       .guards = true,
       .limits = {{"most_mm2", kMm2, 1, 0, 1000}}},
      {.name = "no_cells",
       .part = kProduct,
       .quantity = share,
       .structure = true,
       .anywhere = true,
       .limits = {{"from_mm", kMm, 1.5, -1, 10},
                  {"to_mm", kMm, 3, 0, 10},
                  {"left", 1, 0.15, 0, 1},
                  {"shut", 1, 0.1, 0, 1}}},
      {.name = "opened",
       .part = kProduct,
       .quantity = length,
       .structure = true,
       .anywhere = true,
       .limits = {{"radius_mm", kMm, 1, 0, 5}}},
      {.name = "overhang",
       .part = kProduct,
       .quantity = share,
       .anywhere = true,
       .limits = {{"share", 1, 0.05, 0, 1}}},
      {.name = "removed",
       .part = kProduct,
       .quantity = share,
       .region = true,
       .limits = {{"share", 1, 0.8, 0, 1}}},
      {.name = "kept",
       .part = kProduct,
       .quantity = share,
       .region = true,
       .guards = true,
       .limits = {{"share", 1, 0.1, 0, 1}}},
      {.name = "filled",
       .part = kProduct,
       .quantity = share,
       .region = true,
       .limits = {{"share", 1, 0.8, 0, 1}}},
      {.name = "filled_beside",
       .part = kProduct,
       .quantity = share,
       .region = true,
       .limits = {{"share", 1, 0.1, 0, 1}, {"off_mm", kMm, 0.3, 0, 5}}},
  };
}

// Contact, distance, and a corridor against its plan.
std::vector<Measure> measures_of_corridor() {
  using enum Quantity;
  constexpr Part kProduct = Part::product;
  return {
      {.name = "untouched",
       .part = kProduct,
       .quantity = time,
       .structure = true,
       .guards = true,
       .limits = {{"most_s", 1, 0.02, -1, 60}}},
      {.name = "clearance",
       .part = kProduct,
       .quantity = length,
       .structure = true,
       .region = true,
       .along = true,
       .guards = true,
       .limits = {{"least_mm", kMm, 2, 0, 10}}},
      {.name = "divided",
       .part = kProduct,
       .quantity = share,
       .region = true,
       .limits = {{"share", 1, 0.05, 0, 0.5}}},
      {.name = "axis_entry",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_curve = true,
       .limits = {{"most_mm", kMm, 2, 0, 20}}},
      {.name = "axis_apex",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_curve = true,
       .limits = {{"most_mm", kMm, 1.5, 0, 20}}},
      {.name = "axis_angle",
       .part = kProduct,
       .quantity = angle,
       .region = true,
       .on_curve = true,
       .limits = {{"most_deg", kDegree, 5, 0, 90}}},
      {.name = "axis_tilt",
       .part = kProduct,
       .quantity = angle,
       .region = true,
       .on_curve = true,
       .on_plane = true,
       .limits = {{"most_deg", kDegree, 5, 0, 90}}},
      {.name = "axis_breach",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_curve = true,
       .limits = {{"screw_mm", kMm, 6, 0, 20},
                  {"most_mm", kMm, 2, -10, 20},
                  {"from_share", 1, 0.3, 0, 1},
                  {"to_share", 1, 1, 0, 1}}},
      {.name = "axis_depth",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_curve = true,
       .limits = {{"off_mm", kMm, 0.5, 0, 20}}},
      {.name = "axis_width",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_curve = true,
       .limits = {{"width_mm", kMm, 4, 0, 20}, {"off_mm", kMm, 0.5, 0, 10}}},
  };
}

std::vector<Measure> measures_of_plane_and_cavity() {
  using enum Quantity;
  constexpr Part kProduct = Part::product;
  return {
      {.name = "plane_offset",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_plane = true,
       .limits = {{"most_mm", kMm, 1.5, 0, 10}}},
      {.name = "plane_angle",
       .part = kProduct,
       .quantity = angle,
       .region = true,
       .on_plane = true,
       .limits = {{"most_deg", kDegree, 5, 0, 90}}},
      {.name = "plane_even",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .on_plane = true,
       .limits = {{"most_mm", kMm, 1.5, 0, 10}}},
      {.name = "cavity_depth",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .limits = {{"depth_mm", kMm, 2, 0, 50}, {"off_mm", kMm, 0.3, 0, 10}}},
      {.name = "cavity_floor",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .limits = {{"most_mm", kMm, 0.2, 0, 10}}},
      {.name = "cavity_outline",
       .part = kProduct,
       .quantity = length,
       .region = true,
       .limits = {{"most_mm", kMm, 0.3, 0, 10}}},
  };
}

std::vector<Measure> measures_of_manner() {
  using enum Quantity;
  constexpr Part kProcess = Part::process;
  return {
      {.name = "strokes",
       .part = kProcess,
       .quantity = length,
       .limits = {{"least_mm", kMm, 4, 0, 50}, {"from_mm", kMm, 4, -1, 50}}},
      {.name = "stroke_direction",
       .part = kProcess,
       .quantity = share,
       .on_curve = true,
       .limits = {{"share", 1, 0.7, 0, 1}}},
      {.name = "coolant", .part = kProcess, .quantity = share, .limits = {{"share", 1, 0.8, 0, 1}}},
      {.name = "burr_choice",
       .part = kProcess,
       .quantity = share,
       .limits = {{"share", 1, 0.7, 0, 1}}},
      {.name = "restraint",
       .part = kProcess,
       .quantity = ratio,
       .limits = {{"most", 1, 0.7, 0, 10}}},
      {.name = "economy", .part = kProcess, .quantity = share, .limits = {{"share", 1, 0.1, 0, 1}}},
      {.name = "shaft", .part = kProcess, .quantity = time, .limits = {{"most_s", 1, 1, -1, 3600}}},
      {.name = "dwell", .part = kProcess, .quantity = time, .limits = {{"most_s", 1, 3, 0, 600}}},
      {.name = "motor_load",
       .part = kProcess,
       .quantity = share,
       .limits = {{"share", 1, 0.1, 0, 1}}},
      {.name = "reaction", .part = kProcess, .quantity = time, .limits = {{"most_s", 1, 2, 0, 10}}},
      {.name = "order", .part = kProcess, .quantity = count, .limits = {{"most", 1, 0, -1, 1000}}},
  };
}

std::vector<Measure> all_measures() {
  std::vector<Measure> all = measures_of_anatomy();
  for (auto* const more : {measures_of_corridor, measures_of_plane_and_cavity, measures_of_manner})
    for (Measure& one : more()) all.push_back(std::move(one));
  return all;
}

}  // namespace

const char* word_of(Part part) { return part == Part::product ? "product" : "process"; }

std::string text_of(Quantity quantity, double value) {
  switch (quantity) {
    case Quantity::share: {
      // a small share keeps one digit more, so that a tenth of a percent is not "0 %"; never "-0 %"
      const double tenths = std::round(1000 * value), percent = std::round(100 * value);
      if (std::abs(tenths) < 100 && std::fmod(tenths, 10) != 0)
        return fmt::format("{:.1f} %", tenths / 10);
      return fmt::format("{:.0f} %", percent == 0 ? 0.0 : percent);
    }
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
    case Quantity::angle:
      return fmt::format("{:.1f} degrees", value / kDegree);
    case Quantity::time:
      return fmt::format("{:.2f} s", value);
  }
  return {};
}

double unit_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::length:
      return kMm;
    case Quantity::area:
      return kMm2;
    case Quantity::volume:
      return kMm3;
    case Quantity::angle:
      return kDegree;
    default:
      return 1;
  }
}

bool may_be_graded(const Measure& measure) {
  // two numbers with thresholds to two sides; those of "no_cells" are both shares that must be small
  return std::string_view(measure.name) != "skeletonised";
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
