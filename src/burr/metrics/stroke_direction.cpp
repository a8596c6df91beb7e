#include "burr/metrics/stroke_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

using math::Vec3;

constexpr double kNear = 3e-3;  // [m]
constexpr int kPieces = 16;     // of a chord, between the places at which it is looked at

// From the chord to the course [m].
double distance(const BurrStroke& stroke, const Course& course) {
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n <= kPieces; ++n)
    least = std::min(
        least, course.distance(stroke.from + n / double{kPieces} * (stroke.to - stroke.from)));
  return least;
}

}  // namespace

std::optional<double> along(const BurrStroke& stroke, const Course& course) {
  if (!(stroke.radius > 0) || distance(stroke, course) - stroke.radius > kNear) return std::nullopt;
  const Vec3 chord = math::normalized(Vec3(stroke.to - stroke.from));
  return std::abs(math::dot(chord, course.direction(0.5 * (stroke.from + stroke.to))));
}

Assessed<StrokeDirection> stroke_direction(const std::vector<BurrStroke>& strokes,
                                           const Course& course) {
  StrokeDirection out;
  if (course.points.size() < 2) return NotAssessable{"the tube has no course"};
  double sum = 0, count_along = 0;
  bool known = strokes.empty();
  for (const BurrStroke& one : strokes) {
    known = known || one.radius > 0;
    const auto cosine = along(one, course);
    if (!cosine) continue;
    sum += *cosine;
    if (*cosine >= kAlong) ++count_along;
    ++out.count;
  }
  if (!known) return NotAssessable{kNoRadius};
  if (out.count < 5) return NotAssessable{"fewer than five strokes near the tube"};
  const auto count = static_cast<double>(out.count);
  out.mean = sum / count;
  out.along_share = count_along / count;
  return out;
}

}  // namespace burr::metrics
