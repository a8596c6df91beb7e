// metrics/segment.h - the point of a segment that is nearest to another point. Of this room only.
#pragma once

#include <algorithm>

#include "burr/math/sums.h"
#include "burr/math/vec3.h"

namespace burr::metrics {

struct OnSegment {
  double share = 0;                    // of the way from a to b, 0 .. 1
  math::Vec3 at = math::Vec3::Zero();  // a + share (b - a)
};

// a may be equal to b.
[[nodiscard]] inline OnSegment nearest_on_segment(const math::Vec3& p, const math::Vec3& a,
                                                  const math::Vec3& b) {
  const math::Vec3 way = b - a;
  const double square = math::squared_norm(way);
  const double t = square > 0 ? std::clamp(math::dot(p - a, way) / square, 0.0, 1.0) : 0;
  return {t, a + t * way};
}

}  // namespace burr::metrics
