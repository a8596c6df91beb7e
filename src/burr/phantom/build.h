// phantom/build.h - makes a bone from a formula, voxel by voxel, without computing those far from
// its surface.
//
// Thread: one call at a time; it uses `threads` workers of its own, and the result does not depend
// on their number. Memory: the bone, plus its bricks near the surface a second time.
#pragma once

#include <memory>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/bone.h"

namespace burr::phantom {

// A cube of `edge` [m] around `centre`, with n voxels of edge/n along each side, axes along the
// world's. The edge is measured at the outside of the voxels: voxel centres begin half a voxel
// inside.
[[nodiscard]] volume::Grid cube_grid(double edge, int n, const Vec3& centre = {0, 0, 0});

// Voxels of `voxel` [m] that cover the box from lo to hi (world), axes along the world's.
[[nodiscard]] volume::Grid box_grid(const Vec3& lo, const Vec3& hi, double voxel);

// The scene that all benchmarks share: a cube of 49.2 mm with n voxels per side; in its middle, the
// origin, a ball of 19.7 mm radius.
inline constexpr double kPeersCube = 49.2e-3;  // [m]
inline constexpr double kPeersBall = 19.7e-3;  // [m]
[[nodiscard]] volume::Grid peers_grid(int n);

// The tissue of a voxel at p, `depth` below the surface (negative: in air). May return soft tissue
// in air; must return solid tissue some voxels above the surface too, so that the first voxels of
// the ramp have their tissue.
using TissueAt = std::function<volume::TissueId(const Vec3& p, double depth)>;

struct Formula {
  Depth depth;           // positive inside solid bone [m]
  double lipschitz = 1;  // |change of depth| <= lipschitz * distance
  TissueAt tissue;       // none: tissue 1 where the field is not zero
  Depth soft;            // none, or depth inside labelled tissue that is not solid; same lipschitz
};

// Builds the bone of a formula. Only bricks that hold something take memory; `reserve_bricks` more
// may be added by depositing. Error: interrupted.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_from_formula(
    const volume::Grid& grid, volume::TissueTable tissues, const Formula& formula,
    std::size_t reserve_bricks, int threads, Progress& progress);

// Short form, for an exact distance (Lipschitz 1) and a bone of one tissue.
[[nodiscard]] std::unique_ptr<volume::Bone> bone_from_distance(
    const volume::Grid& grid, const volume::TissueTable& tissues, const Depth& depth,
    std::size_t reserve_bricks = 0, int threads = 2, double lipschitz = 1);

// A table with one bone that takes `cutting_energy` [J/m^3] to cut; the forces on a tooth are
// scaled in proportion to those of the default bone.
[[nodiscard]] volume::TissueTable bone_that_costs(double cutting_energy);

// The ball of the benchmarks in n^3 voxels.
[[nodiscard]] std::unique_ptr<volume::Bone> peers_bone(int n, std::size_t reserve_bricks = 0,
                                                       int threads = 2);

}  // namespace burr::phantom
