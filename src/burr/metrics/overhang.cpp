#include "burr/metrics/overhang.h"

#include <cmath>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/new_surface.h"
#include "burr/metrics/same_math.h"
#include "burr/metrics/solidity.h"

namespace burr::metrics {

using math::Vec3;

Assessed<Overhang> overhang(const volume::Bone& before, const volume::Bone& after,
                            const Region& region, const OverhangSettings& settings) {
  BURR_CHECK(!settings.towards.empty());
  const std::vector<SurfacePoint> points = new_surface(before, after, region);
  if (points.size() < kFewestPoints)
    return NotAssessable{"too little new surface was cut in this region"};
  const volume::Grid& grid = before.grid();
  const Solidity solidity = Solidity::of_bone(before, after);
  Overhang best;
  best.mark.value = 2;
  for (const Vec3& towards : settings.towards) {
    const Vec3 a = math::normalized(towards), w = grid.frame.q.conjugate() * a;
    Overhang out;
    double hidden = 0;
    for (const SurfacePoint& one : points) {
      out.area += one.area;
      const Vec3 from = grid.grid_from_world(one.place + grid.voxel * one.normal);
      if (!is_blocked(solidity, from, w, settings.reach / grid.voxel)) continue;
      hidden += one.area;
      out.under.push_back(one.place);
    }
    out.towards = a;
    out.mark.value = hidden / out.area;
    if (out.mark.value < best.mark.value) best = std::move(out);
  }
  best.mark.threshold = settings.most_share;
  best.mark.met = best.mark.value <= settings.most_share;
  // the rim of what is hidden is known to three quarters of a voxel; its length is taken as that of a
  // circle's
  best.mark.error = 1.5 * grid.voxel * std::sqrt(kPi * best.mark.value / best.area);
  return best;
}

}  // namespace burr::metrics
