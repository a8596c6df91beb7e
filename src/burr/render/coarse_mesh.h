// render/coarse_mesh.h - joins several patches or blocks into one mesh with fewer triangles.
//
//     JoinedMesh all;
//     for (patch) all.add(patch);
//     CoarseMesh mesh = coarser(std::move(all), errors);
//
// The outer border of the joined mesh stays as it is, edge by edge, and so does the border between
// two tissues: coarse blocks meet their neighbours, coarse or not, without a crack, and no colour
// moves. Method: edge collapses with quadric errors (Garland & Heckbert 1997), as in meshoptimizer.
// Thread: any. Units: m; frame: world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "burr/render/skin_mesh.h"

namespace burr::render {

struct CoarseLevel {
  double error = 0;                    // approximate distance between its surface and the original
                                       // one [m]
  std::vector<std::uint32_t> indices;  // (n x 3)
};

// Levels of decreasing detail, one for each of `errors` [m], which increase. All share the
// vertices.
struct CoarseMesh {
  std::vector<SkinVertex> vertices;  // unchanged vertices of the patches
  std::vector<CoarseLevel> levels;
};

// Several meshes, one after the other.
struct JoinedMesh {
  std::vector<SkinVertex> vertices;
  std::vector<std::uint32_t> triangles;  // (n x 3)

  void add(const SkinMesh& patch);
  void add(const CoarseMesh& block);  // takes its finest level
};

// Seams between the joined meshes are closed and are no longer part of the border.
[[nodiscard]] CoarseMesh coarser(JoinedMesh&& all, std::span<const double> errors);

}  // namespace burr::render
