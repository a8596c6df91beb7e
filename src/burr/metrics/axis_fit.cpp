#include "burr/metrics/axis_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/same_math.h"
#include "burr/metrics/solidity.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Bone;
using volume::Field;

struct Slice {
  Vec3 sum = Vec3::Zero();  // place times volume
  double volume = 0;        // [voxel]
};

std::map<int, Slice> slices_of(const Bone& before, const Bone& after, const PlannedAxis& plan,
                               const Vec3& along, const Region& region, double thick) {
  std::map<int, Slice> slices;
  const volume::Grid& grid = before.grid();
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const Field *was = before.brick_field(brick), *is = after.brick_field(brick);
    if (was == nullptr) continue;
    const math::Ijk first = before.brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const std::int32_t gone =
          volume::volume_units(std::int32_t{was[v]}) -
          volume::volume_units(std::int32_t{is == nullptr ? Field{0} : is[v]});
      if (gone <= 0) continue;
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      const Vec3 place = grid.world_from_grid(at.cast<double>());
      if (!contains(region, place)) continue;
      const double t = math::dot(place - plan.entry, along);
      Slice& slice = slices[static_cast<int>(std::floor(t / thick))];
      const double share = static_cast<double>(gone) / static_cast<double>(volume::kVoxelUnits);
      slice.sum += share * place;
      slice.volume += share;
    }
  }
  return slices;
}

// The place where a line leaves air and enters bone, first along w; or `from` if it never does.
Vec3 first_bone(const Bone& bone, const Vec3& from, const Vec3& w, double reach) {
  const double step = 0.25 * bone.grid().voxel;
  double before = -1;
  for (double l = 0; l <= reach; l += step) {
    const double depth = volume::depth_at(bone, from + l * w);
    if (depth >= 0) {
      const double share = l > 0 && depth > before ? depth / (depth - before) : 0;
      return from + (l - share * step) * w;
    }
    before = depth;
  }
  return from;
}

// How far removed material goes on along the axis from the entry.
double end_of(const Bone& before, const Bone& after, const Vec3& entry, const Vec3& w,
              double reach) {
  const double h = before.grid().voxel, step = 0.25 * h;
  double end = 0;
  for (double l = h; l <= reach; l += step) {
    const Vec3 p = entry + l * w;
    const double depth = volume::depth_at(after, p);
    if (volume::depth_at(before, p) > 0 && depth >= 0) {
      const double was = volume::depth_at(after, p - step * w);
      return l - (depth > was ? depth / (depth - was) * step : 0);
    }
    end = l;
  }
  return end;
}

}  // namespace

Assessed<AxisFit> axis_fit(const Bone& before, const Bone& after, const PlannedAxis& plan,
                           const Region& region) {
  BURR_CHECK(same_grid(before, after));
  const double h = before.grid().voxel;
  const double thick = h * std::ceil(0.5e-3 / h - 1e-6);  // whole voxels, so that none counts twice
  const Vec3 along = math::normalized(plan.inward);
  const std::map<int, Slice> slices = slices_of(before, after, plan, along, region, thick);
  std::vector<std::pair<double, double>> volumes;
  for (const auto& [number, slice] : slices) volumes.emplace_back(slice.volume, slice.volume);
  if (volumes.size() < 3) return NotAssessable{"nothing was drilled along the planned axis"};
  const double median = weighted_quantile(std::move(volumes), 0.5);
  std::vector<WeightedPoint> centres;
  for (const auto& [number, slice] : slices)
    if (slice.volume >= 0.5 * median) centres.push_back({slice.sum / slice.volume, 1});
  if (centres.size() < 3) return NotAssessable{"nothing was drilled along the planned axis"};

  const LineThrough line = robust_line(centres, plan.entry, along);
  AxisFit out;
  out.inward = math::normalized(line.slope);
  out.angle = angle_between(out.inward, along);
  // a slice across the plan is wider than one across the axis
  const double area = median * h * h * h / thick * math::dot(out.inward, along);
  out.width = 2 * std::sqrt(area / kPi);
  const double length = static_cast<double>(centres.size()) * thick;
  if (length < 2 * out.width)
    return NotAssessable{
        "the drilled corridor is shorter than two of its diameters, so it has no "
        "certain direction"};
  const double far = 10e-3;
  const Vec3 outside = line.at_zero - far * line.slope;
  out.entry = first_bone(before, outside, out.inward, 3 * far);
  const Vec3 off = out.entry - plan.entry;
  out.entry_off = math::norm(off - math::dot(off, along) * along);
  const double deep = end_of(before, after, out.entry, out.inward, length + far);
  out.apex = out.entry + deep * out.inward;
  out.depth = deep * math::dot(out.inward, along);
  out.error = 0.25 * h;
  for (const WeightedPoint& one : centres) out.centres.push_back(one.place);
  return out;
}

}  // namespace burr::metrics
