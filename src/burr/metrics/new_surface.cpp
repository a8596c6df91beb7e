#include "burr/metrics/new_surface.h"

#include <cmath>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/solidity.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;
using volume::Field;
using volume::kIso;

constexpr double kBelow = 0.5 / (2 * volume::kRamp);  // half a voxel, as a share of the field

Field at(const Bone& bone, const Ijk& v) { return bone.field(v.x(), v.y(), v.z()); }

struct Edges {
  const Bone &before, &after;
  const Region& region;
  std::vector<SurfacePoint> points = {};

  void add(const Ijk& v, int axis) {
    const Ijk w = v + Ijk::Unit(axis);
    const Field a = at(after, v), b = at(after, w);
    if ((a >= kIso) == (b >= kIso)) return;
    if (a >= at(before, v) && b >= at(before, w)) return;  // nothing was cut here
    const double share = static_cast<double>(kIso - a) / (b - a);
    const Vec3 p = v.cast<double>() + share * Vec3::Unit(axis);
    if (volume::sample(before, p) < volume::kIsoShare + kBelow) return;
    const Vec3 place = before.grid().world_from_grid(p);
    if (!contains(region, place)) return;
    const Vec3 n = math::normalized(Vec3(-volume::gradient(after, p)));
    const double h = before.grid().voxel;
    points.push_back({place, before.grid().frame.q * n, h * h * std::abs(n[axis])});
  }
};

}  // namespace

std::vector<SurfacePoint> new_surface(const Bone& before, const Bone& after, const Region& region) {
  BURR_CHECK(same_grid(before, after));
  Edges edges{before, after, region};
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    if (before.brick_field(brick) == nullptr) continue;  // nothing to cut
    const Ijk first = before.brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const Ijk here = first + Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (!before.grid().contains(here)) continue;
      for (int axis = 0; axis < 3; ++axis) edges.add(here, axis);
    }
  }
  return std::move(edges.points);
}

}  // namespace burr::metrics
