#include "burr/metrics/breach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/same_math.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Bone;

constexpr double kGap = 3e-3;     // what is outside for so long is no pore of spongy bone [m]
constexpr double kReach = 15e-3;  // no pedicle is thicker to one side [m]
constexpr int kRound = 24;        // directions

bool is_inside(const Bone& before, std::span<const volume::TissueId> glass, const Vec3& p) {
  if (volume::depth_at(before, p) >= 0) return true;
  const math::Ijk at = (before.grid().grid_from_world(p).array() + 0.5).floor().cast<int>();
  return std::find(glass.begin(), glass.end(), before.tissue(at.x(), at.y(), at.z())) !=
         glass.end();
}

// From p along w to the first place outside.
double to_outside(const Bone& before, std::span<const volume::TissueId> glass, const Vec3& p,
                  const Vec3& w) {
  const double step = 0.25 * before.grid().voxel;
  double left = 0;  // where it was inside last
  for (double r = 0; r <= kReach + kGap; r += step) {
    if (is_inside(before, glass, p + r * w)) left = r;
    if (r - left >= kGap) return left;
  }
  return kReach;
}

}  // namespace

Breach breach(const Bone& before, std::span<const volume::TissueId> glass, const Vec3& from,
              const Vec3& to, double diameter) {
  BURR_CHECK(diameter > 0);
  const Vec3 whole = to - from;
  const Vec3 w = math::normalized(whole);
  const Vec3 u =
      math::normalized(std::abs(w.x()) < 0.6 ? w.cross(Vec3::UnitX()) : w.cross(Vec3::UnitY()));
  const Vec3 v = w.cross(u);
  const double length = math::norm(whole), step = 0.5 * before.grid().voxel;
  Breach worst;
  double least = std::numeric_limits<double>::infinity();
  for (double l = 0; l <= length; l += step)
    for (int n = 0; n < kRound; ++n) {
      const double angle = 2 * kPi * n / kRound;
      const Vec3 way = std::cos(angle) * u + std::sin(angle) * v;
      const Vec3 at = from + l * w;
      const double wall = to_outside(before, glass, at, way);
      if (wall >= least) continue;
      least = wall;
      worst = {0.5 * diameter - wall, at, way};
    }
  return worst;
}

}  // namespace burr::metrics
