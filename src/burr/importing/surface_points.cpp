#include "burr/importing/surface_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "burr/rt/lanes.h"

namespace burr::importing {
namespace {

using block::at;
using block::kBlock;
using block::kBlockVoxels;
using block::kHalo;
using block::kPlane;
using volume::kBrickEdge;

// How far the plane of a point may lie on the wrong side of a voxel for which it counts [voxel]: as
// far as noise and curvature move it; in label maps also as far as a stair does.
constexpr float kAgainstGrey = 0.4F, kAgainstLabels = 1.0F;
constexpr float kCleanReach = 2.5F;  // in a clean scan a few points give the surface [voxel]
constexpr float kAll = 1e30F;        // law 1: all points in the list of a row count

// Bit x: number x of a row of the block is not below 0.
std::uint32_t not_below_zero(const float* row) {
  static_assert(kBlock >= 16 && kBlock <= 32);
  rt::lanes::Floats low, high;
  rt::lanes::load(row, low);
  rt::lanes::load(row + kBlock - 16, high);
  return rt::lanes::bits_of(low >= 0.0F) | rt::lanes::bits_of(high >= 0.0F) << (kBlock - 16);
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

}  // namespace

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

}  // namespace burr::importing
