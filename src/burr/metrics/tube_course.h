// metrics/tube_course.h - the way of a tube through the bone: how far along it a point lies.
//
// Frame: world. Units: m. Thread: any.
#pragma once

#include <vector>

#include "burr/math/vec3.h"

namespace burr::metrics {

struct Course {
  std::vector<math::Vec3> points;  // at least two, in order

  // Length of the way from the first point to the place on it that is nearest to p; 0 where there
  // are fewer than two points.
  [[nodiscard]] double along(const math::Vec3& p) const;
  // Unit, of the piece that is nearest to p; zero where there is no piece of any length.
  [[nodiscard]] math::Vec3 direction(const math::Vec3& p) const;
  // From p to the nearest place on it; infinite where there are fewer than two points.
  [[nodiscard]] double distance(const math::Vec3& p) const;
};

}  // namespace burr::metrics
