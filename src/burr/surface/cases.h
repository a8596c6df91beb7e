// surface/cases.h - the 256 ways in which the surface can pass through a cell, as lists of
// triangles.
//
// The table is built at run time from the one rule of mesher.h instead of being typed in.
//
// corner c of a cell: x = c & 1, y = c >> 1 & 1, z = c >> 2; bit c of the case is set: solid
//     edge 4a + m: along axis a, from its m-th lower corner
#pragma once

#include <array>
#include <cstdint>

namespace burr::surface {

inline constexpr int kCellEdges = 12;
inline constexpr int kMostTriangles = 5;  // per cell; the test of the table checks it

struct CellEdge {
  int axis = 0;             // 0 x, 1 y, 2 z
  int low = 0;              // corner it starts at
  int x = 0, y = 0, z = 0;  // of that corner
};

struct CellCase {
  std::uint8_t count = 0;                               // of triangles
  std::array<std::uint8_t, 3 * kMostTriangles> edge{};  // (count x 3), counter-clockwise from air
};

[[nodiscard]] const std::array<CellEdge, kCellEdges>& cell_edges();
[[nodiscard]] const std::array<CellCase, 256>& cell_cases();

}  // namespace burr::surface
