#include "burr/metrics/course.h"

#include <algorithm>
#include <limits>

#include "burr/math/sums.h"

namespace burr::metrics {

double Course::along(const math::Vec3& p) const {
  double nearest = std::numeric_limits<double>::infinity(), answer = 0, before = 0;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const math::Vec3 a = points[n - 1], way = points[n] - a;
    const double square = math::squared_norm(way);
    const double t = square > 0 ? std::clamp(math::dot(p - a, way) / square, 0.0, 1.0) : 0;
    const double far = math::squared_norm(p - (a + t * way)), length = math::norm(way);
    if (far < nearest) {
      nearest = far;
      answer = before + t * length;
    }
    before += length;
  }
  return answer;
}

}  // namespace burr::metrics
