// tool/shape_grid.h - the lattices of distances behind shapes of the kind `grid`.
//
// A lattice is kept for as long as the program runs, once for equal content: tools are copied freely,
// also by the tick, and hold pointers to it. Distances are whole 256ths of a cell, so a recording
// holds them exactly. Nothing but keep_grid() makes a ShapeGrid.
//
// Units: cells. Frame: of the shape; the middle of the lattice is its origin. Thread: any but the tick.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tool/shape_kind.h"

namespace burr::tool {

inline constexpr int kPerCell = 256;        // units of GridCells::phi in a cell
inline constexpr int kMostNodes = 200'000;  // of a lattice
inline constexpr int kMostAlongAxis =
    1000;  // nodes; a distance across fits its 16 bits to 128 cells

// Signed distances to the surface of a body, below 0 inside.
struct GridCells {
  std::array<int, 3> size = {0, 0, 0};  // nodes along x, y, z
  std::vector<std::int16_t> phi;  // [cell / 256]; node (x, y, z): [(z size[1] + y) size[0] + x]
  bool operator==(const GridCells& other) const = default;
};

// Null where the cells describe no body: fewer than 4 nodes along an axis, too many in all, another
// number of values, a border node that is less than a cell outside, none inside, or neighbours that
// differ by more than their distance (by 1 % more: rounding).
[[nodiscard]] const ShapeGrid* keep_grid(const GridCells& cells);

[[nodiscard]] GridCells cells_of(const ShapeGrid& grid);

// Where the body's surface crosses the edges of the lattice, and a place of it in each cell, in blocks that lie together: what another
// tool meets (haptics/six/lattice_gap.h).  [cell]
struct GridPoints {
  struct Block {  // of kBlock cells along each axis; the ball holds all its points
    math::Vec3 middle = math::Vec3::Zero();
    double radius = 0;
    int first = 0, count = 0;  // of points; of a group: of blocks
  };
  static constexpr int kBlock = 4;  // cells along a block, blocks along a group
  std::vector<math::Vec3> points;
  std::vector<Block> blocks, groups;
};

// Of a lattice that keep_grid() returned, as all are. Thread: any, also the tick.
[[nodiscard]] const GridPoints& points_of(const ShapeGrid& grid) BURR_RT;

// Triangles of the body's surface, closed, counter-clockwise seen from outside: places where the
// distance changes its sign along the lattice's edges, joined by dual faces (surface nets: Gibson
// 1998, doi 10.1007/BFb0056277).
struct GridSurface {
  std::vector<math::Vec3> points;        // [cell]
  std::vector<std::uint32_t> triangles;  // three to a triangle
};
[[nodiscard]] GridSurface surface_of(const ShapeGrid& grid);

}  // namespace burr::tool
