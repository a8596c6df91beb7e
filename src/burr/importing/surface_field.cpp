#include "burr/importing/surface_field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "burr/importing/planes_kernel.h"
#include "burr/importing/settle.h"
#include "burr/importing/tissues.h"
#include "burr/io/workers.h"
#include "burr/rt/lanes.h"
#include "burr/rt/simd.h"
#include "burr/volume/volume_of.h"

namespace burr::importing {
namespace {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::TissueId;

// The neighbourhood of a brick: 6 voxels on every side. Of those, 2 are for the blur, 1 for the
// gradient, and 3 may hold surface points that reach into the brick.
constexpr int kHalo = 6, kBlock = kBrickEdge + 2 * kHalo, kPlane = kBlock * kBlock,
              kBlockVoxels = kPlane * kBlock;
constexpr int kNoBlur = 2;  // grey is not blurred, so this border of the block is not needed

// How far the plane of a point may lie on the wrong side of a voxel for which it counts [voxel]: as
// far as noise and curvature move it; in label maps also as far as a stair does.
constexpr float kAgainstGrey = 0.4F, kAgainstLabels = 1.0F;
constexpr float kCleanReach = 2.5F;  // in a clean scan a few points give the surface [voxel]
constexpr float kAll = 1e30F;        // law 1: all points in the list of a row count

// PlanesSay::sure from which on the planes alone count, and how far below it the value alone.
constexpr double kFlat = 0.985, kBends = 0.1;

constexpr int at(int x, int y, int z) { return x + kBlock * (y + kBlock * z); }

// Everything that one worker needs; made once, used for thousands of bricks.
struct Desk {
  std::array<float, kBlockVoxels> level;   // >= 0 inside; linear interpolation gives the surface
  std::array<float, kBlockVoxels> smooth;  // in label maps, the values whose gradient is taken
  std::array<float, kBlockVoxels> work;
  std::array<std::int16_t, kBlockVoxels> greys, most, work_greys;  // as stored; in grey scans
  std::array<std::uint8_t, kBlockVoxels> labels;
  // bit x: voxel x of the row is inside; [z][y]
  std::array<std::array<std::uint32_t, kBlock>, kBlock> inside;
  std::vector<SurfacePoint> points;
  // the points that count for each row of the brick: counts[row] of them, from
  // which[row * points.size()] on
  std::array<std::uint32_t, kBrickEdge * kBrickEdge> counts;
  std::vector<std::uint16_t> which;
  PlaneSums sums;
  alignas(64) std::array<float, volume::kBrickVoxels> sides;  // of PlaneRule
  MaterialDirections directions;
  std::array<Field, volume::kBrickVoxels> field;  // the brick being made
  std::array<TissueId, volume::kBrickVoxels> tissue;
};

// Bit x: number x of a row of the block is not below 0.
std::uint32_t not_below_zero(const float* row) {
  static_assert(kBlock >= 16 && kBlock <= 32);
  rt::lanes::Floats low, high;
  rt::lanes::load(row, low);
  rt::lanes::load(row + kBlock - 16, high);
  return rt::lanes::bits_of(low >= 0.0F) | rt::lanes::bits_of(high >= 0.0F) << (kBlock - 16);
}

// Reads the block around a brick, without its outermost `skip` voxels. Beyond the border of the
// grid the last voxels are repeated. any_inside, any_outside: whether there are such voxels.
void fetch(const InsideGrid& grid, const math::Ijk& first, int skip, Desk& desk, bool& any_inside,
           bool& any_outside) {
  const auto nx = static_cast<std::size_t>(grid.size.x()),
             ny = static_cast<std::size_t>(grid.size.y());
  const bool whole = first.x() >= kHalo && first.x() - kHalo + kBlock <= grid.size.x();
  std::array<std::size_t, kBlock> xs{};
  for (int x = 0; x < kBlock; ++x)
    xs[static_cast<std::size_t>(x)] =
        static_cast<std::size_t>(std::clamp(first.x() + x - kHalo, 0, grid.size.x() - 1));
  const std::uint32_t needed = ((1U << (kBlock - 2 * skip)) - 1U) << skip;
  any_inside = any_outside = false;
  for (int z = skip; z < kBlock - skip; ++z) {
    const auto k =
        static_cast<std::size_t>(std::clamp(first.z() + z - kHalo, 0, grid.size.z() - 1));
    for (int y = skip; y < kBlock - skip; ++y) {
      const auto j =
          static_cast<std::size_t>(std::clamp(first.y() + y - kHalo, 0, grid.size.y() - 1));
      const std::size_t row = nx * (j + ny * k);
      float* level = &desk.level[static_cast<std::size_t>(at(0, y, z))];
      std::uint8_t* label = &desk.labels[static_cast<std::size_t>(at(0, y, z))];
      if (grid.grey != nullptr) {
        std::int16_t* grey = &desk.greys[static_cast<std::size_t>(at(0, y, z))];
        if (whole)
          std::memcpy(grey, grid.grey + row + xs[0], kBlock * sizeof *grey);
        else
          for (std::size_t x = 0; x < kBlock; ++x) grey[x] = grid.grey[row + xs[x]];
        for (int x = 0; x < kBlock; ++x) level[x] = static_cast<float>(grey[x]) - grid.iso;
      } else {
        for (std::size_t x = 0; x < kBlock; ++x) {
          const std::size_t v = row + xs[x];
          label[x] = grid.labels[v];
          level[x] = grid.share != nullptr        ? static_cast<float>(grid.share[v]) - 127.5F
                     : grid.solid[grid.labels[v]] ? 127.5F
                                                  : -127.5F;
        }
      }
      const std::uint32_t in = not_below_zero(level) & needed;
      desk.inside[static_cast<std::size_t>(z)][static_cast<std::size_t>(y)] = in;
      any_inside = any_inside || in != 0;
      any_outside = any_outside || in != needed;
    }
  }
}

// [1 4 6 4 1] / 16 along all axes
void blur(Desk& desk) {
  desk.smooth = desk.level;
  for (const int stride : {1, kBlock, kPlane}) {
    desk.work = desk.smooth;
    const float* from = desk.work.data();
    float* to = desk.smooth.data();
    for (int v = 2 * stride; v < kBlockVoxels - 2 * stride; ++v)
      to[v] = 0.375F * from[v] + 0.25F * (from[v - stride] + from[v + stride]) +
              0.0625F * (from[v - 2 * stride] + from[v + 2 * stride]);
  }
}

// Finds the surface points on grid edges near the brick.
void find_points(const InsideGrid& grid, const math::Ijk& first, Desk& desk) {
  desk.points.clear();
  const bool labels = grid.grey == nullptr;
  const float* s = labels ? desk.smooth.data() : desk.level.data();
  const auto add = [&](int x, int y, int z, int axis) {
    const int stride = axis == 0 ? 1 : axis == 1 ? kBlock : kPlane;
    const int a = at(x, y, z), b = a + stride;
    const float la = desk.level[static_cast<std::size_t>(a)],
                lb = desk.level[static_cast<std::size_t>(b)];
    float t = la / (la - lb);
    if (labels) t = std::clamp(t, 0.1F, 0.9F);
    const auto slope = [&](int step) {
      return (1 - t) * (s[a + step] - s[a - step]) + t * (s[b + step] - s[b - step]);
    };
    float nx = slope(1), ny = slope(kBlock), nz = slope(kPlane);
    float length = std::sqrt(nx * nx + ny * ny + nz * nz);
    // a single voxel has no slope: the edge itself is the normal then
    const float along = lb > la ? 1.0F : -1.0F;
    const float own = axis == 0 ? nx : axis == 1 ? ny : nz;
    if (!(length > 1e-6F) || own * along <= 0) {
      nx = axis == 0 ? along : 0;
      ny = axis == 1 ? along : 0;
      nz = axis == 2 ? along : 0;
      length = 1;
    }
    SurfacePoint p{static_cast<float>(x),
                   static_cast<float>(y),
                   static_cast<float>(z),
                   nx / length,
                   ny / length,
                   nz / length,
                   0};
    (axis == 0 ? p.x : axis == 1 ? p.y : p.z) += t;
    const float across = std::abs(axis == 0 ? p.nx : axis == 1 ? p.ny : p.nz);
    p.steep = std::abs(la - lb) / std::max(across, 0.2F);
    p.x -= kHalo;
    p.y -= kHalo;
    p.z -= kHalo;
    if (p.x >= -kReach && p.x <= kBrickEdge - 1 + kReach) desk.points.push_back(p);
  };
  // edges beyond the grid's border do not exist
  constexpr int kFrom = kHalo - 3, kTo = kHalo + kBrickEdge + 2;
  const math::Ijk last =
      grid.size - first - math::Ijk::Ones();  // last voxel, counted from the brick
  const math::Ijk lo(std::max(kFrom, kHalo - first.x()), std::max(kFrom, kHalo - first.y()),
                     std::max(kFrom, kHalo - first.z()));
  const math::Ijk hi(std::min(kTo, kHalo + last.x()), std::min(kTo, kHalo + last.y()),
                     std::min(kTo, kHalo + last.z()));
  const std::uint32_t here = (2U << hi.x()) - (1U << lo.x()), not_last = here & ~(1U << hi.x());
  for (int z = lo.z(); z <= hi.z(); ++z)
    for (int y = lo.y(); y <= hi.y(); ++y) {
      const auto k = static_cast<std::size_t>(z), j = static_cast<std::size_t>(y);
      const std::uint32_t in = desk.inside[k][j];
      const std::uint32_t along_x = (in ^ in >> 1) & not_last,
                          along_y = y < hi.y() ? (in ^ desk.inside[k][j + 1]) & here : 0,
                          along_z = z < hi.z() ? (in ^ desk.inside[k + 1][j]) & here : 0;
      for (std::uint32_t left = along_x | along_y | along_z; left != 0; left &= left - 1) {
        const int x = std::countr_zero(left);
        if ((along_x >> x & 1U) != 0) add(x, y, z, 0);
        if ((along_y >> x & 1U) != 0) add(x, y, z, 1);
        if ((along_z >> x & 1U) != 0) add(x, y, z, 2);
      }
    }
}

// The direction towards the material; its length, the certainty, is 0 in the middle of a thin wall.
void face(Desk& desk) {
  for (int z = 0, v = 0; z < kBrickEdge; ++z)
    for (int y = 0; y < kBrickEdge; ++y)
      for (int x = 0; x < kBrickEdge; ++x, ++v) {
        const float* s = desk.smooth.data() + at(x + kHalo, y + kHalo, z + kHalo);
        const float gx = s[1] - s[-1], gy = s[kBlock] - s[-kBlock], gz = s[kPlane] - s[-kPlane];
        const float scale = 1.0F / std::max(std::sqrt(gx * gx + gy * gy + gz * gz), 30.0F);
        desk.directions.x[v] = gx * scale;
        desk.directions.y[v] = gy * scale;
        desk.directions.z[v] = gz * scale;
      }
}

// The rows of the brick within `reach` of a point: bit y + 8 z. The first loop has no branch, so that
// the compiler takes four layers at once.
std::uint64_t rows_near(const SurfacePoint& p, float reach) {
  std::array<int, kBrickEdge> from, end;  // of y, in each layer
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    const float dz = static_cast<float>(static_cast<int>(z)) - p.z, left = reach * reach - dz * dz;
    const float half = std::sqrt(left < 0 ? 0.0F : left);
    const float low = p.y - half > 0 ? p.y - half : 0.0F,
                high = p.y + half < kBrickEdge - 1 ? p.y + half : kBrickEdge - 1;
    const int whole = static_cast<int>(low),
              first = whole + (static_cast<float>(whole) < low ? 1 : 0);
    const bool any = (left >= 0) & (low <= high);
    from[z] = any ? first : 0;
    end[z] = any ? static_cast<int>(high) + 1 : 0;
  }
  std::uint64_t rows = 0;
  for (std::size_t z = 0; z < kBrickEdge; ++z)  // no row where from == end
    rows |= std::uint64_t{(1U << end[z]) - (1U << from[z])} << (kBrickEdge * z);
  return rows;
}

// Sums over the points for every voxel. The softer, the more points share: this removes noise and
// staircases but blunts edges. by_normal: points that face the other way do not count (thin walls
// of label maps).
void measure(float soft, bool by_normal, int law, SumPlanes sum_planes, Desk& desk) {
  if (by_normal) face(desk);
  for (int z = 0, v = 0; z < kBrickEdge; ++z)
    for (int y = 0; y < kBrickEdge; ++y)
      for (int x = 0; x < kBrickEdge; ++x, ++v)
        desk.sides[static_cast<std::size_t>(v)] =
            desk.level[static_cast<std::size_t>(at(x + kHalo, y + kHalo, z + kHalo))] >= 0 ? 1.0F
                                                                                           : -1.0F;
  PlaneRule rule;
  rule.soft = soft;
  rule.against = by_normal ? kAgainstLabels : kAgainstGrey;
  rule.sides = desk.sides.data();
  rule.directions = by_normal ? &desk.directions : nullptr;
  const float reach = law >= 2 && !by_normal && soft <= 1 ? kCleanReach : kReach;
  rule.reach_square = law == 1 ? kAll : reach * reach;
  if (law == 1) rule.against = kAll;
  // put each point into the lists of the rows that it counts for
  const std::size_t most = desk.points.size();
  if (desk.which.size() < most * desk.counts.size()) desk.which.resize(most * desk.counts.size());
  desk.counts.fill(0);
  for (std::size_t n = 0; n < most; ++n)
    for (std::uint64_t left = rows_near(desk.points[n], reach); left != 0; left &= left - 1) {
      const auto row = static_cast<std::size_t>(std::countr_zero(left));
      desk.which[row * most + desk.counts[row]++] = static_cast<std::uint16_t>(n);
    }
  for (int z = 0; z < kBrickEdge; ++z)
    for (int y = 0; y < kBrickEdge; ++y) {
      const auto row = static_cast<std::size_t>(y + kBrickEdge * z);
      sum_planes(desk.points.data(), desk.which.data() + row * most,
                 static_cast<int>(desk.counts[row]), y, z, rule, desk.sums);
    }
}

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

// Neighbours within 2.5 voxels, nearest first.
const std::vector<math::Ijk>& near_offsets() {
  static const std::vector<math::Ijk> all = [] {
    std::vector<math::Ijk> found;
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
          if (x * x + y * y + z * z > 0 && x * x + y * y + z * z <= 8) found.emplace_back(x, y, z);
    std::stable_sort(found.begin(), found.end(), [](const math::Ijk& a, const math::Ijk& b) {
      return a.squaredNorm() < b.squaredNorm();
    });
    return found;
  }();
  return all;
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

bool is_beyond(const InsideGrid& grid, const math::Ijk& p) {
  return p.minCoeff() < 0 || (p.array() >= grid.size.array()).any();
}

struct Target {
  Field* field = nullptr;
  TissueId* tissue = nullptr;
  std::int16_t* intensity = nullptr;
};

// Tissue of label maps: a voxel's own, or for air on the ramp that of the nearest solid voxel.
void label_tissue(const InsideGrid& grid, const math::Ijk& first, const Desk& desk,
                  const math::Ijk& room, const Target& to) {
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z),
                  a = at(x + kHalo, y + kHalo, z + kHalo);
        const std::uint8_t own = desk.labels[static_cast<std::size_t>(a)];
        TissueId id = grid.tissue[own];
        // a label that is not solid ends with the scan
        if (!grid.solid[own] && is_beyond(grid, first + math::Ijk(x, y, z))) id = 0;
        if (id == 0 && to.field[v] > 0)
          for (const math::Ijk& off : near_offsets()) {
            const std::uint8_t label =
                desk.labels[static_cast<std::size_t>(a + at(off.x(), off.y(), off.z()))];
            if (!grid.solid[label]) continue;
            id = grid.tissue[label];
            break;
          }
        to.tissue[v] = id;
      }
}

// To the nearest whole number, halves away from 0, like std::lround, but without a call.
std::int16_t nearest(double value) {
  const double bounded = std::clamp(value, -32768.0, 32767.0);
  const int whole = static_cast<int>(bounded);
  const double rest = bounded - whole;
  return static_cast<std::int16_t>(whole + static_cast<int>(rest >= 0.5) -
                                   static_cast<int>(rest <= -0.5));
}

// What a stored grey value means; made once for a scan, because there are fewer values than voxels.
class GreyTable {
 public:
  GreyTable(const InsideGrid& grid, const GreyTissue& rule) : grid_(grid), rule_(rule) {
    if (grid.grey == nullptr) return;
    constexpr int kValues = 65536;
    tissue_.resize(kValues);
    intensity_.resize(kValues);
    for (int v = 0; v < kValues; ++v) {
      const auto grey = static_cast<std::int16_t>(v - 32768);
      intensity_[static_cast<std::size_t>(v)] = intensity(level(grey));
      tissue_[static_cast<std::size_t>(v)] =
          rule.by_hu ? hu_tissue((level(grey) + double{grid.iso}) * rule.step + rule.zero)
                     : TissueId{1};
    }
  }
  [[nodiscard]] TissueId tissue(std::int16_t grey) const { return tissue_[index(grey)]; }
  // What the bone keeps of the value. beyond: the voxel lies beyond the scan; its value is as far
  // below the level as that of the last voxel above it, so that a scan written from this bone ends
  // in the same face.
  [[nodiscard]] std::int16_t intensity(std::int16_t grey, bool beyond) const {
    return beyond ? intensity(-std::abs(level(grey))) : intensity_[index(grey)];
  }

 private:
  static std::size_t index(std::int16_t grey) { return static_cast<std::size_t>(grey + 32768); }
  // the same rounding as in the block of a brick
  [[nodiscard]] double level(std::int16_t grey) const {
    return double{static_cast<float>(grey) - grid_.iso};
  }
  [[nodiscard]] std::int16_t intensity(double level) const {
    return nearest((double{grid_.iso} + level) * rule_.step + rule_.zero);
  }

  const InsideGrid& grid_;
  const GreyTissue& rule_;
  std::vector<TissueId> tissue_;
  std::vector<std::int16_t> intensity_;
};

// Writes the densest value within two voxels to desk.work_greys, one axis after the other.
void find_densest(Desk& desk) {
  const auto densest = [](const std::int16_t* from, int stride, std::int16_t* result) {
    for (int x = 0; x < kBrickEdge; ++x)
      result[x] = std::max({from[x], from[x - stride], from[x + stride], from[x - 2 * stride],
                            from[x + 2 * stride]});
  };
  constexpr int kFirst = kHalo, kEnd = kHalo + kBrickEdge;
  const auto along = [&](const auto& from, int stride, auto& to, int wider_y, int wider_z) {
    for (int z = kFirst - wider_z; z < kEnd + wider_z; ++z)
      for (int y = kFirst - wider_y; y < kEnd + wider_y; ++y) {
        const auto row = static_cast<std::size_t>(at(kFirst, y, z));
        densest(&from[row], stride, &to[row]);
      }
  };
  along(desk.greys, 1, desk.work_greys, 2, 2);
  along(desk.work_greys, kBlock, desk.most, 0, 2);
  along(desk.most, kPlane, desk.work_greys, 0, 0);
}

// Near the surface a voxel is only partly bone and its HU is too low, so the densest value within
// two voxels counts there.
void grey_tissue_of(const InsideGrid& grid, const GreyTable& table, const math::Ijk& first,
                    bool ramps, Desk& desk, const math::Ijk& room, const Target& to) {
  if (ramps) find_densest(desk);
  const bool any_beyond =
      is_beyond(grid, first) || is_beyond(grid, first + room - math::Ijk::Ones());
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z);
        const auto a = static_cast<std::size_t>(at(x + kHalo, y + kHalo, z + kHalo));
        const std::int16_t own = desk.greys[a];
        if (to.intensity != nullptr)
          to.intensity[v] =
              table.intensity(own, any_beyond && is_beyond(grid, first + math::Ijk(x, y, z)));
        const bool ramp = to.field[v] < volume::kSolid;
        to.tissue[v] =
            to.field[v] == 0 ? TissueId{0} : table.tissue(ramp && ramps ? desk.work_greys[a] : own);
      }
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

// Bricks with an inside voxel in them or within 3 voxels, or with a label to keep.
std::vector<std::uint8_t> bricks_needed(const InsideGrid& grid, const math::Ijk& bricks,
                                        Progress& progress, bool& cancelled) {
  const auto bx = static_cast<std::size_t>(bricks.x()), by = static_cast<std::size_t>(bricks.y()),
             bz = static_cast<std::size_t>(bricks.z());
  // for each layer of bricks: its own need, and what its two outer thirds mean for its neighbours
  std::vector<std::uint8_t> own(bx * by * bz), below(bx * by * bz), above(bx * by * bz);
  cancelled = !io::in_pieces(bricks.z(), progress, "looking for bone", [&](int layer) {
    std::vector<std::uint8_t> row(bx + 2);
    const int low = layer * kBrickEdge - grid.margin.z();
    for (int z = std::max(low, 0); z < std::min(low + kBrickEdge, grid.size.z()); ++z)
      for (int y = 0; y < grid.size.y(); ++y) {
        std::fill(row.begin(), row.end(), std::uint8_t{0});
        const std::size_t base =
            static_cast<std::size_t>(grid.size.x()) *
            (static_cast<std::size_t>(y) +
             static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(z));
        bool any = false;
        for (std::size_t b = 0; b < bx; ++b) {
          const int from = static_cast<int>(b) * kBrickEdge - grid.margin.x(),
                    n = std::min(kBrickEdge, grid.size.x() - from);
          unsigned in = 0, kept = 0;
          for (int x = std::max(0, -from); x < n; ++x) {
            const std::size_t v = base + static_cast<std::size_t>(from + x);
            in |= static_cast<unsigned>(grid.inside(v)) << x;
            if (grid.labels != nullptr)
              kept |= static_cast<unsigned>(grid.tissue[grid.labels[v]] != 0);
          }
          if (in == 0 && kept == 0) continue;
          any = true;
          row[b + 1] |= static_cast<std::uint8_t>((in != 0 ? 1 : 0) | (kept != 0 ? 2 : 0));
          if ((in & 0x07U) != 0) row[b] |= 1;      // within three voxels of the previous brick
          if ((in & 0xE0U) != 0) row[b + 2] |= 1;  // and of the next
        }
        if (!any) continue;
        const int row_y = y + grid.margin.y(), brick_y = row_y / kBrickEdge,
                  in_y = row_y % kBrickEdge, in_z = (z + grid.margin.z()) % kBrickEdge;
        for (int dy = -1; dy <= 1; ++dy) {
          if ((dy < 0 && in_y > 2) || (dy > 0 && in_y < 5)) continue;
          if (brick_y + dy < 0 || brick_y + dy >= bricks.y()) continue;
          const std::size_t line =
              bx * (static_cast<std::size_t>(brick_y + dy) + by * static_cast<std::size_t>(layer));
          for (std::size_t b = 0; b < bx; ++b) {
            const std::uint8_t said = dy == 0 ? row[b + 1] : row[b + 1] & 1;
            own[line + b] |= said;
            if (in_z < 3) below[line + b] |= said & 1;
            if (in_z > 4) above[line + b] |= said & 1;
          }
        }
      }
  });
  for (std::size_t z = 0; z < bz; ++z)
    for (std::size_t b = 0; b < bx * by; ++b) {
      if (z > 0) own[b + bx * by * z] |= above[b + bx * by * (z - 1)];
      if (z + 1 < bz) own[b + bx * by * z] |= below[b + bx * by * (z + 1)];
    }
  return own;
}

}  // namespace

SumPlanes sum_planes_kernel() noexcept {
  if constexpr (rt::kWideKernels)
    if (rt::simd() != rt::Simd::scalar) return avx2::sum_planes;
  return scalar::sum_planes;
}

void leave_margins(InsideGrid& inside) {
  // where the second layer is the first that is inside, the ramp still reaches beyond the border
  constexpr int kLayers = 2;
  const math::Ijk& n = inside.size;
  const auto any = [&inside, &n](const math::Ijk& from, const math::Ijk& to) {
    for (int z = from.z(); z < to.z(); ++z)
      for (int y = from.y(); y < to.y(); ++y) {
        const std::size_t row = static_cast<std::size_t>(n.x()) *
                                (static_cast<std::size_t>(y) +
                                 static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(z));
        for (int x = from.x(); x < to.x(); ++x)
          if (inside.inside(row + static_cast<std::size_t>(x))) return true;
      }
    return false;
  };
  for (int a = 0; a < 3; ++a) {
    math::Ijk low = n, high = math::Ijk::Zero();
    low[a] = std::min(kLayers, n[a]);
    high[a] = std::max(n[a] - kLayers, 0);
    inside.margin[a] = any(math::Ijk::Zero(), low) || any(high, n) ? kMargin : 0;
  }
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

std::vector<double> restore_tissue_volumes(Bone& bone, const std::vector<double>& wanted_voxels,
                                           int law) {
  // count voxels by tissue and field, in steps of 16: 1/1024 of a voxel of depth
  constexpr int kStep = 16, kBins = 65536 / kStep;
  const std::size_t tissues = bone.tissues().tissues.size();
  std::vector<std::vector<std::int64_t>> bins(tissues);
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const Field* field = bone.brick_field(b);
    if (field == nullptr) continue;
    const TissueId* tissue = bone.brick_tissue(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (field[v] == 0 || tissue[v] >= tissues) continue;
      auto& own = bins[tissue[v]];
      if (own.empty()) own.resize(kBins);
      ++own[field[v] / kStep];
    }
  }
  const auto volume_at = [&](std::size_t t, int shift) {
    std::int64_t sum = 0;
    for (int bin = 0; bin < kBins; ++bin) {
      const int field =
          bin == kBins - 1 ? 65535 : std::clamp(bin * kStep + kStep / 2 + shift, 0, 65535);
      sum += bins[t][static_cast<std::size_t>(bin)] * volume::volume_units(field);
    }
    return static_cast<double>(sum) / static_cast<double>(volume::kVoxelUnits);
  };
  // volume grows with the shift: bisection
  std::vector<int> shifts(tissues);
  const int most = static_cast<int>(0.35 * volume::kFieldPerVoxel);
  std::size_t largest = 0;
  for (std::size_t t = 1; t < tissues; ++t) {
    if (t >= wanted_voxels.size() || wanted_voxels[t] <= 0 || bins[t].empty()) continue;
    if (largest == 0 || wanted_voxels[t] > wanted_voxels[largest]) largest = t;
    int lo = -most, hi = most;
    while (hi - lo > 1) {
      const int middle = (lo + hi) / 2;
      (volume_at(t, middle) < wanted_voxels[t] ? lo : hi) = middle;
    }
    shifts[t] = std::abs(volume_at(t, lo) - wanted_voxels[t]) <
                        std::abs(volume_at(t, hi) - wanted_voxels[t])
                    ? lo
                    : hi;
  }
  // the ramp that reaches into soft labels moves with the largest solid, so that there is no step
  for (std::size_t t = 1; t < tissues; ++t)
    if (bone.tissues()[static_cast<TissueId>(t)].kind == volume::TissueKind::soft)
      shifts[t] = shifts[largest];
  // a voxel that the shift takes to the other side goes there only if no part comes or goes
  std::vector<Flip> flips;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    if (bone.brick_field(b) == nullptr || bone.is_uniform(b)) continue;
    Field* field = bone.build_field(b);
    const TissueId* tissue = bone.brick_tissue(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (field[v] == 0 || field[v] == volume::kSolid) continue;
      const int shift = shifts[tissue[v] < tissues ? tissue[v] : 0];
      const auto moved = static_cast<Field>(std::clamp(int{field[v]} + shift, 1, 65534));
      const bool inside = field[v] >= volume::kIso;
      if (law == 1 || inside == (moved >= volume::kIso)) {
        field[v] = moved;
        continue;
      }
      flips.push_back({bone.brick_ijk(b) + math::Ijk(v % 8, v / 8 % 8, v / 64), moved});
      field[v] = volume::field_from_depth(inside ? kBesideSurface : -kBesideSurface);
    }
  }
  settle(bone, flips);
  std::vector<double> moved(tissues);
  for (std::size_t t = 0; t < tissues; ++t) moved[t] = shifts[t] / volume::kFieldPerVoxel;
  return moved;
}

}  // namespace burr::importing
