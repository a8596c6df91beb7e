// tests/surface/surface_bones.h - small bones from a formula, and the checks of a closed surface.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::test {

// depth: how far inside the material a point is, negative in air; p_grid and result in voxels.
inline std::unique_ptr<volume::Bone> bone_of(const volume::Grid& grid,
                                             const std::function<double(const math::Vec3&)>& depth,
                                             std::size_t reserve = 0) {
  std::vector<volume::Field> field;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        field.push_back(volume::field_from_depth(depth({double(i), double(j), double(k)})));
  return volume::bone_from_arrays(grid, {}, field, {}, {}, reserve);
}

// A grid that is rotated in the world.
inline volume::Grid askew(const math::Ijk& size, double voxel = 0.5e-3) {
  volume::Grid grid;
  grid.size = size;
  grid.voxel = voxel;
  grid.frame.p = {-0.031, 0.12, 0.047};
  grid.frame.q = math::Quat(Eigen::AngleAxisd(0.6, math::Vec3(1, 2, -0.5).normalized()));
  return grid;
}

struct Shape {
  std::size_t vertices = 0, edges = 0, triangles = 0;
  std::string trouble;  // the first violation of a closed, oriented manifold
  double volume = 0;    // enclosed  [m^3]
  [[nodiscard]] long euler() const {
    return static_cast<long>(vertices) - static_cast<long>(edges) + static_cast<long>(triangles);
  }
};

// Every edge must be used exactly once in each direction, every vertex must have one fan of
// triangles, and no two vertices may be at the same place.
inline Shape shape_of(const surface::Mesh& mesh) {
  Shape shape;
  shape.vertices = mesh.vertices.size();
  shape.triangles = mesh.triangles.size() / 3;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> walked;
  std::map<std::array<float, 3>, int> places;
  for (const surface::Vertex& v : mesh.vertices) ++places[{v.p.x(), v.p.y(), v.p.z()}];
  if (places.size() != mesh.vertices.size()) shape.trouble = "two vertices at one place";
  // next[v]: around v, from the neighbour of one triangle to that of the next
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::uint32_t* v = &mesh.triangles[t];
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = v[e], b = v[(e + 1) % 3], c = v[(e + 2) % 3];
      if (++walked[{a, b}] > 1) shape.trouble = "an edge is walked twice in one direction";
      next[a][b] = c;
    }
    math::Vec3 p[3];
    for (int i = 0; i < 3; ++i) p[i] = mesh.vertices[v[i]].p.cast<double>();
    shape.volume += p[0].dot(p[1].cross(p[2])) / 6;
  }
  for (const auto& [edge, times] : walked)
    if (!walked.contains({edge.second, edge.first})) shape.trouble = "an edge has one triangle";
  shape.edges = walked.size() / 2;
  for (const auto& fan : next) {
    if (fan.empty()) {
      shape.trouble = "a vertex has no triangle";
      continue;
    }
    std::size_t steps = 0;
    std::uint32_t at = fan.begin()->first;
    do {
      const auto to = fan.find(at);
      if (to == fan.end() || ++steps > fan.size()) break;
      at = to->second;
    } while (at != fan.begin()->first);
    if (steps != fan.size()) shape.trouble = "a vertex has more than one fan";
  }
  return shape;
}

}  // namespace burr::test
