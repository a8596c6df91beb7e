#include "burr/tool/shape_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <utility>

#include "burr/tool/shape.h"

namespace burr::tool {
namespace {

using math::Vec3;

struct WithPoints : ShapeGrid {
  GridPoints points;
};

struct Kept {
  GridCells cells;
  std::vector<float> phi;
  WithPoints grid;
};

std::size_t node(const std::array<int, 3>& size, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
          static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(size[0]) +
         static_cast<std::size_t>(x);
}

// Calls one(x, y, z, value) for every node.
template <class One>
void each_node(const GridCells& cells, const One& one) {
  std::size_t at = 0;
  for (int z = 0; z < cells.size[2]; ++z)
    for (int y = 0; y < cells.size[1]; ++y)
      for (int x = 0; x < cells.size[0]; ++x) one(x, y, z, int{cells.phi[at++]});
}

bool has_sizes(const GridCells& cells) {
  std::int64_t nodes = 1;
  for (const int n : cells.size) {
    if (n < 4 || n > kMostAlongAxis) return false;
    nodes *= n;
  }
  return nodes <= kMostNodes && cells.phi.size() == static_cast<std::size_t>(nodes);
}

bool is_body(const GridCells& cells) {
  if (!has_sizes(cells)) return false;
  bool good = true, inside = false;
  const std::array<std::size_t, 3> next = {1, static_cast<std::size_t>(cells.size[0]),
                                           node(cells.size, 0, 0, 1)};
  each_node(cells, [&](int x, int y, int z, int value) {
    const std::array<int, 3> at = {x, y, z};
    inside = inside || value < 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool border = at[axis] == 0 || at[axis] == cells.size[axis] - 1;
      if (border && value < kPerCell) good = false;
      if (at[axis] + 1 >= cells.size[axis]) continue;
      const int other = cells.phi[node(cells.size, x, y, z) + next[axis]];
      if (std::abs(other - value) > kPerCell + kPerCell / 100 + 1) good = false;
    }
  });
  return good && inside;
}

// The box around all places where the linear field is 0: it is farthest on the lattice's edges. And the
// deepest node.
void measure(const GridCells& cells, ShapeGrid& grid) {
  const Vec3 middle = 0.5 * Vec3(cells.size[0] - 1, cells.size[1] - 1, cells.size[2] - 1);
  Vec3 lo = middle, hi = -middle;
  each_node(cells, [&](int x, int y, int z, int value) {
    if (value > 0) return;
    const std::array<int, 3> ijk = {x, y, z};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1}) {  // no node inside is at the border
        std::array<int, 3> next = ijk;
        next[axis] += way;
        const double other = cells.phi[node(cells.size, next[0], next[1], next[2])];
        const double reach = other > 0 ? -value / (other - value) : 0;
        const int at_axis = static_cast<int>(axis);
        const double end = ijk[axis] + way * reach - middle[at_axis];
        lo[at_axis] = std::min(lo[at_axis], end);
        hi[at_axis] = std::max(hi[at_axis], end);
      }
    grid.deepest = std::max(grid.deepest, -1.0 * value / kPerCell);
  });
  for (int axis = 0; axis < 3; ++axis) {
    grid.lo[axis] = lo[axis];
    grid.hi[axis] = hi[axis];
  }
}

GridPoints::Block ball_around(const std::vector<Vec3>& points, std::size_t first) {
  GridPoints::Block block;
  Vec3 lo = points[first], hi = lo;
  for (std::size_t n = first; n < points.size(); ++n) {
    lo = lo.cwiseMin(points[n]);
    hi = hi.cwiseMax(points[n]);
  }
  block.middle = 0.5 * (lo + hi);
  for (std::size_t n = first; n < points.size(); ++n)
    block.radius = std::max(block.radius, (points[n] - block.middle).norm());
  return block;
}

// The middle of what crosses a cell's edges, on the surface. A small tool would sink between the
// crossings alone, which are up to a cell and a half apart.
void find_middle(const Kept& kept, const std::array<int, 3>& cell, GridPoints& out) {
  const auto& size = kept.cells.size;
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) continue;
      const std::array<int, 3> low = {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
                                      cell[2] + (corner >> 2)};
      std::array<int, 3> high = low;
      ++high[axis];
      const double a = kept.cells.phi[node(size, low[0], low[1], low[2])],
                   b = kept.cells.phi[node(size, high[0], high[1], high[2])];
      if ((a < 0) == (b < 0)) continue;
      Vec3 at(low[0], low[1], low[2]);
      at[static_cast<int>(axis)] += a / (a - b);
      sum += at;
      ++count;
    }
  if (count == 0) return;
  Vec3 p = sum / count - 0.5 * Vec3(size[0] - 1, size[1] - 1, size[2] - 1);
  Shape shape;
  shape.kind = ShapeKind::grid;
  shape.a = 1;
  shape.grid = &kept.grid;
  for (int step = 0; step < 3; ++step) {
    const Distance there = distance(shape, p);
    p -= there.phi * there.gradient;
  }
  out.points.push_back(p);
}

// In a block of cells: the crossings on the edges that begin there, and the middle of each cell.
void find_points(const Kept& kept, const std::array<int, 3>& begin, GridPoints& out) {
  const GridCells& cells = kept.cells;
  const auto& size = cells.size;
  const Vec3 middle = 0.5 * Vec3(size[0] - 1, size[1] - 1, size[2] - 1);
  std::array<int, 3> end{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    end[axis] = std::min(begin[axis] + GridPoints::kBlock, size[axis]);
  const std::size_t first = out.points.size();
  for (int z = begin[2]; z < end[2]; ++z)
    for (int y = begin[1]; y < end[1]; ++y)
      for (int x = begin[0]; x < end[0]; ++x)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<int, 3> next = {x, y, z};
          if (++next[axis] >= size[axis]) continue;
          const double here = cells.phi[node(size, x, y, z)],
                       there = cells.phi[node(size, next[0], next[1], next[2])];
          if ((here < 0) == (there < 0)) continue;
          Vec3 at(x, y, z);
          at[static_cast<int>(axis)] += here / (here - there);
          out.points.emplace_back(at - middle);
        }
  for (int z = begin[2]; z < std::min(end[2], size[2] - 1); ++z)
    for (int y = begin[1]; y < std::min(end[1], size[1] - 1); ++y)
      for (int x = begin[0]; x < std::min(end[0], size[0] - 1); ++x)
        find_middle(kept, {x, y, z}, out);
  if (out.points.size() == first) return;
  GridPoints::Block block = ball_around(out.points, first);
  block.first = static_cast<int>(first);
  block.count = static_cast<int>(out.points.size() - first);
  out.blocks.push_back(block);
}

GridPoints find_points(const Kept& kept) {
  GridPoints out;
  constexpr int kBlock = GridPoints::kBlock, kGroup = kBlock * kBlock;
  const auto& size = kept.cells.size;
  for (int gz = 0; gz < size[2]; gz += kGroup)
    for (int gy = 0; gy < size[1]; gy += kGroup)
      for (int gx = 0; gx < size[0]; gx += kGroup) {
        const std::size_t point = out.points.size(), first = out.blocks.size();
        for (int z = gz; z < std::min(gz + kGroup, size[2]); z += kBlock)
          for (int y = gy; y < std::min(gy + kGroup, size[1]); y += kBlock)
            for (int x = gx; x < std::min(gx + kGroup, size[0]); x += kBlock)
              find_points(kept, {x, y, z}, out);
        if (out.blocks.size() == first) continue;
        GridPoints::Block group = ball_around(out.points, point);
        group.first = static_cast<int>(first);
        group.count = static_cast<int>(out.blocks.size() - first);
        out.groups.push_back(group);
      }
  return out;
}

}  // namespace

const GridPoints& points_of(const ShapeGrid& grid) BURR_RT {
  return static_cast<const WithPoints&>(grid).points;
}

const ShapeGrid* keep_grid(const GridCells& cells) {
  if (!is_body(cells)) return nullptr;
  static std::mutex mutex;
  static auto& all = *new std::deque<Kept>;  // never destroyed: tools may outlive any order of ends
  const std::lock_guard lock(mutex);
  for (const Kept& one : all)
    if (one.cells == cells) return &one.grid;
  Kept& kept = all.emplace_back();
  kept.cells = cells;
  kept.phi.reserve(cells.phi.size());
  for (const std::int16_t value : cells.phi)
    kept.phi.push_back(static_cast<float>(value) / static_cast<float>(kPerCell));
  std::copy(cells.size.begin(), cells.size.end(), kept.grid.size);
  kept.grid.phi = kept.phi.data();
  measure(kept.cells, kept.grid);
  kept.grid.points = find_points(kept);
  return &kept.grid;
}

GridCells cells_of(const ShapeGrid& grid) {
  GridCells cells;
  std::copy(grid.size, grid.size + 3, cells.size.begin());
  const std::size_t count = node(cells.size, 0, 0, grid.size[2]);
  cells.phi.reserve(count);
  for (std::size_t n = 0; n < count; ++n)
    cells.phi.push_back(static_cast<std::int16_t>(std::lround(grid.phi[n] * kPerCell)));
  return cells;
}

GridSurface surface_of(const ShapeGrid& grid) {
  GridSurface out;
  const GridCells cells = cells_of(grid);
  const auto& size = cells.size;
  const Vec3 middle = 0.5 * Vec3(size[0] - 1, size[1] - 1, size[2] - 1);
  const auto value = [&](int x, int y, int z) -> double { return cells.phi[node(size, x, y, z)]; };
  // one point in every cell that the surface crosses: the mean of its crossings of the cell's edges
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::uint32_t> point(cells.phi.size(), kNone);
  for (int z = 0; z + 1 < size[2]; ++z)
    for (int y = 0; y + 1 < size[1]; ++y)
      for (int x = 0; x + 1 < size[0]; ++x) {
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for (int corner = 0; corner < 8; ++corner)
          for (int axis = 0; axis < 3; ++axis) {
            if (((corner >> axis) & 1) != 0) continue;
            std::array<int, 3> low = {x + (corner & 1), y + ((corner >> 1) & 1), z + (corner >> 2)};
            std::array<int, 3> high = low;
            ++high[static_cast<std::size_t>(axis)];
            const double a = value(low[0], low[1], low[2]), b = value(high[0], high[1], high[2]);
            if ((a < 0) == (b < 0)) continue;
            Vec3 at(low[0], low[1], low[2]);
            at[axis] += a / (a - b);
            sum += at;
            ++count;
          }
        if (count == 0) continue;
        point[node(size, x, y, z)] = static_cast<std::uint32_t>(out.points.size());
        out.points.emplace_back(sum / count - middle);
      }
  // a face for every crossed edge of the lattice, between the four cells around it
  for (int z = 1; z + 1 < size[2]; ++z)
    for (int y = 1; y + 1 < size[1]; ++y)
      for (int x = 1; x + 1 < size[0]; ++x)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<int, 3> next = {x, y, z};
          ++next[axis];
          const bool inside = value(x, y, z) < 0;
          if (inside == (value(next[0], next[1], next[2]) < 0)) continue;
          std::array<std::array<int, 3>, 4> around;
          around.fill({x, y, z});
          const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          --around[0][u], --around[0][v];
          --around[1][v];
          --around[3][u];
          std::array<std::uint32_t, 4> face;
          for (std::size_t n = 0; n < 4; ++n)
            face[n] = point[node(size, around[n][0], around[n][1], around[n][2])];
          if (!inside) std::swap(face[1], face[3]);
          out.triangles.insert(out.triangles.end(),
                               {face[0], face[1], face[2], face[0], face[2], face[3]});
        }
  return out;
}

}  // namespace burr::tool
