// tests/support/mesh.h - closed meshes of bodies that have a formula, and their lattices.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "burr/tool/grid_of_mesh.h"
#include "burr/tool/shape.h"

namespace burr::test {

using math::Vec3;
using tool::keep_grid;
using tool::MeshGrid;
using tool::Shape;
using tool::ShapeKind;
using tool::Triangles;

inline Triangles box_mesh(const Vec3& half, const Vec3& middle) {
  Triangles mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.points.push_back(middle + Vec3(((corner & 1) != 0 ? 1 : -1) * half.x(),
                                        ((corner & 2) != 0 ? 1 : -1) * half.y(),
                                        ((corner & 4) != 0 ? 1 : -1) * half.z()));
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.faces.push_back({f[0], f[1], f[2]});
    mesh.faces.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

// Turned profile (r, z), closed at both ends on the axis.
inline Triangles turned(const std::vector<std::pair<double, double>>& profile, int around) {
  Triangles mesh;
  const auto last = static_cast<std::uint32_t>(profile.size() - 1);
  mesh.points.emplace_back(0, 0, profile.front().second);
  for (std::uint32_t ring = 1; ring < last; ++ring)
    for (int n = 0; n < around; ++n) {
      const double angle = 2 * M_PI * n / around;
      mesh.points.emplace_back(profile[ring].first * std::cos(angle),
                               profile[ring].first * std::sin(angle), profile[ring].second);
    }
  mesh.points.emplace_back(0, 0, profile.back().second);
  const auto at = [&](std::uint32_t ring, int n) {
    return 1 + (ring - 1) * static_cast<std::uint32_t>(around) +
           static_cast<std::uint32_t>(n % around);
  };
  const auto end = static_cast<std::uint32_t>(mesh.points.size() - 1);
  for (int n = 0; n < around; ++n) {
    mesh.faces.push_back({0, at(1, n + 1), at(1, n)});
    mesh.faces.push_back({end, at(last - 1, n), at(last - 1, n + 1)});
    for (std::uint32_t ring = 1; ring + 1 < last; ++ring) {
      mesh.faces.push_back({at(ring, n), at(ring, n + 1), at(ring + 1, n + 1)});
      mesh.faces.push_back({at(ring, n), at(ring + 1, n + 1), at(ring + 1, n)});
    }
  }
  return mesh;
}

inline Triangles ball_mesh(double radius) {
  std::vector<std::pair<double, double>> profile;
  for (int n = 0; n <= 96; ++n)
    profile.emplace_back(radius * std::sin(M_PI * n / 96), -radius * std::cos(M_PI * n / 96));
  return turned(profile, 192);
}

inline Shape grid_shape(const MeshGrid& grid) {
  Shape shape;
  shape.kind = ShapeKind::grid;
  shape.a = grid.cell;
  shape.grid = keep_grid(grid.cells);
  return shape;
}

// A cylinder of radius a and half length c, as a lattice; mesh and cell in one unit.
inline Shape cylinder_grid(double a, double c, double cell) {
  const auto grid = tool::grid_of(turned({{0, -c}, {a, -c}, {a, c}, {0, c}}, 192), cell);
  return grid.ok() ? grid_shape(*grid) : Shape{};
}

}  // namespace burr::test
