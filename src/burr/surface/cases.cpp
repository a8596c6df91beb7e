#include "burr/surface/cases.h"

#include <utility>
#include <vector>

#include "burr/base/check.h"

namespace burr::surface {
namespace {

using Loop = std::vector<int>;  // edges, in order

std::array<CellEdge, kCellEdges> make_edges() {
  std::array<CellEdge, kCellEdges> edges;
  std::size_t n = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 8; ++corner)
      if (((corner >> axis) & 1) == 0)
        edges[n++] = {axis, corner, corner & 1, (corner >> 1) & 1, corner >> 2};
  return edges;
}

int edge_between(int a, int b) {
  for (int e = 0; e < kCellEdges; ++e) {
    const CellEdge& edge = cell_edges()[static_cast<std::size_t>(e)];
    const int high = edge.low | 1 << edge.axis;
    if ((edge.low == a && high == b) || (edge.low == b && high == a)) return e;
  }
  BURR_CHECK(false);
}

// corners of the 6 faces, counter-clockwise seen from outside the cell
std::array<std::array<int, 4>, 6> make_faces() {
  std::array<std::array<int, 4>, 6> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    const int far = 1 << axis;
    faces[static_cast<std::size_t>(2 * axis)] = {v, u | v, u, 0};
    faces[static_cast<std::size_t>(2 * axis + 1)] = {far, far | u, far | u | v, far | v};
  }
  return faces;
}

bool share_a_face(int a, int b) {
  const auto side = [](int e, int axis) {  // 0 or 1; -1: runs along that axis
    const CellEdge& edge = cell_edges()[static_cast<std::size_t>(e)];
    return edge.axis == axis ? -1 : (edge.low >> axis) & 1;
  };
  for (int axis = 0; axis < 3; ++axis)
    if (side(a, axis) >= 0 && side(a, axis) == side(b, axis)) return true;
  return false;
}

// Each face is crossed by lines. A line cuts off one run of solid corners and keeps it on one side,
// so diagonal solid corners are kept apart. next[e]: the edge at which the line that starts at edge
// e ends.
std::array<int, kCellEdges> lines_of(int solid) {
  static const auto faces = make_faces();
  std::array<int, kCellEdges> next;
  next.fill(-1);
  const auto is_solid = [solid](int corner) { return ((solid >> corner) & 1) != 0; };
  for (const auto& face : faces)
    for (std::size_t m = 0; m < 4; ++m) {
      if (!is_solid(face[m]) || is_solid(face[(m + 1) % 4])) continue;
      std::size_t first = m;  // of this run of solid corners
      while (is_solid(face[(first + 3) % 4])) first = (first + 3) % 4;
      const int from = edge_between(face[(first + 3) % 4], face[first]);
      next[static_cast<std::size_t>(from)] = edge_between(face[m], face[(m + 1) % 4]);
    }
  return next;
}

// Cuts a loop into triangles so that no inner edge lies in a face of the cell: there it could
// coincide with an edge of the neighbour, and four triangles would share it.
bool triangulate(const Loop& loop, CellCase& out) {
  const std::size_t n = loop.size();
  if (n == 3) {
    std::size_t to = std::size_t{3} * out.count;
    for (const int e : loop) out.edge[to++] = static_cast<std::uint8_t>(e);
    ++out.count;
    return true;
  }
  for (std::size_t ear = 0; ear < n; ++ear) {
    const int a = loop[ear], b = loop[(ear + 1) % n], c = loop[(ear + 2) % n];
    if (share_a_face(a, c)) continue;
    const CellCase before = out;
    Loop rest = loop;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>((ear + 1) % n));
    if (triangulate({a, b, c}, out) && triangulate(rest, out)) return true;
    out = before;
  }
  return false;
}

std::array<CellCase, 256> make_cases() {
  std::array<CellCase, 256> cases;
  for (int solid = 0; solid < 256; ++solid) {
    auto next = lines_of(solid);
    for (std::size_t start = 0; start < kCellEdges; ++start) {
      Loop loop;
      for (int e = static_cast<int>(start); next[static_cast<std::size_t>(e)] >= 0;) {
        loop.push_back(e);
        e = std::exchange(next[static_cast<std::size_t>(e)], -1);
      }
      if (loop.empty()) continue;
      const bool cut = triangulate(loop, cases[static_cast<std::size_t>(solid)]);
      BURR_CHECK(cut);
    }
  }
  return cases;
}

}  // namespace

const std::array<CellEdge, kCellEdges>& cell_edges() {
  static const auto edges = make_edges();
  return edges;
}

const std::array<CellCase, 256>& cell_cases() {
  static const auto cases = make_cases();
  return cases;
}

}  // namespace burr::surface
