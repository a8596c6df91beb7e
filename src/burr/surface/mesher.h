// surface/mesher.h - bricks of bone become patches of triangles, whole or only where it changed.
//
// Marching cubes (Lorensen & Cline 1987) with the ambiguous faces decided the same way from both
// sides, so that patches meet without cracks: the surface is a closed manifold except where the
// volume ends. Thread: mesh_patch() from any number of workers at once while the servo cuts; each
// worker has its own Mesher. Frame: grid in, world out. Cost: see bench/surface.
#pragma once

#include <memory>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::surface {

class Mesher {
 public:
  explicit Mesher(const volume::Bone& bone);
  ~Mesher();
  Mesher(const Mesher&) = delete;
  Mesher& operator=(const Mesher&) = delete;

  [[nodiscard]] math::Ijk patches() const;  // along each axis
  [[nodiscard]] int patch_count() const;
  // Patches whose triangles or normals depend on a brick: appended to `out`, each once per call.
  void patches_of_brick(volume::BrickIndex brick, std::vector<int>& out) const;

  // The surface in the cells of one patch. False: the servo kept writing, try again next round.
  [[nodiscard]] bool mesh_patch(int patch, Patch& out);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

// The whole surface, seams welded; threads workers. For export and first pictures; the bone must be
// at rest.
[[nodiscard]] Result<Mesh> whole_surface(const volume::Bone& bone, int threads, Progress& progress);

}  // namespace burr::surface
