// render/ray_box.h - where a ray enters a box; shared by pick.h and room.h.
//
// Thread: any.
#pragma once

#include <algorithm>
#include <limits>

#include "burr/math/aabb.h"
#include "burr/render/camera.h"

namespace burr::render {

// The distance from the ray's origin at which it enters the box, or infinity; slabs (Kay & Kajiya
// 1986). inverse: of each component of its direction.
[[nodiscard]] inline double entry(const math::Aabb& box, const Ray& ray,
                                  const math::Vec3& inverse) {
  double in = 0, out = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.lo[axis] - ray.origin[axis]) * inverse[axis];
    const double b = (box.hi[axis] - ray.origin[axis]) * inverse[axis];
    // written so that 0 * inf on a face of the box changes neither in nor out
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in <= out ? in : std::numeric_limits<double>::infinity();
}

}  // namespace burr::render
