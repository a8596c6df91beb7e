#include "burr/surface/enclosed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/surface/cases.h"

namespace burr::surface {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;

constexpr double kFromVoxel = 1.0 / 256;  // the mesh's vertices stay this far from voxel centres
constexpr int kBlock = kBrickEdge + 2;  // a brick's cells, and those before the grid's first voxel

// All air or all solid, as its neighbours after it: no surface passes through the brick's cells.
bool is_empty(const Bone& bone, const Ijk& brick) {
  const auto kind = [&bone](const Ijk& at) {  // 0 air, 1 solid, 2 mixed
    if ((at.array() >= bone.bricks().array()).any()) return 0;
    const BrickIndex b = bone.brick_at(at.x(), at.y(), at.z());
    const Field* field = bone.brick_field(b);
    if (field == nullptr) return 0;
    return !bone.is_uniform(b) ? 2 : field[0] == 0 ? 0 : 1;
  };
  const int own = kind(brick);
  if (own == 2 || (own == 1 && (brick.array() == 0).any())) return false;
  for (int n = 1; n < 8; ++n)
    if (kind(brick + Ijk(n & 1, n >> 1 & 1, n >> 2)) != own) return false;
  return true;
}

// The field around a brick, from one voxel before it to one behind; outside the grid is air.
struct Block {
  std::array<std::int32_t, std::size_t{kBlock} * kBlock * kBlock> field;
  Ijk first = Ijk::Zero();  // voxel of field[0]
  static std::size_t at(int x, int y, int z) {
    return static_cast<std::size_t>(x + kBlock * (y + kBlock * z));
  }
  void read(const Bone& bone, const Ijk& brick) {
    first = brick * kBrickEdge - Ijk::Ones();
    for (int z = 0; z < kBlock; ++z)
      for (int y = 0; y < kBlock; ++y)
        for (int x = 0; x < kBlock; ++x)
          field[at(x, y, z)] =
              std::int32_t{bone.field(first.x() + x, first.y() + y, first.z() + z)};
  }
};

struct Cell {
  Ijk low = Ijk::Zero();          // its first corner, as a voxel of the grid
  std::array<double, 8> depth{};  // of its corners
  int solid = 0;                  // its case
};

void use_cell(const Cell& cell, const Vec3& about, const UseTriangle& use) {
  const auto& edges = cell_edges();
  const CellCase& triangles = cell_cases()[static_cast<std::size_t>(cell.solid)];
  std::array<Vec3, kCellEdges> vertex;
  std::array<Ijk, kCellEdges> inside;
  for (std::size_t e = 0; e < kCellEdges; ++e) {
    const auto a = static_cast<std::size_t>(edges[e].low),
               b = a | std::size_t{1} << static_cast<std::size_t>(edges[e].axis);
    const bool in_low = cell.depth[a] >= 0;
    if (in_low == (cell.depth[b] >= 0)) continue;
    const double t =
        std::clamp(cell.depth[a] / (cell.depth[a] - cell.depth[b]), kFromVoxel, 1 - kFromVoxel);
    inside[e] = cell.low + Ijk(edges[e].x, edges[e].y, edges[e].z);
    vertex[e] = inside[e].cast<double>() - about;
    vertex[e][edges[e].axis] += t;
    if (!in_low) ++inside[e][edges[e].axis];
  }
  for (std::size_t t = 0; t < triangles.count; ++t) {
    const std::size_t a = triangles.edge[3 * t], b = triangles.edge[3 * t + 1],
                      c = triangles.edge[3 * t + 2];
    use(inside[a], vertex[a].dot(vertex[b].cross(vertex[c])) / 6);
  }
}

}  // namespace

void each_triangle_volume(const Bone& bone, const UseTriangle& use) {
  const Vec3 about = 0.5 * bone.grid().size.cast<double>();
  const Ijk& bricks = bone.bricks();
  Block block;
  for (int bz = 0; bz < bricks.z(); ++bz)
    for (int by = 0; by < bricks.y(); ++by)
      for (int bx = 0; bx < bricks.x(); ++bx) {
        const Ijk brick(bx, by, bz);
        if (is_empty(bone, brick)) continue;
        block.read(bone, brick);
        // cells that begin in the brick; those before the grid belong to its first bricks
        const Ijk from(bx == 0 ? 0 : 1, by == 0 ? 0 : 1, bz == 0 ? 0 : 1);
        for (int z = from.z(); z <= kBrickEdge; ++z)
          for (int y = from.y(); y <= kBrickEdge; ++y)
            for (int x = from.x(); x <= kBrickEdge; ++x) {
              Cell cell;
              for (int n = 0; n < 8; ++n)
                if (block.field[Block::at(x + (n & 1), y + (n >> 1 & 1), z + (n >> 2))] >=
                    volume::kIso)
                  cell.solid |= 1 << n;
              if (cell.solid == 0 || cell.solid == 255) continue;
              cell.low = block.first + Ijk(x, y, z);
              for (int n = 0; n < 8; ++n) {
                const auto c = static_cast<std::size_t>(n);
                cell.depth[c] =
                    block.field[Block::at(x + (n & 1), y + (n >> 1 & 1), z + (n >> 2))] -
                    double{volume::kIso};
              }
              use_cell(cell, about, use);
            }
      }
}

double enclosed_volume(const Bone& bone) {
  double voxels = 0;
  each_triangle_volume(bone, [&voxels](const Ijk&, double more) { voxels += more; });
  return voxels * std::pow(bone.grid().voxel, 3);
}

}  // namespace burr::surface
