// importing/surface_points.h - the surface near one brick: the block of voxels around it, the points where grid edges cross
// the surface, and for each voxel of the brick the sums over the planes of these points (planes_kernel.h). Internal to
// importing.
//
// Units: voxels. Thread: any; a Desk belongs to one worker.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/importing/inside_grid.h"
#include "burr/importing/planes_kernel.h"
#include "burr/math/vec3.h"
#include "burr/volume/bone.h"

namespace burr::importing {

namespace block {

// The neighbourhood of a brick: 6 voxels on every side. Of those, 2 are for the blur, 1 for the
// gradient, and 3 may hold surface points that reach into the brick.
inline constexpr int kHalo = 6, kBlock = volume::kBrickEdge + 2 * kHalo, kPlane = kBlock * kBlock,
                     kBlockVoxels = kPlane * kBlock;

// The place of a voxel in the block; the brick's first is x = y = z = kHalo.
constexpr int at(int x, int y, int z) { return x + kBlock * (y + kBlock * z); }

}  // namespace block

// Everything that one worker needs; made once, used for thousands of bricks.
struct Desk {
  // >= 0 inside; linear interpolation gives the surface
  std::array<float, block::kBlockVoxels> level;
  // in label maps, the values whose gradient is taken
  std::array<float, block::kBlockVoxels> smooth;
  std::array<float, block::kBlockVoxels> work;
  // as stored; in grey scans
  std::array<std::int16_t, block::kBlockVoxels> greys, most, work_greys;
  std::array<std::uint8_t, block::kBlockVoxels> labels;
  // bit x: voxel x of the row is inside; [z][y]
  std::array<std::array<std::uint32_t, block::kBlock>, block::kBlock> inside;
  std::vector<SurfacePoint> points;
  // the points that count for each row of the brick: counts[row] of them, from
  // which[row * points.size()] on
  std::array<std::uint32_t, volume::kBrickEdge * volume::kBrickEdge> counts;
  std::vector<std::uint16_t> which;
  PlaneSums sums;
  alignas(64) std::array<float, volume::kBrickVoxels> sides;  // of PlaneRule
  MaterialDirections directions;
  std::array<volume::Field, volume::kBrickVoxels> field;  // the brick being made
  std::array<volume::TissueId, volume::kBrickVoxels> tissue;
};

// Reads the block around a brick, without its outermost `skip` voxels. Beyond the border of the
// grid the last voxels are repeated. any_inside, any_outside: whether there are such voxels.
void fetch(const InsideGrid& grid, const math::Ijk& first, int skip, Desk& desk, bool& any_inside,
           bool& any_outside);

// [1 4 6 4 1] / 16 along all axes
void blur(Desk& desk);

// Finds the surface points on grid edges near the brick.
void find_points(const InsideGrid& grid, const math::Ijk& first, Desk& desk);

// Sums over the points for every voxel. The softer, the more points share: this removes noise and
// staircases but blunts edges. by_normal: points that face the other way do not count (thin walls
// of label maps).
void measure(float soft, bool by_normal, int law, SumPlanes sum_planes, Desk& desk);

}  // namespace burr::importing
