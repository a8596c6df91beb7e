// scoring/measure_list.h - the measures that a rubric may name, with their thresholds.
//
//     const Measure* m = measure_named("skeletonised");   m->limits: lo_mm, hi_mm, share, over
//
// The presets are those of docs/teach/metrics.md. Nobody has calibrated them. Thread: any.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burr::scoring {

// Part of a score: the bone at the end, or the way there. They are never added.
enum class Part { product, process };
[[nodiscard]] const char* word_of(Part part);

// What the value of a measure is.
enum class Quantity { share, length, area, volume, ratio, count, angle, time };
// "62 %", "0.84 mm", "1.3 mm2", "0.05 mm3", "0.71", "2", "4.5 degrees", "0.02 s"
[[nodiscard]] std::string text_of(Quantity quantity, double value);

// SI per unit of a rubric's file: 1e-3 for a length, given in mm.
[[nodiscard]] double unit_of(Quantity quantity);

// A threshold: a field of an [[item]].
struct Limit {
  const char* field;   // "lo_mm"
  double unit;         // 1e-3: the file's number times this is SI
  double preset;       // in the file's unit
  double above, most;  // what the file may give
};

// The preset of `share` for an item with `along`.
inline constexpr double kShareAlong = 0.6;

struct Measure {
  const char* name = "";
  Part part = Part::product;
  Quantity quantity = Quantity::share;
  bool structure = false;  // the item must name one; otherwise it must not
  bool region = false;     // the item must name one; otherwise it may if `anywhere`
  bool anywhere = false;
  bool along = false;     // the item may name a curve among the landmarks
  bool on_curve = false;  // it must
  bool on_plane = false;  // it must name a plane among the landmarks
  bool guards = false;    // it judges what must stay as it was: who does not meet it did harm
  std::vector<Limit> limits = {};
};

// True: it may be graded, by the number that decides it.
[[nodiscard]] bool may_be_graded(const Measure& measure);

[[nodiscard]] std::span<const Measure> measures();
[[nodiscard]] const Measure* measure_named(std::string_view name);  // nullptr: there is none

}  // namespace burr::scoring
