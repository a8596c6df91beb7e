#include "burr/workshop/mesh_shape.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "burr/base/printable.h"
#include "burr/io/read/read_mesh.h"
#include "burr/tool/grid_of_mesh.h"

namespace burr::workshop {

Result<scenario::MeshShape> mesh_shape(const scenario::MeshWish& wish) {
  const auto read = io::read_mesh(wish.path);
  if (!read) return read.error();
  const std::string name = base::printable(std::filesystem::path(wish.path).filename().string());
  tool::Triangles mesh;
  mesh.faces = read->faces;
  for (const auto& [x, y, z] : read->points)
    mesh.points.emplace_back(wish.m_per_unit * math::Vec3(x, y, z));
  const auto grid = tool::grid_of(mesh, wish.cell_m, wish.turns);
  if (!grid) return error(fmt::format("{}: the mesh {}", name, grid.error().text));
  const double whole = std::abs(tool::volume_inside(mesh));
  if (std::abs(grid->volume - whole) > kMostVolumeOff * whole)
    return error(fmt::format(
        "{}: cells of {:.2f} mm are too coarse for this mesh: its volume is {:.2f} mm3, and {:.2f} "
        "mm3 on them; give a smaller cell_mm, or make thin places thicker",
        name, 1e3 * grid->cell, 1e9 * whole, 1e9 * grid->volume));
  scenario::MeshShape out;
  out.shape.kind = tool::ShapeKind::grid;
  out.shape.a = grid->cell;
  out.shape.grid = tool::keep_grid(grid->cells);
  out.middle = grid->middle;
  return out;
}

}  // namespace burr::workshop
