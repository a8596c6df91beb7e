#include "burr/metrics/stroke_direction.h"

#include <cmath>

#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

using math::Vec3;

constexpr double kNear = 3e-3, kAlong = 0.7;  // [m], cosine

}  // namespace

Assessed<StrokeDirection> stroke_direction(const std::vector<BurrStroke>& strokes,
                                           const Course& course) {
  StrokeDirection out;
  if (course.points.size() < 2) return NotAssessable{"the tube has no course"};
  double sum = 0, along = 0;
  bool known = strokes.empty();
  for (const BurrStroke& one : strokes) {
    known = known || !std::isnan(one.d);
    if (!(one.d <= kNear)) continue;
    const Vec3 chord = math::normalized(Vec3(one.to - one.from));
    const double cosine = std::abs(math::dot(chord, course.direction(0.5 * (one.from + one.to))));
    sum += cosine;
    if (cosine >= kAlong) ++along;
    ++out.count;
  }
  if (!known) return NotAssessable{kNoStrokeDistance};
  if (out.count < 5) return NotAssessable{"fewer than five strokes near the tube"};
  const auto count = static_cast<double>(out.count);
  out.mean = sum / count;
  out.along_share = along / count;
  return out;
}

}  // namespace burr::metrics
