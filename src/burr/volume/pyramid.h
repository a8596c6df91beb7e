// volume/pyramid.h - lowest and highest field value of every brick, of every eight bricks, and so
// on up to one node for the whole bone. Answers "is there surface in this box" without reading
// voxels (the octree of the thesis).
//
//     level 0   1 brick      8 voxels a side
//     level 1   8 bricks    16 voxels
//     ...       top: one node
//
// The writer keeps it up to date: after bone.write_brick(b, ...), call pyramid.update(b).
// Thread: the writer's, or before the session. Memory: 4 B per brick of the grid, plus one seventh.
// Frame: p_grid [voxel]. Allocates nothing after construction.
#pragma once

#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/volume/bone.h"

namespace burr::volume {

class Pyramid {
 public:
  explicit Pyramid(const Bone& bone);

  // After the brick was written: reads its voxels and updates its nodes up to the top.
  void update(BrickIndex brick) BURR_RT;

  // False: the surface certainly does not pass through the box. True: the bricks that the box's
  // cells touch hold both air and bone.
  [[nodiscard]] bool surface_in(const math::Aabb& box_grid) const BURR_RT;

  // False: the bricks that the box's cells touch certainly hold no material (field above zero).
  [[nodiscard]] bool material_in(const math::Aabb& box_grid) const BURR_RT;

  // Where a ray from `origin_grid` first enters bone: the exact crossing of the trilinear field.
  // Returns the distance along `direction` (unit, grid axes) [voxel], at most `length`; 0 if the
  // origin is in bone; nothing if the ray meets no bone.
  [[nodiscard]] std::optional<double> first_hit(const math::Vec3& origin_grid,
                                                const math::Vec3& direction,
                                                double length) const BURR_RT;

 private:
  struct Range {
    Field lowest = 0, highest = 0;
  };
  struct Level {
    math::Ijk size = {0, 0, 0};  // nodes along each axis
    std::vector<Range> nodes;    // (size), x fastest
  };

  [[nodiscard]] Range node(std::size_t level, int i, int j, int k) const BURR_RT;
  [[nodiscard]] Range brick_range(BrickIndex brick) const BURR_RT;
  [[nodiscard]] Range of_children(std::size_t level, int i, int j, int k) const BURR_RT;
  void gather(const math::Ijk& first, const math::Ijk& last, std::size_t level, const math::Ijk& at,
              Range& sum) const BURR_RT;
  [[nodiscard]] Range range_in(const math::Aabb& box_grid) const BURR_RT;

  const Bone& bone_;
  std::vector<Level> levels_;
};

}  // namespace burr::volume
