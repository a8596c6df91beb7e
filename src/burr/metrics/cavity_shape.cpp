#include "burr/metrics/cavity_shape.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "burr/math/sums.h"
#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/new_surface.h"
#include "burr/metrics/same_math.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Bone;

constexpr double kFloor = 0.8660254037844386, kWall = 0.5;  // cosines of 30 and 60 degrees
constexpr double kReach = 50e-3;                            // no cavity is deeper [m]

// Length along a from p to the last place where bone was.
double depth_below(const Bone& before, const Vec3& p, const Vec3& a) {
  const double step = 0.5 * before.grid().voxel;
  double last = 0, was = volume::depth_at(before, p);
  for (double l = step; l < kReach; l += step) {
    const Vec3 q = p + l * a;
    const double depth = volume::depth_at(before, q);
    if (was >= 0 && depth < 0) last = l - step + step * was / (was - depth);
    was = depth;
  }
  return last;
}

// 95 % of the rim's distances to the border of the plan.
std::optional<double> outline_of(const std::vector<SurfacePoint>& rim, const Region& plan) {
  if (!plan || rim.size() < 20) return std::nullopt;
  std::vector<std::pair<double, double>> far;
  for (const SurfacePoint& one : rim) far.emplace_back(std::abs(plan(one.place)), one.area);
  return weighted_quantile(std::move(far), 0.95);
}

}  // namespace

Assessed<CavityShape> cavity_shape(const Bone& before, const Bone& after, const Vec3& towards,
                                   const Region& region, const Region& plan) {
  const Vec3 a = math::normalized(towards);
  const double h = before.grid().voxel;
  std::vector<SurfacePoint> floor, walls, rim;
  for (const SurfacePoint& one : new_surface(before, after, region)) {
    const double slant = math::dot(one.normal, a);
    // within the ramp the field tells how far the old surface is
    if (volume::depth_at(before, one.place) < 1.5 * h && slant < kFloor) {
      rim.push_back(one);
    } else if (slant >= kFloor) {
      floor.push_back(one);
    } else if (std::abs(slant) <= kWall) {
      walls.push_back(one);
    }
  }
  if (floor.size() < kFewestPoints)
    return NotAssessable{"the cavity has no floor to measure", true};

  CavityShape out;
  std::vector<WeightedPoint> points;
  std::vector<std::pair<double, double>> depths, heights;
  double deepest = -1;
  for (const SurfacePoint& one : floor) {
    points.push_back({one.place, one.area});
    const double depth = depth_below(before, one.place, a);
    depths.emplace_back(depth, one.area);
    heights.emplace_back(math::dot(one.place, a), one.area);
    out.area += one.area;
    if (depth > deepest) {
      deepest = depth;
      out.deepest = one.place;
    }
  }
  const PlaneThrough plane = plane_through(points);
  out.depth = weighted_quantile(std::move(depths), 0.5);
  out.uneven = plane.rms;
  out.tilt = angle_between(math::dot(plane.normal, a) < 0 ? Vec3(-plane.normal) : plane.normal, a);
  out.error = 0.1 * h;
  out.outline = outline_of(rim, plan);

  const double bottom = weighted_quantile(std::move(heights), 0.5) + 2 * h;
  double angle = 0, area = 0;
  std::size_t count = 0;
  for (const SurfacePoint& one : walls) {
    if (math::dot(one.place, a) < bottom) continue;
    angle += one.area * angle_between(one.normal, a);
    area += one.area;
    ++count;
  }
  if (count >= kFewestPoints) out.taper = angle / area - kPi / 2;
  return out;
}

}  // namespace burr::metrics
