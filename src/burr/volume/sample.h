// volume/sample.h - the field between voxels: trilinear value and continuous gradient.
//
// Frame: p_grid [voxel]. Units: field as a share, 0 air .. 0.5 surface .. 1 solid; inside the ramp,
// (share - 0.5) * 2 * kRamp is the depth in voxels. Voxels outside the grid are air, so a bone that
// reaches the border ends half-way to the first voxel beyond it. Brick borders have no effect: the
// result depends on voxels only.
// Thread: the writer's, or before the session. Memory: none. Cost: reads 8 voxels per value, 32 per
// gradient.
#pragma once

#include "burr/volume/bone.h"

namespace burr::volume {

inline constexpr double kIsoShare = 0.5;

// Trilinear in the eight voxels around p_grid; any p_grid is allowed, also far outside. NaN gives
// 0.
[[nodiscard]] double sample(const Bone& bone, const math::Vec3& p_grid) BURR_RT;

// Gradient of the field [1/voxel], grid axes, pointing into the bone: central differences at the
// eight voxels around p_grid, interpolated trilinearly, hence continuous.
[[nodiscard]] math::Vec3 gradient(const Bone& bone, const math::Vec3& p_grid) BURR_RT;

// Both at once; cheaper than two calls.
struct Sample {
  double value = 0;
  math::Vec3 slope = math::Vec3::Zero();
};
[[nodiscard]] Sample sample_with_slope(const Bone& bone, const math::Vec3& p_grid) BURR_RT;

// Unit normal out of the bone, world axes; zero where the field is flat.
[[nodiscard]] math::Vec3 normal(const Bone& bone, const math::Vec3& p_grid) BURR_RT;

// Depth below the surface at a world point [m], positive inside; correct up to about kRamp voxels.
[[nodiscard]] double depth_at(const Bone& bone, const math::Vec3& p) BURR_RT;

}  // namespace burr::volume
