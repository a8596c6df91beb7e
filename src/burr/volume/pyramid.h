// volume/pyramid.h - the bone seen from afar: lowest and highest field of every brick, of every
// eight bricks, and so on up to one number for the whole. Answers "is there surface near here"
// without looking at voxels (the octree of the thesis).
//
//     level 0   1 brick      8 voxels a side
//     level 1   8 bricks    16 voxels
//     ...       top: one node
//
// Kept by the writer: after bone.write_brick(b, ...), pyramid.update(b).
// Thread: the writer's, or before the session. Memory: 4 B per brick of the grid and a seventh
// more. Frame: p_grid [voxel]. Everything after building is allocation-free.
#pragma once

#include <optional>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/volume/bone.h"

namespace burr::volume {

class Pyramid {
 public:
  explicit Pyramid(const Bone& bone);

  // The brick was written: looks at its voxels and mends the path to the top.
  void update(BrickIndex brick) BURR_RT;

  // May the surface pass through the box? False is certain; true means that among the bricks its
  // cells touch some voxel is air and some is bone.
  [[nodiscard]] bool surface_in(const math::Aabb& box_grid) const BURR_RT;

  // Is there material, any field above zero, in the bricks that the box's cells touch? False is
  // certain.
  [[nodiscard]] bool material_in(const math::Aabb& box_grid) const BURR_RT;

  // Where a straight way from `origin_grid` first enters bone: the exact crossing of the trilinear
  // field. Distance along `direction` (unit, grid axes) [voxel], at most `length`; 0 if the origin
  // is in bone; nothing if the way is free.
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
