#include "burr/metrics/region.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/segment.h"

namespace burr::metrics {
namespace {

using math::Vec3;

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return math::norm(p - nearest_on_segment(p, a, b).at);
}

// Beyond the reach the least that it can be, so that depths do not jump there; infinite if that is not
// beyond `least`, or where there is no such tissue.
double far_from(const volume::DistanceTo& tissue, const Vec3& p, double least) {
  const double far = tissue.at(p).distance;
  return tissue.empty() || tissue.reach() <= least ? far : std::min(far, tissue.reach());
}

}  // namespace

double depth_in(const Region& region, const Vec3& p) {
  return region ? region(p) : std::numeric_limits<double>::infinity();
}

Region in_ball(const Vec3& centre, double radius) {
  return [centre, radius](const Vec3& p) { return radius - math::norm(p - centre); };
}

Region in_capsule(const Vec3& a, const Vec3& b, double radius) {
  return [a, b, radius](const Vec3& p) { return radius - to_segment(p, a, b); };
}

Region near_line(std::vector<Vec3> through, double radius) {
  BURR_CHECK(!through.empty());
  return [through = std::move(through), radius](const Vec3& p) {
    double nearest = math::norm(p - through.front());
    for (std::size_t n = 1; n < through.size(); ++n)
      nearest = std::min(nearest, to_segment(p, through[n - 1], through[n]));
    return radius - nearest;
  };
}

Region in_box(const math::Pose& world_from_box, const Vec3& half_extent) {
  return [box_from_world = world_from_box.inverse(), half_extent](const Vec3& p) {
    const Vec3 out = (box_from_world * p).cwiseAbs() - half_extent;
    const double deepest = std::max({out.x(), out.y(), out.z()});
    return deepest <= 0 ? -deepest : -math::norm(out.cwiseMax(0.0));
  };
}

Region in_half_space(const Vec3& point, const Vec3& outward) {
  const Vec3 n = math::normalized(outward);
  BURR_CHECK(math::squared_norm(n) > 0);
  return [point, n](const Vec3& p) { return math::dot(n, point - p); };
}

Region within(std::shared_ptr<const volume::DistanceTo> tissue, double d) {
  BURR_CHECK(tissue != nullptr);
  return [tissue = std::move(tissue), d](const Vec3& p) { return d - far_from(*tissue, p, d); };
}

Region between(std::shared_ptr<const volume::DistanceTo> a,
               std::shared_ptr<const volume::DistanceTo> b, double most) {
  BURR_CHECK(a != nullptr && b != nullptr);
  // halved: the sum of two distances changes twice as fast as a distance
  return [a = std::move(a), b = std::move(b), most](const Vec3& p) {
    return 0.5 * (most - far_from(*a, p, most) - far_from(*b, p, most));
  };
}

Region either(Region a, Region b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) {
    return std::max(depth_in(a, p), depth_in(b, p));
  };
}

Region both(Region a, Region b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) {
    return std::min(depth_in(a, p), depth_in(b, p));
  };
}

Region without(Region a, Region b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) {
    return std::min(depth_in(a, p), -depth_in(b, p));
  };
}

}  // namespace burr::metrics
