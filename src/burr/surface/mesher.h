// surface/mesher.h - turns bricks of bone into patches of triangles: the whole surface, or only
// where it changed.
//
// Marching cubes (Lorensen & Cline 1987). A face of a cell whose solid corners lie across a
// diagonal is ambiguous; here such corners are always kept apart (the air between them is joined),
// so both cells at the face get the same two lines. No other triangle edge lies in a face of a
// cell, so every edge of the surface has exactly two triangles, for any field. Outside the grid is
// air, and the surface is closed there too, half a voxel beyond the last solid voxel: the whole
// surface is a closed, oriented 2-manifold.
//
//     patch (p,q,r): the cells between voxels 16p-1 .. 16p+15 along i, and so on
//
// Each vertex also stores which soft tissue is close behind it (shine_through): thin bone shows it
// before it is opened, and the wall of a hollow that soft tissue fills shows that tissue.
//
// Vertices stay 1/256 voxel away from the voxel centres, so that no triangle degenerates to a line.
// Thread: mesh_patch() from any number of workers at once while the servo cuts; each worker has its
// own Mesher. Two patches that were meshed while the servo cut across their seam may differ there
// until both are rebuilt; when the bone no longer changes they meet bit for bit. Frame: grid in,
// world out. Memory: 0.9 MiB per Mesher. Cost: `burr bench surface`, `burr bench carve`.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::surface {

inline constexpr int kShineSteps = 12;  // of the search below the surface [voxel]
// Bone of this thickness hides what lies under it [m]. voxel: edge of a voxel [m].
inline double shine_through(double voxel) { return std::min(1.5e-3, kShineSteps * voxel); }

class Mesher {
 public:
  explicit Mesher(const volume::Bone& bone);
  ~Mesher();
  Mesher(const Mesher&) = delete;
  Mesher& operator=(const Mesher&) = delete;

  [[nodiscard]] math::Ijk patches() const;  // along each axis
  [[nodiscard]] int patch_count() const;
  // Appends to `out` the patches whose triangles or normals depend on this brick (at most 8).
  void patches_of_brick(volume::BrickIndex brick, std::vector<int>& out) const;

  // The surface in the cells of one patch. False: the servo kept writing; try again later. `out` is
  // then unchanged. Allocates only when `out` must grow.
  [[nodiscard]] bool mesh_patch(int patch, Patch& out);

 private:
  friend Result<Mesh> whole_surface(const volume::Bone& bone, int threads, Progress& progress);
  struct Work;
  std::unique_ptr<Work> work_;
};

// The whole surface, with seams welded; the same mesh for any number of threads. For export and for
// the first picture; nothing may write to the bone meanwhile. Errors: Trouble::interrupted if
// progress is cancelled.
[[nodiscard]] Result<Mesh> whole_surface(const volume::Bone& bone, int threads, Progress& progress);

}  // namespace burr::surface
