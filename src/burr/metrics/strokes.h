// metrics/strokes.h - where one stroke of the burr ends and the next begins, and what strokes are
// like.
//
// On the smoothed way at 100 Hz (metrics/track.h), by the k-cosine (Rosenfeld & Johnston 1973):
//
//     cos_i = u . v / (|u| |v|),    u = p_i - p_(i-k),  v = p_(i+k) - p_i,    k = 8
//
// A stroke ends at a local minimum of cos_i with cos_i < 0 and both arms longer than 0.15 mm; and
// where contact is lost for more than 0.1 s, or the spindle starts or stops, or the tool's mode
// changes. Strokes are parts of the way in contact with the burr turning. Shorter than 60 ms or
// 0.5 mm: dropped.
// Frame: world. Units: SI. Thread: any.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/near.h"
#include "burr/metrics/track.h"

namespace burr::metrics {

inline constexpr double kCurved = 0.9;       // straighter strokes are not curved [-]
inline constexpr double kShortStroke = 0.2;  // [s]

struct BurrStroke {
  double begin = 0, end = 0;  // [s]
  math::Vec3 from = math::Vec3::Zero(), to = math::Vec3::Zero();
  double length = 0;       // along the way [m]
  double d = kNoDistance;  // the least to the critical structures on it; kNoDistance: not known [m]
  double radius = 0;       // of the burr; 0: not known [m]
  [[nodiscard]] double seconds() const { return end - begin; }
  [[nodiscard]] double straightness() const;  // chord / length, 0 .. 1
};

[[nodiscard]] std::vector<BurrStroke> strokes_of(const Track& track);

inline constexpr const char* kNoStrokeDistance =
    "no stroke has a known distance to what is to be spared";

struct StrokeFigures {
  std::size_t count = 0;
  double rate = 0;  // strokes per second of stroking [1/s]
  double median_seconds = 0;
  double median_length = 0;  // [m]
  double short_share = 0;    // below kShortStroke
  double curved_share = 0;   // straightness below kCurved
};

// Not assessable: fewer than 5 strokes.
[[nodiscard]] Assessed<StrokeFigures> figures_of(const std::vector<BurrStroke>& strokes);
// Those with d from `from` to `to`, both included, for "far from structures" and "near". Not assessable:
// also where no stroke has a known d.
[[nodiscard]] Assessed<StrokeFigures> figures_of(const std::vector<BurrStroke>& strokes,
                                                 double from, double to);

}  // namespace burr::metrics
