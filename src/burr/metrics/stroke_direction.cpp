#include "burr/metrics/stroke_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

using math::Vec3;

constexpr double kNear = 3e-3, kAlong = 0.7;  // [m], cosine

Vec3 direction_at(const Course& course, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 direction = Vec3::Zero();
  for (std::size_t n = 1; n < course.points.size(); ++n) {
    const Vec3 a = course.points[n - 1], way = course.points[n] - a;
    const double square = math::squared_norm(way);
    if (!(square > 0)) continue;
    const double t = std::clamp(math::dot(p - a, way) / square, 0.0, 1.0);
    const double far = math::squared_norm(p - (a + t * way));
    if (far >= nearest) continue;
    nearest = far;
    direction = math::normalized(way);
  }
  return direction;
}

}  // namespace

Assessed<StrokeDirection> stroke_direction(const std::vector<BurrStroke>& strokes,
                                           const Course& course) {
  StrokeDirection out;
  if (course.points.size() < 2) return NotAssessable{"the tube has no course"};
  double sum = 0, along = 0;
  for (const BurrStroke& one : strokes) {
    if (!(one.d <= kNear)) continue;
    const Vec3 chord = math::normalized(Vec3(one.to - one.from));
    const double cosine =
        std::abs(math::dot(chord, direction_at(course, 0.5 * (one.from + one.to))));
    sum += cosine;
    if (cosine >= kAlong) ++along;
    ++out.count;
  }
  if (out.count < 5) return NotAssessable{"fewer than five strokes near the tube"};
  const auto count = static_cast<double>(out.count);
  out.mean = sum / count;
  out.along_share = along / count;
  return out;
}

}  // namespace burr::metrics
