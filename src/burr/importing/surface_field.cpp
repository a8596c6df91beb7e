#include "burr/importing/surface_field.h"

#include <algorithm>
#include <cmath>

#include "burr/importing/bricks_needed.h"
#include "burr/importing/planes_kernel.h"
#include "burr/importing/settle.h"
#include "burr/importing/surface_points.h"
#include "burr/importing/voxel_tissue.h"
#include "burr/io/workers.h"
#include "burr/rt/simd.h"

namespace burr::importing {
namespace {

using block::at;
using block::kHalo;
using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;

constexpr int kNoBlur = 2;  // grey is not blurred, so this border of the block is not needed

// PlanesSay::sure from which on the planes alone count, and how far below it the value alone.
constexpr double kFlat = 0.985, kBends = 0.1;

// What the planes of the points say of a voxel.
struct PlanesSay {
  double depth = 0;
  double sure =
      0;  // length of the mean normal: 1 on a plane, less where the surface bends or folds
};

// On a surface of radius R the mean distance to the tangent planes is too small by l^2 / 2R; the
// distance from the mean point along the mean normal is too large by the same amount. Half of both
// is right to second order (a chord is perpendicular to the mean of the normals at its ends).
PlanesSay planes_say(const PlaneSums& sums, std::size_t v) {
  const double w = 1.0 / double{sums.weights[v]};
  const double planes = double{sums.depths[v]} * w;
  const double length =
      std::sqrt(double{sums.nx[v]} * double{sums.nx[v]} + double{sums.ny[v]} * double{sums.ny[v]} +
                double{sums.nz[v]} * double{sums.nz[v]});
  // in the middle of a thin wall the normals cancel, and there is no mean normal
  const double sure = length * w;
  if (sure < 0.6) return {planes, sure};
  const double along =
      (double{sums.nx[v]} * double{sums.rx[v]} + double{sums.ny[v]} * double{sums.ry[v]} +
       double{sums.nz[v]} * double{sums.rz[v]}) *
      w / length;
  const double share = std::min(1.0, (sure - 0.6) / 0.2);
  return {planes + 0.5 * share * (along - planes), sure};
}

// Depth where the surface bends or folds within a voxel or two, so that planes say little: beside
// the surface the value itself over its slope, which leaves the surface where the values cross the
// level; farther away the distance to the nearest point.
double depth_by_value(const PlaneSums& sums, std::size_t v, double level, double nearest) {
  const double by_slope = level * double{sums.weights[v]} / double{sums.steep[v]};
  const double by_point = level < 0 ? -nearest : nearest;
  return by_slope + std::clamp((nearest - 0.8) / 0.4, 0.0, 1.0) * (by_point - by_slope);
}

// What the nearest point alone says of the distance: it is never more than that to the point, and,
// because the points of a surface lie less than kApart from each other, not much less. So a mean of
// planes that meet far away, as at the rim of a thin plate, makes no bone in air and no ramp.
double within_bounds(double depth, double side, double square, double slack) {
  constexpr double kApart = 1;  // from a surface to its nearest point, along it [voxel]
  const double least = std::max(0.0, std::sqrt(std::max(0.0, square - kApart)) - slack),
               most = std::sqrt(square) + slack;
  return side * std::clamp(side * depth, least > 0 ? least : -most, most);
}

// Depth below the flat faces in which the bone ends where there are layers of air behind the last
// voxel; outside an edge of two of them the distance is that to the edge. p: from the first voxel.
double depth_below_cut(const InsideGrid& grid, const math::Ijk& p) {
  double least = 10, outside = 0;
  for (int a = 0; a < 3; ++a) {
    if (grid.margin[a] == 0) continue;
    const double depth = std::min(p[a] + 0.5, grid.size[a] - 0.5 - p[a]);
    least = std::min(least, depth);
    if (depth < 0) outside += depth * depth;
  }
  return least < 0 ? -std::sqrt(outside) : least;
}

// first: of the brick, counted from the first voxel of the scan.
constexpr double kFarAway = 10;  // deeper than any ramp [voxel]
static_assert(volume::field_from_depth(kFarAway) == volume::kSolid &&
              volume::field_from_depth(-kFarAway) == 0);

// The field of a depth. Rounding takes no voxel of air into the bone.
Field field_beside(double depth) {
  const Field field = volume::field_from_depth(depth);
  return depth < 0 && field >= volume::kIso ? Field{volume::kIso - 1} : field;
}

// The depth of a voxel, and that on the other side of the surface where the smoothing puts it there.
struct VoxelDepth {
  double depth = 0, wanted = 0;
};

// A voxel keeps the side of its value, just beside the surface, unless the smoothing moved the surface
// over it by a little and settle() finds that no part comes or goes. A clean scan is not smoothed.
VoxelDepth depth_of(const InsideGrid& grid, const PlaneSums& sums, std::size_t v, double level) {
  const double side = level >= 0 ? 1 : -1, square = double{sums.nearest[v]},
               nearest = std::sqrt(square);
  if (square >= double{kReach * kReach}) return {side * kFarAway, side * kFarAway};
  double wanted = side * nearest;
  if (sums.weights[v] > 1e-12F) {
    const PlanesSay say = planes_say(sums, v);
    const double folded =
        grid.grey == nullptr ? 0 : std::clamp((kFlat - say.sure) / kBends, 0.0, 1.0);
    wanted = say.depth;
    if (folded > 0) wanted += folded * (depth_by_value(sums, v, level, nearest) - wanted);
  }
  wanted = within_bounds(wanted, side, square, 0.1 * double{grid.soft});
  if (side * wanted > 0) return {wanted, wanted};
  const double beside = side * std::min(kBesideSurface, nearest);
  constexpr double kMost = 0.4;  // voxel that the smoothing may move the surface
  return {beside, grid.soft > 1 && std::abs(wanted) <= kMost ? wanted : beside};
}

// Law 1: the planes alone.
VoxelDepth depth_by_law_1(const PlaneSums& sums, std::size_t v, double level) {
  const bool in = level >= 0;
  double depth = in ? kFarAway : -kFarAway;
  if (sums.weights[v] > 1e-12F) {
    depth = planes_say(sums, v).depth;
    // If averaging would move the surface far beyond a voxel, there is a thin wall or gap: keep it.
    constexpr double kLeast = 0.02, kMuch = 0.4;
    if (in && depth < -kMuch) depth = kLeast;
    if (!in && depth > kMuch) depth = -kLeast;
  }
  return {depth, depth};
}

// first: of the brick, counted from the first voxel of the scan. flips: gets the voxels that lie on the
// other side of the smoothed surface than their own value says.
void fill_brick(const InsideGrid& grid, const GreyTable& table, SumPlanes sum_planes,
                const math::Ijk& first, Desk& desk, const Target& to, std::vector<Flip>& flips) {
  bool any_inside = false, any_outside = false;
  const bool labels = grid.grey == nullptr;
  fetch(grid, first, labels ? 0 : kNoBlur, desk, any_inside, any_outside);
  const math::Ijk room = (grid.size + grid.margin - first).cwiseMin(kBrickEdge);
  const bool cut = !grid.margin.isZero();
  bool ramps = false, measured = false;
  if (any_inside && any_outside) {
    if (labels) blur(desk);
    find_points(grid, first, desk);
    measured = !desk.points.empty();
    if (measured) measure(grid.soft, labels, grid.law, sum_planes, desk);
  }
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z);
        const auto i = static_cast<std::size_t>(v);
        const float level =
            desk.level[static_cast<std::size_t>(at(x + kHalo, y + kHalo, z + kHalo))];
        const bool near = measured && (grid.law == 1 ? desk.sums.weights[i] > 1e-12F
                                                     : desk.sums.nearest[i] < kReach * kReach);
        if (!near && !cut) {  // most voxels
          to.field[v] = level >= 0 ? volume::kSolid : Field{0};
          continue;
        }
        const double far = level >= 0 ? kFarAway : -kFarAway;
        auto [depth, wanted] = !near           ? VoxelDepth{far, far}
                               : grid.law == 1 ? depth_by_law_1(desk.sums, i, double{level})
                                               : depth_of(grid, desk.sums, i, double{level});
        if (cut) {
          const double below = depth_below_cut(grid, first + math::Ijk(x, y, z));
          depth = std::min(depth, below);
          wanted = std::min(wanted, below);
        }
        to.field[v] = grid.law == 1 ? volume::field_from_depth(depth) : field_beside(depth);
        if ((wanted < 0) != (depth < 0))
          flips.push_back({first + grid.margin + math::Ijk(x, y, z), field_beside(wanted)});
        ramps = ramps || (to.field[v] > 0 && to.field[v] < volume::kSolid);
      }
  if (labels)
    label_tissue(grid, first, desk, room, to);
  else
    grey_tissue_of(grid, table, first, measured || ramps, desk, room, to);
}

}  // namespace

SumPlanes sum_planes_kernel() noexcept {
  if constexpr (rt::kWideKernels)
    if (rt::simd() != rt::Simd::scalar) return avx2::sum_planes;
  return scalar::sum_planes;
}

std::unique_ptr<Bone> bone_from_inside(const volume::Grid& grid, volume::TissueTable tissues,
                                       const InsideGrid& inside, const GreyTissue& grey_tissue,
                                       std::size_t reserve_bricks, Progress& progress) {
  const math::Ijk bricks = (grid.size.array() + kBrickEdge - 1) / kBrickEdge;
  bool cancelled = false;
  const std::vector<std::uint8_t> needed = bricks_needed(inside, bricks, progress, cancelled);
  if (cancelled) return nullptr;
  const auto used = static_cast<std::size_t>(
      std::count_if(needed.begin(), needed.end(), [](std::uint8_t n) { return n != 0; }));
  auto bone = std::make_unique<Bone>(grid, std::move(tissues), used, reserve_bricks,
                                     inside.grey != nullptr);

  // assign the slots first and in order, so that the same scan gives the same bone whatever thread
  // fills them
  std::vector<BrickIndex> list;
  list.reserve(used);
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    if (needed[static_cast<std::size_t>(b)] == 0) continue;
    list.push_back(b);
    bone->ensure_slot(b);
  }
  const SumPlanes sum_planes = sum_planes_kernel();
  const GreyTable table(inside, grey_tissue);
  constexpr std::size_t kPortion = 64;
  const int portions = static_cast<int>((list.size() + kPortion - 1) / kPortion);
  std::vector<std::vector<Flip>> flips(
      static_cast<std::size_t>(portions));  // apart, so that their order is always the same
  const bool done = io::in_pieces(portions, progress, "finding the surface", [&](int portion) {
    thread_local std::unique_ptr<Desk> desk = std::make_unique<Desk>();
    const std::size_t from = static_cast<std::size_t>(portion) * kPortion;
    for (std::size_t n = from; n < std::min(list.size(), from + kPortion); ++n) {
      const Target made = {desk->field.data(), desk->tissue.data(),
                           bone->has_intensity() ? bone->build_intensity(list[n]) : nullptr};
      desk->field.fill(0);  // for voxels beyond the grid
      desk->tissue.fill(0);
      fill_brick(inside, table, sum_planes, bone->brick_ijk(list[n]) - inside.margin, *desk, made,
                 flips[static_cast<std::size_t>(portion)]);
      // here, so that a uniform brick never touches its reserved memory
      bone->build_brick(list[n], made.field, made.tissue);
    }
  });
  if (!done) return nullptr;
  std::vector<Flip> all;
  for (const std::vector<Flip>& some : flips) all.insert(all.end(), some.begin(), some.end());
  settle(*bone, all);
  bone->pack();
  return bone;
}

}  // namespace burr::importing
