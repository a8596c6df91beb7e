#include "burr/metrics/filled.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "burr/base/check.h"
#include "burr/metrics/solidity.h"
#include "burr/volume/volume_of.h"

namespace burr::metrics {
namespace {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;

// Products of two volumes of a voxel have to fit into 64 bits, as in removed.cpp.
constexpr std::int64_t kCoarse = 64, kWholeVoxel = volume::kVoxelUnits / kCoarse;
static_assert(volume::kVoxelUnits % kCoarse == 0);

std::int64_t units_in(double depth) {
  const Field field = volume::field_from_depth(std::clamp(depth, -4.0, 4.0));
  return volume::volume_units(std::int32_t{field}) / kCoarse;
}

struct Sums {
  std::int64_t space = 0, filled = 0, beside = 0;  // products
  std::int64_t all = 0;
  std::int64_t border = 0;  // voxels that the region's border crosses
};

// Half the diagonal of a brick and the ramp of units_in(); a brick farther outside holds nothing of
// the region [voxel].
constexpr double kBeyond = 13;

// One that can hold added material or a part of the region.
void add_brick(const Bone& before, const Bone& after, BrickIndex brick, const Region& region,
               double grown, Sums& sums) {
  const volume::Grid& grid = before.grid();
  const Field *was = before.brick_field(brick), *is = after.brick_field(brick);
  const math::Ijk first = before.brick_ijk(brick);
  const double far = grown / grid.voxel;
  const double middle =
      depth_in(region, grid.world_from_grid(first.cast<double>() + math::Vec3::Constant(3.5))) /
      grid.voxel;
  if (middle < -kBeyond - far && is == nullptr) return;
  for (int v = 0; v < volume::kBrickVoxels; ++v) {
    const std::int64_t had = volume::volume_units(std::int32_t{was == nullptr ? Field{0} : was[v]});
    const std::int64_t has = volume::volume_units(std::int32_t{is == nullptr ? Field{0} : is[v]});
    // by the field: the volume of a voxel does not rise everywhere with its field
    const bool grew = (is == nullptr ? 0 : is[v]) > (was == nullptr ? 0 : was[v]);
    const std::int64_t more = grew ? has - had : 0;
    if (more == 0 && middle < -kBeyond) continue;
    const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
    if (!grid.contains(at)) continue;
    const double depth = depth_in(region, grid.world_from_grid(at.cast<double>())) / grid.voxel;
    const std::int64_t in = units_in(depth);
    sums.space += in * (volume::kVoxelUnits - had);
    sums.filled += in * more;
    sums.beside += (kWholeVoxel - units_in(depth + far)) * more;
    sums.all += more;
    if (std::abs(depth) < 0.5) ++sums.border;
  }
}

}  // namespace

Assessed<Filled> filled_of(const Bone& before, const Bone& after, const Region& region,
                           const FilledSettings& settings) {
  BURR_CHECK(same_grid(before, after));
  Sums sums;
  for (BrickIndex brick = 0; brick < before.brick_count(); ++brick)
    add_brick(before, after, brick, region, settings.grown, sums);
  const double h = before.grid().voxel, voxel = h * h * h;
  const double unit = voxel / static_cast<double>(volume::kVoxelUnits);
  const double square = unit / static_cast<double>(kWholeVoxel);
  Filled out;
  out.space = static_cast<double>(sums.space) * square;
  if (out.space < 8 * voxel)
    return NotAssessable{"there was no gap in this region before the first cut"};
  out.filled = static_cast<double>(sums.filled) * square;
  out.beside = static_cast<double>(sums.beside) * square;
  out.all = static_cast<double>(sums.all) * unit;
  out.share = out.filled / out.space;
  out.stray = out.all > 0 ? out.beside / out.all : 0;
  out.error = 0.23 * static_cast<double>(sums.border) * voxel / out.space;
  out.stray_error = out.error * std::max(0.0, 1 - settings.grown / h);
  return out;
}

}  // namespace burr::metrics
