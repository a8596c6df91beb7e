#include "burr/metrics/plane_fit.h"

#include <cmath>
#include <utility>
#include <vector>

#include "burr/math/sums.h"
#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/new_surface.h"
#include "burr/metrics/same_math.h"

namespace burr::metrics {

using math::Vec3;

Assessed<PlaneFit> plane_fit(const volume::Bone& before, const volume::Bone& after,
                             const PlannedPlane& plan, const Region& region,
                             const PlaneFitSettings& settings) {
  const Vec3 n = math::normalized(plan.normal);
  std::vector<WeightedPoint> points;
  for (const SurfacePoint& one : new_surface(before, after, region)) {
    if (std::abs(math::dot(one.place - plan.point, n)) > settings.near) continue;
    if (settings.one_face && math::dot(one.normal, n) < 0.5) continue;
    points.push_back({one.place, one.area});
  }
  if (points.size() < kFewestPoints)
    return NotAssessable{"too little surface was cut near the planned plane", true};
  const PlaneThrough plane = plane_through(points);
  PlaneFit out;
  out.normal = math::dot(plane.normal, n) < 0 ? Vec3(-plane.normal) : plane.normal;
  const double slant = math::dot(out.normal, n);
  if (slant < 0.1) return NotAssessable{"the cut surface does not run along the planned plane"};
  out.offset = math::dot(out.normal, plane.centre - plan.point) / slant;
  out.angle = angle_between(out.normal, n);
  out.rms = plane.rms;
  out.error = 0.1 * before.grid().voxel;
  std::vector<std::pair<double, double>> far;
  double farthest = -1;
  for (const WeightedPoint& one : points) {
    const double d = std::abs(math::dot(out.normal, one.place - plane.centre));
    far.emplace_back(d, one.weight);
    out.area += one.weight;
    if (d > farthest) {
      farthest = d;
      out.worst_at = one.place;
    }
  }
  out.uneven = weighted_quantile(std::move(far), 0.95);
  return out;
}

}  // namespace burr::metrics
