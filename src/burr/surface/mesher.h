// surface/mesher.h - bricks of bone become patches of triangles, whole or only where it changed.
//
// Marching cubes (Lorensen & Cline 1987). A face of a cell whose solid corners lie across a
// diagonal is ambiguous; here they are always kept apart (the air between them is joined), a rule
// that gives both cells beside the face the same two lines. No triangle edge but these lines lies
// in a face of a cell, so every edge of the surface has exactly two triangles, for any field
// whatever. Outside the grid is air, and the surface is closed there too, half a voxel beyond the
// last solid voxel: the whole surface is a closed, oriented 2-manifold.
//
//     patch (p,q,r): the cells between voxels 16p-1 .. 16p+15 along i, and so on
//
// A vertex also knows what soft tissue is near behind it (shine_through): thin bone lets it through
// before it opens, and a hollow that soft tissue fills shows that tissue as its wall.
//
// Vertices stay 1/256 voxel away from the voxel centres, so that no triangle folds into a line.
// Thread: mesh_patch() from any number of workers at once while the servo cuts; each worker has its
// own Mesher. Two patches meshed while the servo cuts across their seam may differ there until both
// are made again; once the bone rests they meet bit for bit. Frame: grid in, world out.
// Memory: 0.9 MiB per Mesher. Cost: `burr bench surface`, `burr bench carve`.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::surface {

inline constexpr int kShineSteps = 12;  // of a look under the surface  [voxel]
// Bone as thick as this hides what lies under it [m], where voxels are `voxel` wide [m].
inline double shine_through(double voxel) { return std::min(1.5e-3, kShineSteps * voxel); }

class Mesher {
 public:
  explicit Mesher(const volume::Bone& bone);
  ~Mesher();
  Mesher(const Mesher&) = delete;
  Mesher& operator=(const Mesher&) = delete;

  [[nodiscard]] math::Ijk patches() const;  // along each axis
  [[nodiscard]] int patch_count() const;
  // Patches whose triangles or normals depend on a brick (at most 8): appended to `out`.
  void patches_of_brick(volume::BrickIndex brick, std::vector<int>& out) const;

  // The surface in the cells of one patch. False: the servo kept writing, try again next round;
  // `out` is then left as it was. Allocates only while `out` grows.
  [[nodiscard]] bool mesh_patch(int patch, Patch& out);

 private:
  friend Result<Mesh> whole_surface(const volume::Bone& bone, int threads, Progress& progress);
  struct Work;
  std::unique_ptr<Work> work_;
};

// The whole surface, seams welded; the same mesh for any number of threads. For export and first
// pictures; the bone must be at rest. Errors: Trouble::interrupted when the progress says so.
[[nodiscard]] Result<Mesh> whole_surface(const volume::Bone& bone, int threads, Progress& progress);

}  // namespace burr::surface
