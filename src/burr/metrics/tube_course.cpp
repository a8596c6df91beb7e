#include "burr/metrics/tube_course.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "burr/math/sums.h"
#include "burr/metrics/segment.h"

namespace burr::metrics {

using math::Vec3;

double Course::along(const Vec3& p) const {
  double nearest = std::numeric_limits<double>::infinity(), answer = 0, before = 0;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const OnSegment on = nearest_on_segment(p, points[n - 1], points[n]);
    const double far = math::squared_norm(p - on.at);
    const double length = math::norm(points[n] - points[n - 1]);
    if (far < nearest) {
      nearest = far;
      answer = before + on.share * length;
    }
    before += length;
  }
  return answer;
}

Vec3 Course::direction(const Vec3& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 direction = Vec3::Zero();
  for (std::size_t n = 1; n < points.size(); ++n) {
    const Vec3 way = math::normalized(Vec3(points[n] - points[n - 1]));
    const double far = math::squared_norm(p - nearest_on_segment(p, points[n - 1], points[n]).at);
    if (far >= nearest || !(math::squared_norm(way) > 0)) continue;
    nearest = far;
    direction = way;
  }
  return direction;
}

double Course::distance(const Vec3& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < points.size(); ++n)
    nearest = std::min(nearest, math::norm(p - nearest_on_segment(p, points[n - 1], points[n]).at));
  return nearest;
}

}  // namespace burr::metrics
