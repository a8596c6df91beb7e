// metrics/stroke_direction.h - do strokes near a tube (a nerve, a sinus) run along it.
//
//     |cos| of the angle between a stroke's chord and the tube's direction where it is nearest
//
// for strokes on which the burr's surface comes within 3 mm of the tube's course. 1: along the tube.
// Strokes near other structures do not count: beside a sinus there is no reason to follow a nerve.
// Frame: world. Thread: any.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "burr/metrics/measured.h"
#include "burr/metrics/strokes.h"
#include "burr/metrics/tube_course.h"

namespace burr::metrics {

inline constexpr double kAlong = 0.7;  // |cos| of a stroke that runs along [-]

// |cos| of one stroke; none: the burr stays more than 3 mm away, or its radius is not known.
[[nodiscard]] std::optional<double> along(const BurrStroke& stroke, const Course& course);

struct StrokeDirection {
  std::size_t count = 0;
  double mean = 0;         // of |cos|
  double along_share = 0;  // of the strokes, with |cos| >= kAlong
};

// Not assessable: fewer than 5 such strokes, strokes of which no burr has a radius, or a course of
// fewer than two points.
[[nodiscard]] Assessed<StrokeDirection> stroke_direction(const std::vector<BurrStroke>& strokes,
                                                         const Course& course);

}  // namespace burr::metrics
