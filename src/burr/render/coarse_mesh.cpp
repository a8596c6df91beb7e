#include "burr/render/coarse_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <map>

namespace burr::render {
namespace {

using Indices = std::vector<std::uint32_t>;

constexpr std::size_t kStride = sizeof(SkinVertex);

// Joins vertices that are equal to the bit.
void weld(JoinedMesh& all) {
  Indices to(all.vertices.size());
  const std::size_t different =
      meshopt_generateVertexRemap(to.data(), all.triangles.data(), all.triangles.size(),
                                  all.vertices.data(), all.vertices.size(), kStride);
  meshopt_remapIndexBuffer(all.triangles.data(), all.triangles.data(), all.triangles.size(),
                           to.data());
  std::vector<SkinVertex> vertices(different);
  meshopt_remapVertexBuffer(vertices.data(), all.vertices.data(), all.vertices.size(), kStride,
                            to.data());
  all.vertices = std::move(vertices);
}

// The triangles of one tissue, and those between two or more, which are never changed.
struct Groups {
  std::map<volume::TissueId, Indices> same;
  Indices mixed;
};

Groups by_tissue(const JoinedMesh& mesh) {
  Groups groups;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::uint32_t a = mesh.triangles[t], b = mesh.triangles[t + 1], c = mesh.triangles[t + 2];
    const volume::TissueId of = tissue_of(mesh.vertices[a]);
    const bool same = of == tissue_of(mesh.vertices[b]) && of == tissue_of(mesh.vertices[c]);
    Indices& into = same ? groups.same[of] : groups.mixed;
    into.insert(into.end(), {a, b, c});
  }
  return groups;
}

// Keeps only the vertices that the finest level needs, in the order in which it needs them.
void drop_unused(CoarseMesh& mesh) {
  if (mesh.levels.empty() || mesh.levels.front().indices.empty()) {
    mesh.vertices.clear();
    return;
  }
  Indices to(mesh.vertices.size());
  const Indices& finest = mesh.levels.front().indices;
  const std::size_t used = meshopt_optimizeVertexFetchRemap(to.data(), finest.data(), finest.size(),
                                                            mesh.vertices.size());
  std::vector<SkinVertex> vertices(mesh.vertices.size());
  meshopt_remapVertexBuffer(vertices.data(), mesh.vertices.data(), mesh.vertices.size(), kStride,
                            to.data());
  vertices.resize(used);
  vertices.shrink_to_fit();
  mesh.vertices = std::move(vertices);
  for (CoarseLevel& level : mesh.levels)
    for (std::uint32_t& index : level.indices) index = to[index];
}

}  // namespace

void JoinedMesh::add(const SkinMesh& patch) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), patch.vertices().begin(), patch.vertices().end());
  for (std::size_t n = 0; n < patch.index_count(); ++n) triangles.push_back(base + patch.index(n));
}

void JoinedMesh::add(const CoarseMesh& block) {
  if (block.levels.empty()) return;
  const auto base = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), block.vertices.begin(), block.vertices.end());
  for (const std::uint32_t index : block.levels.front().indices) triangles.push_back(base + index);
}

CoarseMesh coarser(JoinedMesh&& joined, std::span<const double> errors) {
  CoarseMesh out;
  JoinedMesh all = std::move(joined);
  if (all.triangles.empty()) return out;
  weld(all);
  const float* places = all.vertices.front().p.data();
  const std::size_t count = all.vertices.size();
  // meshoptimizer's errors are relative to the size of the mesh
  const double scale = static_cast<double>(meshopt_simplifyScale(places, count, kStride));
  Groups groups = by_tissue(all);
  Indices simpler;
  for (const double error : errors) {
    CoarseLevel level;
    level.error = error;
    level.indices = groups.mixed;
    for (auto& [tissue, triangles] : groups.same) {
      if (triangles.empty()) continue;
      simpler.resize(triangles.size());
      const std::size_t left = meshopt_simplify(
          simpler.data(), triangles.data(), triangles.size(), places, count, kStride, 0,
          static_cast<float>(error / scale), meshopt_SimplifyLockBorder, nullptr);
      triangles.assign(simpler.begin(), simpler.begin() + static_cast<std::ptrdiff_t>(left));
      level.indices.insert(level.indices.end(), triangles.begin(), triangles.end());
    }
    // an order in which the GPU transforms few vertices twice
    meshopt_optimizeVertexCache(level.indices.data(), level.indices.data(), level.indices.size(),
                                count);
    out.levels.push_back(std::move(level));
  }
  out.vertices = std::move(all.vertices);
  drop_unused(out);
  return out;
}

}  // namespace burr::render
