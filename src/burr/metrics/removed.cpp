#include "burr/metrics/removed.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "burr/base/check.h"
#include "burr/metrics/solidity.h"
#include "burr/rt/thread.h"
#include "burr/volume/volume_of.h"

namespace burr::metrics {
namespace {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;

// How much of a voxel lies in a region; depth in voxels. Coarser than volume_units, so that sums of
// products with those fit into 64 bits.
constexpr std::int64_t kCoarse = 64;
std::int64_t units_in(double depth) {
  const volume::Field field = volume::field_from_depth(std::clamp(depth, -4.0, 4.0));
  return volume::volume_units(std::int32_t{field}) / kCoarse;
}

struct Sums {
  std::int64_t bone = 0, removed = 0, excess = 0, lost = 0;  // products
  std::int64_t all = 0, added = 0;
  std::int64_t border = 0;  // voxels that the region's border crosses
};

// Farther than this from the border in its middle, a brick lies on one side of the border as a
// whole: half its diagonal is 6.1 voxels, the ramp of units_in() one, and a distance to a tissue is up
// to 0.9 of its step off at either end [voxel].
constexpr double kWhole = 13;

bool is_same(const Field* a, const Field* b) {
  return a != nullptr && b != nullptr &&
         std::memcmp(a, b, volume::kBrickVoxels * sizeof(Field)) == 0;
}

void add_brick(const Bone& before, const Bone& after, BrickIndex brick, const Region& region,
               double grown, Sums& sums) {
  const Field *was = before.brick_field(brick), *is = after.brick_field(brick);
  if (was == nullptr && is == nullptr) return;
  const volume::Grid& grid = before.grid();
  const math::Ijk first = before.brick_ijk(brick);
  const double far = grown / grid.voxel;
  const double middle =
      depth_in(region, grid.world_from_grid(first.cast<double>() + math::Vec3::Constant(3.5))) /
      grid.voxel;
  const bool inside = middle > kWhole, outside = middle < -kWhole - far;
  if (outside && is_same(was, is)) return;
  for (int v = 0; v < volume::kBrickVoxels; ++v) {
    const std::int64_t had = volume::volume_units(std::int32_t{was == nullptr ? Field{0} : was[v]});
    const std::int64_t has = volume::volume_units(std::int32_t{is == nullptr ? Field{0} : is[v]});
    if (had == 0 && has == 0) continue;
    double depth = middle;
    if (!inside && !outside) {
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      depth = depth_in(region, grid.world_from_grid(at.cast<double>())) / grid.voxel;
    }
    const std::int64_t in = units_in(depth), gone = had - has;
    sums.bone += in * had;
    sums.removed += in * gone;
    const std::int64_t beyond = volume::kVoxelUnits / kCoarse - units_in(depth + far);
    sums.excess += beyond * gone;
    sums.lost += beyond * std::max<std::int64_t>(gone, 0);
    sums.all += gone;
    sums.added += std::max<std::int64_t>(-gone, 0);
    if (std::abs(depth) < 0.5) ++sums.border;
  }
}

// Whole numbers, so the order in which threads add them does not matter.
Sums sums_of(const Bone& before, const Bone& after, const Region& region, double grown) {
  constexpr int kThreads = 2;
  constexpr BrickIndex kAtOnce = 64;
  std::array<Sums, kThreads> parts;
  std::atomic<BrickIndex> next{0};
  rt::on_threads(kThreads, [&](int thread) {
    Sums own;
    for (BrickIndex first = next.fetch_add(kAtOnce); first < before.brick_count();
         first = next.fetch_add(kAtOnce))
      for (BrickIndex n = first; n < std::min(first + kAtOnce, before.brick_count()); ++n)
        add_brick(before, after, n, region, grown, own);
    parts[static_cast<std::size_t>(thread)] = own;
  });
  Sums all;
  for (const Sums& one : parts) {
    all.bone += one.bone;
    all.removed += one.removed;
    all.excess += one.excess;
    all.lost += one.lost;
    all.all += one.all;
    all.added += one.added;
    all.border += one.border;
  }
  return all;
}

}  // namespace

Assessed<Removed> removed_of(const Bone& before, const Bone& after, const Region& region,
                             const RemovedSettings& settings) {
  BURR_CHECK(same_grid(before, after));
  const Sums sums = sums_of(before, after, region, settings.grown);
  const double h = before.grid().voxel, voxel = h * h * h;
  const double unit = voxel / static_cast<double>(volume::kVoxelUnits);
  static_assert(volume::kVoxelUnits % kCoarse == 0);
  constexpr auto kCoarseVoxel = volume::kVoxelUnits / kCoarse;
  const double square = unit / static_cast<double>(kCoarseVoxel);
  Removed out;
  out.bone = static_cast<double>(sums.bone) * square;
  if (out.bone < 8 * voxel)
    return NotAssessable{"there was no bone in this region before the first cut"};
  out.removed = static_cast<double>(sums.removed) * square;
  out.missed = out.bone - out.removed;
  out.excess = static_cast<double>(sums.excess) * square;
  out.lost = static_cast<double>(sums.lost) * square;
  out.added = static_cast<double>(sums.added) * unit;
  out.all = static_cast<double>(sums.all) * unit;
  out.share = out.removed / out.bone;
  out.dice = 2 * out.removed / (out.bone + out.all);
  out.error = 0.23 * static_cast<double>(sums.border) * voxel / out.bone;
  return out;
}

}  // namespace burr::metrics
