// src/burr/phantom/build.h - a formula becomes a bone, voxel by voxel, without looking at those far from its
// surface.
//
// Thread: one call at a time uses `threads` workers of its own; the result does not depend on how
// many. Memory: the bone, and beside it once more the bricks near its surface.
#pragma once

#include <memory>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/bone.h"

namespace burr::phantom {

// A cube of `edge` [m] about `centre`, n voxels of edge/n along each side, axes along the world's.
// The cube is the outside of the voxels: centres begin half a voxel inside.
[[nodiscard]] volume::Grid cube_grid(double edge, int n, const Vec3& centre = {0, 0, 0});

// Voxels of `voxel` [m] that cover the box from lo to hi (world), axes along the world's.
[[nodiscard]] volume::Grid box_grid(const Vec3& lo, const Vec3& hi, double voxel);

// The scene all benchmarks share: cube of 49.2 mm in n voxels a side, a ball of 19.7 mm radius in
// its middle, which is the origin.
inline constexpr double kPeersCube = 49.2e-3;  // [m]
inline constexpr double kPeersBall = 19.7e-3;  // [m]
[[nodiscard]] volume::Grid peers_grid(int n);

// What a voxel at p, `depth` below the surface (negative: in air), is made of. Soft tissue may be
// told of in air; solid tissue is told of some voxels above the surface too, so that the first
// voxels of the ramp know what they belong to.
using TissueAt = std::function<volume::TissueId(const Vec3& p, double depth)>;

struct Formula {
  Depth depth;           // positive inside solid bone [m]
  double lipschitz = 1;  // depth changes by no more than this times the distance
  TissueAt tissue;       // none: tissue 1 where the field is not zero
  Depth soft;  // none, or depth inside what has a label without being solid; same lipschitz
};

// The bone of a formula. Only bricks that hold anything take room; `reserve_bricks` more may be
// added by depositing. Error: interrupted.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_from_formula(
    const volume::Grid& grid, volume::TissueTable tissues, const Formula& formula,
    std::size_t reserve_bricks, int threads, Progress& progress);

// The short way, for a distance that is one (Lipschitz 1) and a bone of one tissue.
[[nodiscard]] std::unique_ptr<volume::Bone> bone_from_distance(
    const volume::Grid& grid, const volume::TissueTable& tissues, const Depth& depth,
    std::size_t reserve_bricks = 0, int threads = 2, double lipschitz = 1);

// One bone that costs `cutting_energy` [J/m^3] to cut; the forces on a tooth in proportion to the
// usual bone's.
[[nodiscard]] volume::TissueTable bone_that_costs(double cutting_energy);

// The benchmarks' ball in n^3 voxels.
[[nodiscard]] std::unique_ptr<volume::Bone> peers_bone(int n, std::size_t reserve_bricks = 0,
                                                       int threads = 2);

}  // namespace burr::phantom
