// importing/planes_kernel.h - adds up, for one row of voxels, the distances to the tangent planes
// of nearby surface points. Compiled once per instruction set, chosen at run time. Plain pointers
// only. Internal to importing.
//
// Which points count for a voxel: those within reach of it whose plane has the voxel on its own side,
// or at most `against` on the other. A voxel in air thus never counts the plane of a wall's far side,
// which, extended, would put it into bone.
//
// Units: voxels. Thread: any.
#pragma once

#include <cstdint>

namespace burr::importing {

// A surface point, relative to the brick's first voxel.
struct SurfacePoint {
  float x = 0, y = 0, z = 0;     // [voxel]
  float nx = 0, ny = 0, nz = 0;  // unit normal, into the material
  float steep = 0;               // how fast the value grows along the normal  [1/voxel]
};

// Weighted sums over the points, for every voxel of a brick, (8 x 8 x 8).
struct PlaneSums {
  static constexpr int kVoxels = 512;
  alignas(64) float weights[kVoxels];                       // of the weights
  alignas(64) float depths[kVoxels];                        // of the distances from their planes
  alignas(64) float nx[kVoxels], ny[kVoxels], nz[kVoxels];  // of the normals
  alignas(64) float rx[kVoxels], ry[kVoxels], rz[kVoxels];  // of the offsets from the points to the
                                                            // voxel
  alignas(64) float steep[kVoxels];    // of how fast the values grow at the points
  alignas(64) float nearest[kVoxels];  // least square of a distance to any point, counted or not
};

inline constexpr float kReach = 3.0F;    // a point counts for voxels within this distance [voxel]
inline constexpr float kNoPoint = 1e9F;  // in `nearest` where there is none

// Label maps: the direction towards the material at each voxel; its length says how certain it is.
struct MaterialDirections {
  alignas(64) float x[PlaneSums::kVoxels], y[PlaneSums::kVoxels], z[PlaneSums::kVoxels];
};

// How points count.
struct PlaneRule {
  float soft = 1;                        // weight 1 / (r^2 + soft)^4, r in voxels
  float reach_square = kReach * kReach;  // points farther away do not count  [voxel^2]
  float against =
      0;  // how far the plane of a point that counts may lie on the wrong side of a voxel
  const float* sides = nullptr;  // (512) 1: the voxel is inside, -1: outside
  const MaterialDirections* directions =
      nullptr;  // points that face the other way count less; null: fully
};

// Writes the sums for the voxels of row (y, z) over the `count` points listed in `which`, in that
// order. The vector lanes never mix, so the bits are the same on every instruction set.
using SumPlanes = void (*)(const SurfacePoint* points, const std::uint16_t* which, int count, int y,
                           int z, const PlaneRule& rule, PlaneSums& sums) noexcept;

namespace scalar {
void sum_planes(const SurfacePoint*, const std::uint16_t*, int, int, int, const PlaneRule&,
                PlaneSums&) noexcept;
}
namespace avx2 {
void sum_planes(const SurfacePoint*, const std::uint16_t*, int, int, int, const PlaneRule&,
                PlaneSums&) noexcept;
}

[[nodiscard]] SumPlanes sum_planes_kernel() noexcept;

}  // namespace burr::importing
