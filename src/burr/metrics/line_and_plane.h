// metrics/line_and_plane.h - fits of lines and planes to weighted points, the same to the bit on
// every machine. Of this room only.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::metrics {

struct WeightedPoint {
  math::Vec3 place = math::Vec3::Zero();
  double weight = 1;
};

struct PlaneThrough {
  math::Vec3 centre = math::Vec3::Zero();  // mean of the points
  math::Vec3 normal = math::Vec3::Zero();  // unit; the sign is free
  double rms = 0;                          // of the distances to the plane
};

// Total least squares: the normal is the direction of least spread. At least 3 points.
[[nodiscard]] PlaneThrough plane_through(std::span<const WeightedPoint> points);

struct LineThrough {
  math::Vec3 at_zero = math::Vec3::Zero();  // the point with dot(p - origin, along) = 0
  math::Vec3 slope = math::Vec3::Zero();    // p = at_zero + t slope, dot(slope, along) = 1
};

// The line through points as a function of t = dot(p - origin, along), robust: points farther from it
// than about 1.5 times the median distance count less (Huber 1964), 20 rounds. At least 2 points of
// different t.
[[nodiscard]] LineThrough robust_line(std::span<const WeightedPoint> points,
                                      const math::Vec3& origin, const math::Vec3& along);

// The value below which this share of the weight lies; values are sorted here. At least one.
[[nodiscard]] double weighted_quantile(std::vector<std::pair<double, double>> value_and_weight,
                                       double share);

}  // namespace burr::metrics
