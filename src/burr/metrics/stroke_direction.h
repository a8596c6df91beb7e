// metrics/stroke_direction.h - do strokes near a tube (a nerve, a sinus) run along it.
//
//     |cos| of the angle between a stroke's chord and the tube's direction where it is nearest
//
// for strokes whose least distance d to the critical structures is at most 3 mm. 1: along the tube.
// Frame: world. Thread: any.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "burr/metrics/course.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/strokes.h"

namespace burr::metrics {

inline constexpr double kAlong = 0.7;  // |cos| of a stroke that runs along [-]

// |cos| of one stroke; none: its d is more than 3 mm or not known.
[[nodiscard]] std::optional<double> along(const BurrStroke& stroke, const Course& course);

struct StrokeDirection {
  std::size_t count = 0;
  double mean = 0;         // of |cos|
  double along_share = 0;  // of the strokes, with |cos| >= kAlong
};

// Not assessable: fewer than 5 such strokes, or a course of fewer than two points.
[[nodiscard]] Assessed<StrokeDirection> stroke_direction(const std::vector<BurrStroke>& strokes,
                                                         const Course& course);

}  // namespace burr::metrics
