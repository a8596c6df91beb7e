// importing/planes_kernel.h - adds up, for one row of voxels, the distances to the tangent planes
// of nearby surface points. Compiled once per instruction set, chosen at run time. Plain pointers
// only. Internal to importing.
//
// Units: voxels. Thread: any.
#pragma once

#include <cstdint>

namespace burr::importing {

// A surface point, relative to the brick's first voxel.
struct SurfacePoint {
  float x = 0, y = 0, z = 0;     // [voxel]
  float nx = 0, ny = 0, nz = 0;  // unit normal, into the material
};

// Weighted sums over the points, for every voxel of a brick, (8 x 8 x 8).
struct PlaneSums {
  static constexpr int kVoxels = 512;
  alignas(64) float weights[kVoxels];                       // of the weights
  alignas(64) float depths[kVoxels];                        // of the distances from their planes
  alignas(64) float nx[kVoxels], ny[kVoxels], nz[kVoxels];  // of the normals
  alignas(64) float rx[kVoxels], ry[kVoxels], rz[kVoxels];  // of the offsets from the points to the
                                                            // voxel
};

// Label maps: the direction towards the material at each voxel; its length says how certain it is.
struct MaterialDirections {
  alignas(64) float x[PlaneSums::kVoxels], y[PlaneSums::kVoxels], z[PlaneSums::kVoxels];
};

// Writes the sums for the voxels of row (y, z) over the `count` points listed in `which`, in that
// order. Weight 1 / (r^2 + soft)^4, r in voxels. directions: points that face the other way count
// less; null: all count fully. The vector lanes never mix, so the bits are the same on every
// instruction set.
using SumPlanes = void (*)(const SurfacePoint* points, const std::uint16_t* which, int count, int y,
                           int z, float soft, const MaterialDirections* directions,
                           PlaneSums& sums) noexcept;

namespace scalar {
void sum_planes(const SurfacePoint*, const std::uint16_t*, int, int, int, float,
                const MaterialDirections*, PlaneSums&) noexcept;
}
namespace avx2 {
void sum_planes(const SurfacePoint*, const std::uint16_t*, int, int, int, float,
                const MaterialDirections*, PlaneSums&) noexcept;
}

[[nodiscard]] SumPlanes sum_planes_kernel() noexcept;

}  // namespace burr::importing
