#include "burr/volume/sample.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"

namespace burr::volume {
namespace {

// The cell that contains a point, and the place in it.
struct Cell {
  int i = 0, j = 0, k = 0;     // its first voxel
  double u = 0, v = 0, w = 0;  // 0..1
  bool near_grid = false;      // false: only air around
};

Cell cell_of(const Bone& bone, const math::Vec3& p_grid) noexcept {
  Cell cell;
  const math::Ijk& size = bone.grid().size;
  // false for NaN too
  for (int a = 0; a < 3; ++a)
    if (!(p_grid[a] > -2.0 && p_grid[a] < size[a] + 1.0)) return cell;
  const double i = std::floor(p_grid.x()), j = std::floor(p_grid.y()), k = std::floor(p_grid.z());
  cell = {static_cast<int>(i),
          static_cast<int>(j),
          static_cast<int>(k),
          p_grid.x() - i,
          p_grid.y() - j,
          p_grid.z() - k,
          true};
  return cell;
}

// The voxels -1 .. +2 around a cell, (4 x 4 x 4), x fastest, without the outermost corners and
// edges, which no central difference uses; read row by row from at most eight bricks.
struct Neighbourhood {
  double voxel[64];

  Neighbourhood(const Bone& bone, const Cell& cell) noexcept {
    const math::Ijk first(cell.i - 1, cell.j - 1, cell.k - 1);
    const math::Ijk& bricks = bone.bricks();
    const int bi = first.x() >> 3, bj = first.y() >> 3, bk = first.z() >> 3;
    const int in_x = first.x() & 7, split = 8 - in_x;  // voxels of a row in its first brick
    const auto brick_of = [&](int i, int j, int k) -> const Field* {
      const bool in =
          i >= 0 && j >= 0 && k >= 0 && i < bricks.x() && j < bricks.y() && k < bricks.z();
      return in ? bone.brick_field(bone.brick_at(i, j, k)) : nullptr;  // nullptr: air
    };
    const Field* brick[2][2][2] = {};  // [z][y][x]
    const int more_x = split < 4 ? 1 : 0, more_y = (first.y() & 7) > 4 ? 1 : 0,
              more_z = (first.z() & 7) > 4 ? 1 : 0;
    for (int z = 0; z <= more_z; ++z)
      for (int y = 0; y <= more_y; ++y)
        for (int x = 0; x <= more_x; ++x) brick[z][y][x] = brick_of(bi + x, bj + y, bk + z);
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y) {
        const bool outer_y = y == 0 || y == 3, outer_z = z == 0 || z == 3;
        if (outer_y && outer_z) continue;
        const int j = first.y() + y, k = first.z() + z;
        const auto& pair = brick[(k >> 3) - bk][(j >> 3) - bj];
        const int row = 8 * ((j & 7) + 8 * (k & 7));
        double* to = voxel + 4 * (y + 4 * z);
        if (more_x == 0) {
          const Field* from = pair[0];
          for (int x = 0; x < 4; ++x) to[x] = from == nullptr ? 0 : from[row + in_x + x];
        } else {
          for (int x = 0; x < 4; ++x) {
            const Field* from = x < split ? pair[0] : pair[1];
            to[x] = from == nullptr ? 0 : from[row + ((in_x + x) & 7)];
          }
        }
      }
  }
};

double mix(double a, double b, double t) noexcept { return a + t * (b - a); }

// full scale is 65536, so that the surface, 32768, is exactly one half
constexpr double kShare = 1.0 / 65536.0;

}  // namespace

double sample(const Bone& bone, const math::Vec3& p_grid) BURR_RT {
  const Cell c = cell_of(bone, p_grid);
  if (!c.near_grid) return 0;
  double corner[8];
  if (bone.grid().contains({c.i, c.j, c.k}) && (c.i & 7) < 7 && (c.j & 7) < 7 && (c.k & 7) < 7) {
    const Field* brick = bone.brick_field(bone.brick_at(c.i >> 3, c.j >> 3, c.k >> 3));
    if (brick == nullptr) return 0;
    const Field* at = brick + (c.i & 7) + 8 * ((c.j & 7) + 8 * (c.k & 7));
    for (int n = 0; n < 8; ++n) corner[n] = at[(n & 1) + 8 * ((n >> 1) & 1) + 64 * (n >> 2)];
  } else {
    for (int n = 0; n < 8; ++n)
      corner[n] = bone.field(c.i + (n & 1), c.j + ((n >> 1) & 1), c.k + (n >> 2));
  }
  const double y0 = mix(mix(corner[0], corner[1], c.u), mix(corner[2], corner[3], c.u), c.v);
  const double y1 = mix(mix(corner[4], corner[5], c.u), mix(corner[6], corner[7], c.u), c.v);
  return kShare * mix(y0, y1, c.w);
}

Sample sample_with_slope(const Bone& bone, const math::Vec3& p_grid) BURR_RT {
  Sample out;
  const Cell c = cell_of(bone, p_grid);
  if (!c.near_grid) return out;
  const Neighbourhood f(bone, c);
  double value = 0, slope_x = 0, slope_y = 0, slope_z = 0;
  for (int z = 1; z <= 2; ++z)
    for (int y = 1; y <= 2; ++y) {
      const double across = (y == 2 ? c.v : 1 - c.v) * (z == 2 ? c.w : 1 - c.w);
      const double* at = f.voxel + 1 + 4 * (y + 4 * z);
      const double near = across * (1 - c.u), far = across * c.u;
      value += near * at[0] + far * at[1];
      slope_x += near * (at[1] - at[-1]) + far * (at[2] - at[0]);
      slope_y += near * (at[4] - at[-4]) + far * (at[5] - at[-3]);
      slope_z += near * (at[16] - at[-16]) + far * (at[17] - at[-15]);
    }
  out.value = kShare * value;
  out.slope = 0.5 * kShare * math::Vec3(slope_x, slope_y, slope_z);
  return out;
}

math::Vec3 gradient(const Bone& bone, const math::Vec3& p_grid) BURR_RT {
  return sample_with_slope(bone, p_grid).slope;
}

math::Vec3 normal(const Bone& bone, const math::Vec3& p_grid) BURR_RT {
  const math::Vec3 inwards = gradient(bone, p_grid);
  const double steepness = math::norm(inwards);
  if (!(steepness > 0)) return math::Vec3::Zero();
  return bone.grid().frame.q * (inwards / -steepness);
}

double depth_at(const Bone& bone, const math::Vec3& p) BURR_RT {
  const Grid& grid = bone.grid();
  return (sample(bone, grid.grid_from_world(p)) - kIsoShare) * 2 * kRamp * grid.voxel;
}

}  // namespace burr::volume
