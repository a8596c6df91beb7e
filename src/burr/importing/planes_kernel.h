// importing/planes_kernel.h - what the points of a surface say about one row of voxels; once per
// instruction set, chosen at run time. Plain pointers only. Private to io.
#pragma once

#include <cstdint>

namespace burr::importing {

// Seen from the brick's first voxel.
struct SurfacePoint {
  float x = 0, y = 0, z = 0;     // [voxel]
  float nx = 0, ny = 0, nz = 0;  // unit, into the material
};

// Sums over the points, for every voxel of a brick, (8 x 8 x 8).
struct PlaneSums {
  static constexpr int kVoxels = 512;
  alignas(64) float weights[kVoxels];                       // of the points
  alignas(64) float depths[kVoxels];                        // of the distances from their planes
  alignas(64) float nx[kVoxels], ny[kVoxels], nz[kVoxels];  // of the normals
  alignas(64) float rx[kVoxels], ry[kVoxels], rz[kVoxels];  // of the ways from the points
};

// Label maps: which way the material lies at each voxel, and how surely.
struct Facing {
  alignas(64) float x[PlaneSums::kVoxels], y[PlaneSums::kVoxels], z[PlaneSums::kVoxels];
};

// Writes the sums of the voxels in row (y, z) over the points that `which` lists, `count` of them,
// in that order: weight 1 / (r^2 + soft)^4, r in voxels. facing: points that face the other way
// count less; null: all count. The lanes never mix, so the bits are the same everywhere.
using SumPlanes = void (*)(const SurfacePoint* points, const std::uint16_t* which, int count, int y,
                           int z, float soft, const Facing* facing, PlaneSums& sums) noexcept;

namespace scalar {
void sum_planes(const SurfacePoint*, const std::uint16_t*, int, int, int, float, const Facing*,
                PlaneSums&) noexcept;
}
namespace avx2 {
void sum_planes(const SurfacePoint*, const std::uint16_t*, int, int, int, float, const Facing*,
                PlaneSums&) noexcept;
}

[[nodiscard]] SumPlanes sum_planes_kernel() noexcept;

}  // namespace burr::importing
