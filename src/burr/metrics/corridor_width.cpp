#include "burr/metrics/corridor_width.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/math/sums.h"
#include "burr/volume/volume_of.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Field;

constexpr double kFarthest = 15e-3;  // of a wall from its axis [m]
constexpr double kStands = 0.5;      // share of a ring
constexpr double kBrick = 13;        // more than from a brick's middle to its corners [voxel]

struct Ring {
  double bone = 0, gone = 0;  // [voxel]
  double reach = 0;           // radius times bone [m voxel]
};

class Rings {
 public:
  Rings(const CorridorAxis& axis, double h)
      : axis_(axis), step_(0.5 * h), rings_(static_cast<std::size_t>(kFarthest / step_)) {}

  void had(const Vec3& place, double share) {
    const double radius = radius_of(place);
    if (Ring* ring = ring_at(place, radius); ring != nullptr) {
      ring->bone += share;
      ring->reach += share * radius;
    }
  }
  void lost(const Vec3& place, double share) {
    if (Ring* ring = ring_at(place, radius_of(place)); ring != nullptr) ring->gone += share;
  }
  // The radius at which half of the bone stands.
  [[nodiscard]] std::optional<double> wall() const {
    std::optional<double> radius;
    double was = 1;
    for (const Ring& ring : rings_) {
      if (!(ring.bone > 0)) continue;
      const double middle = ring.reach / ring.bone, is = ring.gone / ring.bone;
      if (is < kStands) {
        if (!radius) return std::nullopt;  // the axis itself stands
        return *radius + (middle - *radius) * (was - kStands) / (was - is);
      }
      radius = middle;
      was = is;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] double radius_of(const Vec3& place) const {
    const Vec3 from = place - axis_.point;
    return math::norm(Vec3(from - math::dot(from, axis_.along) * axis_.along));
  }
  [[nodiscard]] Ring* ring_at(const Vec3& place, double radius) {
    const auto n = static_cast<std::size_t>(radius / step_);
    return n < rings_.size() && axis_.counts(place) ? &rings_[n] : nullptr;
  }

  const CorridorAxis& axis_;
  double step_;  // [m]
  std::vector<Ring> rings_;
};

}  // namespace

std::optional<double> corridor_width(const volume::Bone& before, const MainCut& cut,
                                     const CorridorAxis& axis, const Region& region) {
  const volume::Grid& grid = before.grid();
  Rings rings(axis, grid.voxel);
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const Field* was = before.brick_field(brick);
    if (was == nullptr) continue;
    const math::Ijk first = before.brick_ijk(brick);
    const Vec3 middle = grid.world_from_grid(first.cast<double>() + Vec3::Constant(3.5));
    if (depth_in(region, middle) < -kBrick * grid.voxel) continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const std::int32_t units = volume::volume_units(std::int32_t{was[v]});
      if (units <= 0) continue;
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      const Vec3 place = grid.world_from_grid(at.cast<double>());
      if (contains(region, place))
        rings.had(place, static_cast<double>(units) / static_cast<double>(volume::kVoxelUnits));
    }
  }
  for (const Gone& one : cut.gone) rings.lost(one.place, one.share);
  const std::optional<double> radius = rings.wall();
  if (!radius) return std::nullopt;
  return 2 * *radius;
}

}  // namespace burr::metrics
