// metrics/region.h - parts of space that a case names without a label: balls, boxes, "within 3 mm
// of the sinus", and what is made of them.
//
// A region is a function of a world point: its depth below the region's border [m], positive
// inside. An empty function is everywhere. The depth is the exact distance for a ball, a capsule, a
// box (inside and on its faces), a half-space; a bound for the others and for combinations. So
// depth(p) > -g is the region grown by g. Frame: world (LPS). Thread: any number at once. Memory:
// none per call.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/volume/distance_to.h"

namespace burr::metrics {

using Region = std::function<double(const math::Vec3& p)>;

[[nodiscard]] double depth_in(const Region& region, const math::Vec3& p);  // everywhere: infinity
[[nodiscard]] inline bool contains(const Region& region, const math::Vec3& p) {
  return depth_in(region, p) >= 0;
}

[[nodiscard]] Region in_ball(const math::Vec3& centre, double radius);
// All points nearer than `radius` to the segment from a to b.
[[nodiscard]] Region in_capsule(const math::Vec3& a, const math::Vec3& b, double radius);
// The same about a line through several points, for a sinus or a nerve. At least one point.
[[nodiscard]] Region near_line(std::vector<math::Vec3> through, double radius);
// A box about the origin of `world_from_box`, half_extent along each of its axes.
[[nodiscard]] Region in_box(const math::Pose& world_from_box, const math::Vec3& half_extent);
// outward . (p - point) <= 0. outward need not be unit, but not zero.
[[nodiscard]] Region in_half_space(const math::Vec3& point, const math::Vec3& outward);
// Not farther than d from a tissue; its reach must be more than d. D: volume/distance_to.h. Depths
// are cut off where D ends: not below d - reach.
[[nodiscard]] Region within(std::shared_ptr<const volume::DistanceTo> tissue, double d);
// Between two tissues: D_a + D_b <= most; each reach must be more than `most`.
[[nodiscard]] Region between(std::shared_ptr<const volume::DistanceTo> a,
                             std::shared_ptr<const volume::DistanceTo> b, double most);

[[nodiscard]] Region either(Region a, Region b);
[[nodiscard]] Region both(Region a, Region b);
[[nodiscard]] Region without(Region a, Region b);  // a, and not b

}  // namespace burr::metrics
