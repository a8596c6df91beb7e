#include "burr/io/read/mesh_builder.h"

#include <fmt/core.h>

#include <cmath>

#include "burr/base/hash.h"
#include "burr/io/read/polygon.h"

namespace burr::io {

std::size_t MeshBuilder::Hash::operator()(const Place& place) const {
  std::uint64_t sum = 0;
  for (const float x : place) {
    sum = (sum ^ base::bits_of(x)) * 0x9E3779B97F4A7C15U;
    sum ^= sum >> 32;
  }
  return static_cast<std::size_t>(sum);
}

std::uint32_t MeshBuilder::point(const Place& place) {
  const Place same = {place[0] + 0.0F, place[1] + 0.0F, place[2] + 0.0F};  // -0 is 0
  const auto next = static_cast<std::uint32_t>(mesh_.points.size());
  const auto [at, is_new] = known_.try_emplace(same, next);
  if (is_new) mesh_.points.push_back(same);
  return at->second;
}

Status MeshBuilder::face(std::span<const Place> corners) {
  if (corners.size() < 3) return fine();  // points and lines hold no volume
  for (const Place& corner : corners)
    for (const float x : corner)
      if (!std::isfinite(x)) return error("the mesh has a point that is not a number");
  if (corners.size() > kMostCorners)
    return error(
        fmt::format("the mesh has a face with {} corners, burr reads up to {}; make "
                    "triangles of it with another program",
                    corners.size(), kMostCorners));
  for (const auto& [a, b, c] : triangles_of(corners)) {
    const std::array<std::uint32_t, 3> face = {point(corners[a]), point(corners[b]),
                                               point(corners[c])};
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    if (mesh_.faces.size() == kMostTriangles)
      return error(fmt::format(
          "the mesh has more than {} triangles; simplify it with another program", kMostTriangles));
    mesh_.faces.push_back(face);
  }
  return fine();
}

}  // namespace burr::io
