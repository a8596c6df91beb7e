// render/coarse_mesh.h - several patches or blocks together, with fewer triangles.
//
//     Joined all;
//     for (patch) all.add(patch);
//     CoarseMesh mesh = coarser(std::move(all), errors);
//
// Their rim stays as it is, edge by edge, and so does the border between two tissues: coarse
// patches meet their neighbours, coarse or not, without a crack, and no colour wanders. By edge
// collapses with quadric errors (Garland & Heckbert 1997), as meshoptimizer does them. Thread: any.
// Units: m; frame: world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "burr/render/skin_mesh.h"

namespace burr::render {

struct CoarseLevel {
  double error = 0;                    // about how far its surface is from what was joined  [m]
  std::vector<std::uint32_t> indices;  // (n x 3)
};

// Coarser and coarser, one for each of `errors` [m], which grow. All share the vertices.
struct CoarseMesh {
  std::vector<SkinVertex> vertices;  // as they are in the patches
  std::vector<CoarseLevel> levels;
};

// Meshes one after the other.
struct Joined {
  std::vector<SkinVertex> vertices;
  std::vector<std::uint32_t> triangles;  // (n x 3)

  void add(const SkinMesh& patch);
  void add(const CoarseMesh& block);  // its finest level
};

// Seams between what was joined are closed and no longer part of the rim.
[[nodiscard]] CoarseMesh coarser(Joined&& all, std::span<const double> errors);

}  // namespace burr::render
