// surface/tissues_behind.h - which other tissue shows at a vertex of the surface: soft tissue under thin bone, soft tissue
// that fills the hollow at this wall, or the other solid tissue at a border. For use of this room only.
//
// Units: voxels, but for `reach`. Thread: the constructor before anything cuts; then any, while the servo cuts: only added
// material changes tissues, and that is solid.
#pragma once

#include <vector>

#include "burr/math/vec3.h"
#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::surface {

struct TissuesBehind {
  // shine_through: bone of this thickness hides what lies under it [m]; steps: of the search below the surface, at most
  TissuesBehind(const volume::Bone& from, double shine_through, int steps);

  // Whether a search from this patch's vertices can meet soft tissue at all. first: its voxel (0,0,0) in the grid.
  [[nodiscard]] bool any_soft_near(const math::Ijk& first) const;
  // Sets beneath, through and wall where there is something to see. n_grid: unit, out of the bone. Only if any_soft_near().
  void look_beneath(const math::Vec3& p_grid, const math::Vec3& n_grid, Vertex& v) const;
  // Sets beneath and through. voxel: the solid one beside the vertex.
  void look_aside(const math::Ijk& voxel, const math::Vec3& p_grid, Vertex& v) const;

  const volume::Bone& bone;
  std::vector<bool> soft;         // by TissueId
  std::vector<bool> soft_bricks;  // that hold soft tissue, and their neighbours; empty: none
  // with solid tissues of several kinds, or beside others; empty: none
  std::vector<bool> border_bricks;
  double reach;     // [m]
  int steps_below;  // [voxel]

 private:
  void find_soft();
  void find_borders();
};

}  // namespace burr::surface
