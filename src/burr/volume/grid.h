// volume/grid.h - where the voxels are in the world.
//
// Frames: `ijk`: voxel indices; `p_grid`: real coordinates, voxel centres at whole numbers [voxel];
// world: LPS [m].
#pragma once

#include "burr/math/aabb.h"
#include "burr/math/pose.h"

namespace burr::volume {

struct Grid {
  math::Ijk size = {0, 0, 0};  // voxels along i, j, k
  double voxel = 1e-3;         // edge of a cubic voxel                                   [m]
  math::Pose frame;            // world_from_grid without the scale: centre of voxel (0,0,0), axes

  [[nodiscard]] math::Vec3 world_from_grid(const math::Vec3& p_grid) const {
    return frame * (p_grid * voxel);
  }
  [[nodiscard]] math::Vec3 grid_from_world(const math::Vec3& p) const {
    return (frame.q.conjugate() * (p - frame.p)) / voxel;
  }
  [[nodiscard]] bool contains(const math::Ijk& ijk) const {
    return (ijk.array() >= 0).all() && (ijk.array() < size.array()).all();
  }
  // Box around all voxel centres, in p_grid.
  [[nodiscard]] math::Aabb bounds_grid() const {
    return {math::Vec3::Zero(), (size - math::Ijk::Ones()).cast<double>()};
  }
};

}  // namespace burr::volume
