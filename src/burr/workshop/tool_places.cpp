#include "burr/workshop/tool_places.h"

#include <algorithm>

#include "burr/render/tool_mesh.h"

namespace burr::workshop {

std::vector<math::Vec3> places_on(const tool::Tool& tool, std::size_t count) {
  const surface::Mesh mesh = render::mesh_of(tool, tool::Role::cuts);
  const std::size_t step =
      std::max<std::size_t>(1, mesh.vertices.size() / std::max<std::size_t>(1, count));
  std::vector<math::Vec3> places;
  for (std::size_t n = 0; n < mesh.vertices.size(); n += step)
    places.push_back(mesh.vertices[n].p.cast<double>());
  return places;
}

}  // namespace burr::workshop
