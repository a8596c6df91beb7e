// Meshes as they are, with all their triangles. In place of render/coarse_mesh.cpp, which thins them
// with meshoptimizer; a page that is slow thins them when it draws (view_api.cpp, render/thin_patch.h).
#include <utility>

#include "burr/render/coarse_mesh.h"

namespace burr::render {

void JoinedMesh::add(const SkinMesh& patch) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), patch.vertices().begin(), patch.vertices().end());
  for (std::size_t n = 0; n < patch.index_count(); ++n) triangles.push_back(base + patch.index(n));
}

CoarseMesh coarser(JoinedMesh&& all, std::span<const double>) {
  CoarseMesh mesh;
  mesh.vertices = std::move(all.vertices);
  mesh.levels.push_back({0, std::move(all.triangles)});
  return mesh;
}

}  // namespace burr::render
