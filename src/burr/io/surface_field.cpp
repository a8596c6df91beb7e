#include "burr/io/surface_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "burr/io/workers.h"
#include "burr/volume/volume_of.h"

namespace burr::io {
namespace {

using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::TissueId;

// The neighbourhood of one brick that is looked at: 6 voxels on every side; of those 2 feed the
// blur, 1 the gradient, and 3 may hold points that reach into the brick.
constexpr int kHalo = 6, kBlock = kBrickEdge + 2 * kHalo, kPlane = kBlock * kBlock,
              kBlockVoxels = kPlane * kBlock;
constexpr float kReach = 3.0F;  // a point speaks to voxels this near [voxel]

constexpr int at(int x, int y, int z) { return x + kBlock * (y + kBlock * z); }

// How the planes of many points become one distance: weight 1 / (r^2 + soft)^4, r in voxels. The
// softer, the more points are averaged: noise and staircases ask for it, edges pay for it.
struct Blend {
  float soft;
  bool by_normal;  // points that face the other way do not count (thin walls of label maps)
};

struct Point {
  float x, y, z;     // in the block [voxel]
  float nx, ny, nz;  // unit, into the material
};

// Everything one worker needs; made once, used for thousands of bricks.
struct Sums {
  using Brick = std::array<float, volume::kBrickVoxels>;
  Brick weights, depths;               // of the points, of their planes' distances
  Brick nx, ny, nz;                    // of the normals
  Brick rx, ry, rz;                    // of the way from the points
  Brick facing_x, facing_y, facing_z;  // label maps: which way the material lies
};

struct Desk {
  std::array<float, kBlockVoxels> level;   // >= 0 inside, with the crossing by linear interpolation
  std::array<float, kBlockVoxels> smooth;  // what gradients are taken of
  std::array<float, kBlockVoxels> work;
  std::array<std::uint8_t, kBlockVoxels> labels;
  std::vector<Point> points;
  Sums sums;
  std::array<Field, volume::kBrickVoxels> field;  // the brick being made
  std::array<TissueId, volume::kBrickVoxels> tissue;
};

// Reads the block around a brick; beyond the border of the grid the last voxels go on.
// Returns: does it hold inside, outside voxels?
void fetch(const InsideGrid& grid, const math::Ijk& first, Desk& desk, bool& any_inside,
           bool& any_outside) {
  const auto nx = static_cast<std::size_t>(grid.size.x()),
             ny = static_cast<std::size_t>(grid.size.y());
  std::array<int, kBlock> xs{};
  for (int x = 0; x < kBlock; ++x)
    xs[static_cast<std::size_t>(x)] = std::clamp(first.x() + x - kHalo, 0, grid.size.x() - 1);
  any_inside = any_outside = false;
  for (int z = 0; z < kBlock; ++z) {
    const auto k =
        static_cast<std::size_t>(std::clamp(first.z() + z - kHalo, 0, grid.size.z() - 1));
    for (int y = 0; y < kBlock; ++y) {
      const auto j =
          static_cast<std::size_t>(std::clamp(first.y() + y - kHalo, 0, grid.size.y() - 1));
      const std::size_t row = nx * (j + ny * k);
      float* level = &desk.level[static_cast<std::size_t>(at(0, y, z))];
      std::uint8_t* label = &desk.labels[static_cast<std::size_t>(at(0, y, z))];
      float least = 1e30F, most = -1e30F;
      for (int x = 0; x < kBlock; ++x) {
        const std::size_t v = row + static_cast<std::size_t>(xs[static_cast<std::size_t>(x)]);
        if (grid.grey != nullptr) {
          level[x] = static_cast<float>(grid.grey[v]) - grid.iso;
        } else {
          label[x] = grid.labels[v];
          level[x] = grid.share != nullptr        ? static_cast<float>(grid.share[v]) - 127.5F
                     : grid.solid[grid.labels[v]] ? 127.5F
                                                  : -127.5F;
        }
        least = std::min(least, level[x]);
        most = std::max(most, level[x]);
      }
      any_inside = any_inside || most >= 0;
      any_outside = any_outside || least < 0;
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

// The points of the surface on edges of the grid near the brick.
void find_points(const InsideGrid& grid, const math::Ijk& first, Desk& desk) {
  desk.points.clear();
  const bool labels = grid.grey == nullptr;
  const float* s = desk.smooth.data();
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
    // a lone voxel has no slope: then the edge itself is the normal
    const float along = lb > la ? 1.0F : -1.0F;
    const float own = axis == 0 ? nx : axis == 1 ? ny : nz;
    if (!(length > 1e-6F) || own * along <= 0) {
      nx = axis == 0 ? along : 0;
      ny = axis == 1 ? along : 0;
      nz = axis == 2 ? along : 0;
      length = 1;
    }
    Point p{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
            nx / length,           ny / length,           nz / length};
    (axis == 0 ? p.x : axis == 1 ? p.y : p.z) += t;
    desk.points.push_back(p);
  };
  // edges on the far side of the grid's border do not exist
  constexpr int kFrom = kHalo - 3, kTo = kHalo + kBrickEdge + 2;
  const math::Ijk last =
      grid.size - first - math::Ijk::Ones();  // last voxel, counted from the brick
  const math::Ijk lo(std::max(kFrom, kHalo - first.x()), std::max(kFrom, kHalo - first.y()),
                     std::max(kFrom, kHalo - first.z()));
  const math::Ijk hi(std::min(kTo, kHalo + last.x()), std::min(kTo, kHalo + last.y()),
                     std::min(kTo, kHalo + last.z()));
  for (int z = lo.z(); z <= hi.z(); ++z)
    for (int y = lo.y(); y <= hi.y(); ++y)
      for (int x = lo.x(); x <= hi.x(); ++x) {
        const bool in = desk.level[static_cast<std::size_t>(at(x, y, z))] >= 0;
        if (x < hi.x() && (desk.level[static_cast<std::size_t>(at(x + 1, y, z))] >= 0) != in)
          add(x, y, z, 0);
        if (y < hi.y() && (desk.level[static_cast<std::size_t>(at(x, y + 1, z))] >= 0) != in)
          add(x, y, z, 1);
        if (z < hi.z() && (desk.level[static_cast<std::size_t>(at(x, y, z + 1))] >= 0) != in)
          add(x, y, z, 2);
      }
}

// Adds one point to the 8 voxels of a row of the brick. The lanes never mix, so the sums have one
// order whatever the processor.
template <bool ByNormal>
inline void speak(const Point& p, float soft, float dx0, float dy, float dz, Sums& sums,
                  std::size_t row) {
  const float rest = dy * dy + dz * dz + soft, plane = dy * p.ny + dz * p.nz;
  // rows of different sums never overlap
  float* __restrict weights = &sums.weights[row];
  float* __restrict depths = &sums.depths[row];
  float* __restrict nx = &sums.nx[row];
  float* __restrict ny = &sums.ny[row];
  float* __restrict nz = &sums.nz[row];
  float* __restrict rx = &sums.rx[row];
  float* __restrict ry = &sums.ry[row];
  float* __restrict rz = &sums.rz[row];
  const float* __restrict fx = &sums.facing_x[row];
  const float* __restrict fy = &sums.facing_y[row];
  const float* __restrict fz = &sums.facing_z[row];
  for (int x = 0; x < kBrickEdge; ++x) {
    const float dx = dx0 + static_cast<float>(x);
    float w = 1.0F / (dx * dx + rest);
    w *= w;
    w *= w;
    if (ByNormal) {
      const float facing = 0.5F + 0.5F * (p.nx * fx[x] + p.ny * fy[x] + p.nz * fz[x]);
      const float agree = facing > 0.0F ? facing : 0.0F;
      w *= agree * agree;
    }
    weights[x] += w;
    depths[x] += w * (dx * p.nx + plane);
    nx[x] += w * p.nx;
    ny[x] += w * p.ny;
    nz[x] += w * p.nz;
    rx[x] += w * dx;
    ry[x] += w * dy;
    rz[x] += w * dz;
  }
}

void measure(const Blend& blend, Desk& desk) {
  Sums& sums = desk.sums;
  for (auto* sum :
       {&sums.weights, &sums.depths, &sums.nx, &sums.ny, &sums.nz, &sums.rx, &sums.ry, &sums.rz})
    sum->fill(0);
  if (blend.by_normal) {
    // which way the material lies, and how surely: 0 in the middle of a thin wall
    for (int z = 0, v = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x, ++v) {
          const int a = at(x + kHalo, y + kHalo, z + kHalo);
          const float* s = desk.smooth.data();
          const float gx = s[a + 1] - s[a - 1], gy = s[a + kBlock] - s[a - kBlock],
                      gz = s[a + kPlane] - s[a - kPlane];
          const float length = std::sqrt(gx * gx + gy * gy + gz * gz);
          const float scale = 1.0F / std::max(length, 30.0F);
          const auto i = static_cast<std::size_t>(v);
          sums.facing_x[i] = gx * scale;
          sums.facing_y[i] = gy * scale;
          sums.facing_z[i] = gz * scale;
        }
  }
  for (const Point& p : desk.points) {
    const float px = p.x - kHalo, py = p.y - kHalo, pz = p.z - kHalo;
    if (px < -kReach || px > kBrickEdge - 1 + kReach) continue;
    const int z0 = std::max(0, static_cast<int>(std::ceil(pz - kReach))),
              z1 = std::min(kBrickEdge - 1, static_cast<int>(std::floor(pz + kReach)));
    const int y0 = std::max(0, static_cast<int>(std::ceil(py - kReach))),
              y1 = std::min(kBrickEdge - 1, static_cast<int>(std::floor(py + kReach)));
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y) {
        const float dy = static_cast<float>(y) - py, dz = static_cast<float>(z) - pz;
        if (dy * dy + dz * dz > kReach * kReach) continue;
        const auto row = static_cast<std::size_t>(kBrickEdge * (y + kBrickEdge * z));
        if (blend.by_normal)
          speak<true>(p, blend.soft, -px, dy, dz, sums, row);
        else
          speak<false>(p, blend.soft, -px, dy, dz, sums, row);
      }
  }
}

// Depth of a voxel from what the points said. The mean distance to tangent planes is too small by
// l^2 / 2R on a surface of radius R; the distance along the mean normal from the mean point is too
// large by as much: half of both is right to second order (a chord is square to the mean of the
// normals at its ends).
double depth_of(const Sums& sums, std::size_t v) {
  const double w = 1.0 / double{sums.weights[v]};
  const double planes = double{sums.depths[v]} * w;
  const double length =
      std::sqrt(double{sums.nx[v]} * double{sums.nx[v]} + double{sums.ny[v]} * double{sums.ny[v]} +
                double{sums.nz[v]} * double{sums.nz[v]});
  // in the middle of a thin wall the normals cancel and there is no mean one
  const double sure = length * w;
  if (sure < 0.6) return planes;
  const double along =
      (double{sums.nx[v]} * double{sums.rx[v]} + double{sums.ny[v]} * double{sums.ry[v]} +
       double{sums.nz[v]} * double{sums.rz[v]}) *
      w / length;
  const double share = std::min(1.0, (sure - 0.6) / 0.2);
  return planes + 0.5 * share * (along - planes);
}

// Neighbours within 2.5 voxels, the nearest first.
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

struct Target {
  Field* field = nullptr;
  TissueId* tissue = nullptr;
  std::int16_t* intensity = nullptr;
};

// Tissue of labels: its own, or on the ramp in air that of the nearest solid.
void label_tissue(const InsideGrid& grid, const Desk& desk, const math::Ijk& room,
                  const Target& to) {
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z),
                  a = at(x + kHalo, y + kHalo, z + kHalo);
        TissueId id = grid.tissue[desk.labels[static_cast<std::size_t>(a)]];
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

// Tissue by HU. Near the surface a voxel is only partly bone and its number too low: the densest
// within two voxels counts there.
TissueId hu_class(double hu) {
  return hu < 700 ? TissueId{1} : hu < 2000 ? TissueId{2} : TissueId{3};
}

void grey_tissue_of(const InsideGrid& grid, const GreyTissue& rule, const Desk& desk,
                    const math::Ijk& room, const Target& to) {
  // densest within two voxels, one axis after the other
  std::array<float, kBlockVoxels> most{}, work{};
  if (rule.by_hu) {
    most = desk.level;
    for (const int stride : {1, kBlock, kPlane}) {
      work = most;
      for (int v = 2 * stride; v < kBlockVoxels - 2 * stride; ++v) {
        const auto i = static_cast<std::size_t>(v), s = static_cast<std::size_t>(stride);
        most[i] = std::max({work[i], work[i - s], work[i + s], work[i - 2 * s], work[i + 2 * s]});
      }
    }
  }
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z);
        const auto a = static_cast<std::size_t>(at(x + kHalo, y + kHalo, z + kHalo));
        const double stored = double{desk.level[a]} + double{grid.iso};
        if (to.intensity != nullptr)
          to.intensity[v] = static_cast<std::int16_t>(
              std::lround(std::clamp(stored * rule.step + rule.zero, -32768.0, 32767.0)));
        if (to.field[v] == 0) {
          to.tissue[v] = 0;
        } else if (!rule.by_hu) {
          to.tissue[v] = 1;
        } else {
          const bool ramp = to.field[v] < volume::kSolid;
          const double densest = double{ramp ? most[a] : desk.level[a]} + double{grid.iso};
          to.tissue[v] = hu_class(densest * rule.step + rule.zero);
        }
      }
}

void fill_brick(const InsideGrid& grid, const GreyTissue& rule, const math::Ijk& first, Desk& desk,
                const Target& to) {
  bool any_inside = false, any_outside = false;
  fetch(grid, first, desk, any_inside, any_outside);
  const math::Ijk room = (grid.size - first).cwiseMin(kBrickEdge);
  const bool labels = grid.grey == nullptr;
  bool measured = false;
  if (any_inside && any_outside) {
    if (labels)
      blur(desk);
    else
      desk.smooth = desk.level;
    find_points(grid, first, desk);
    measured = !desk.points.empty();
    if (measured) measure({grid.soft, labels}, desk);
  }
  for (int z = 0; z < room.z(); ++z)
    for (int y = 0; y < room.y(); ++y)
      for (int x = 0; x < room.x(); ++x) {
        const int v = x + kBrickEdge * (y + kBrickEdge * z);
        const auto i = static_cast<std::size_t>(v);
        const bool in =
            desk.level[static_cast<std::size_t>(at(x + kHalo, y + kHalo, z + kHalo))] >= 0;
        double depth = in ? 10 : -10;
        if (measured && desk.sums.weights[i] > 1e-12F) {
          depth = depth_of(desk.sums, i);
          // where averaging would carry the surface past a voxel by much, a thin wall or gap is
          // meant: that one stays
          constexpr double kLeast = 0.02, kMuch = 0.4;
          if (in && depth < -kMuch) depth = kLeast;
          if (!in && depth > kMuch) depth = -kLeast;
        }
        to.field[v] = volume::field_from_depth(depth);
      }
  if (labels)
    label_tissue(grid, desk, room, to);
  else
    grey_tissue_of(grid, rule, desk, room, to);
}

// Bricks with an inside voxel in or within 3 voxels of them, or with a label to keep.
std::vector<std::uint8_t> bricks_needed(const InsideGrid& grid, const math::Ijk& bricks,
                                        Progress& progress, bool& cancelled) {
  const auto bx = static_cast<std::size_t>(bricks.x()), by = static_cast<std::size_t>(bricks.y()),
             bz = static_cast<std::size_t>(bricks.z());
  // per layer of bricks, what it has itself and what its two outer thirds say to its neighbours
  std::vector<std::uint8_t> own(bx * by * bz), below(bx * by * bz), above(bx * by * bz);
  cancelled = !in_pieces(bricks.z(), progress, "looking for bone", [&](int layer) {
    std::vector<std::uint8_t> row(bx + 2);
    for (int z = layer * kBrickEdge; z < std::min((layer + 1) * kBrickEdge, grid.size.z()); ++z)
      for (int y = 0; y < grid.size.y(); ++y) {
        std::fill(row.begin(), row.end(), std::uint8_t{0});
        const std::size_t base =
            static_cast<std::size_t>(grid.size.x()) *
            (static_cast<std::size_t>(y) +
             static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(z));
        bool any = false;
        for (std::size_t b = 0; b < bx; ++b) {
          const int from = static_cast<int>(b) * kBrickEdge,
                    n = std::min(kBrickEdge, grid.size.x() - from);
          unsigned in = 0, kept = 0;
          for (int x = 0; x < n; ++x) {
            const std::size_t v = base + static_cast<std::size_t>(from + x);
            in |= static_cast<unsigned>(grid.inside(v)) << x;
            if (grid.labels != nullptr)
              kept |= static_cast<unsigned>(grid.tissue[grid.labels[v]] != 0);
          }
          if (in == 0 && kept == 0) continue;
          any = true;
          row[b + 1] |= static_cast<std::uint8_t>((in != 0 ? 1 : 0) | (kept != 0 ? 2 : 0));
          if ((in & 0x07U) != 0) row[b] |= 1;      // within three of the neighbour before
          if ((in & 0xE0U) != 0) row[b + 2] |= 1;  // and of the one after
        }
        if (!any) continue;
        const int brick_y = y / kBrickEdge, in_y = y % kBrickEdge, in_z = z % kBrickEdge;
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

  // slots first and in order, so that the same scan gives the same bone whoever fills it
  std::vector<BrickIndex> list;
  list.reserve(used);
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    if (needed[static_cast<std::size_t>(b)] == 0) continue;
    list.push_back(b);
    bone->ensure_slot(b);
  }
  constexpr std::size_t kPortion = 64;
  const int portions = static_cast<int>((list.size() + kPortion - 1) / kPortion);
  const bool done = in_pieces(portions, progress, "finding the surface", [&](int portion) {
    thread_local std::unique_ptr<Desk> desk = std::make_unique<Desk>();
    const std::size_t from = static_cast<std::size_t>(portion) * kPortion;
    for (std::size_t n = from; n < std::min(list.size(), from + kPortion); ++n) {
      const Target made = {desk->field.data(), desk->tissue.data(),
                           bone->has_intensity() ? bone->build_intensity(list[n]) : nullptr};
      desk->field.fill(0);  // of voxels beyond the grid
      desk->tissue.fill(0);
      fill_brick(inside, grey_tissue, bone->brick_ijk(list[n]), *desk, made);
      // here, so that what is the same throughout never touches the room it was promised
      bone->build_brick(list[n], made.field, made.tissue);
    }
  });
  if (!done) return nullptr;
  bone->pack();
  return bone;
}

std::vector<double> keep_volumes(Bone& bone, const std::vector<double>& wanted_voxels) {
  // how many voxels of each tissue have which field, in steps of 16: 1/1024 of a voxel of depth
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
  // volume grows with the shift: halve the interval
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
  // the ramp reaching into soft labels moves with the largest solid, so that no step is left there
  for (std::size_t t = 1; t < tissues; ++t)
    if (bone.tissues()[static_cast<TissueId>(t)].kind == volume::TissueKind::soft)
      shifts[t] = shifts[largest];
  for (BrickIndex b = 0; b < bone.brick_count(); ++b) {
    if (bone.brick_field(b) == nullptr || bone.is_uniform(b)) continue;
    Field* field = bone.build_field(b);
    const TissueId* tissue = bone.brick_tissue(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v)
      if (field[v] > 0 && field[v] < volume::kSolid)
        field[v] = static_cast<Field>(
            std::clamp(int{field[v]} + shifts[tissue[v] < tissues ? tissue[v] : 0], 1, 65534));
  }
  std::vector<double> moved(tissues);
  for (std::size_t t = 0; t < tissues; ++t) moved[t] = shifts[t] / volume::kFieldPerVoxel;
  return moved;
}

}  // namespace burr::io
