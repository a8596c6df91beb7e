// importing/settle.h - moves voxels to the other side of the surface where that changes no shape:
// no part, hole or tunnel of the bone comes or goes.
//
// Smoothing takes the surface over some voxels. If each simply followed, a wall one voxel thin would
// break, a grain would vanish, two bones would join. So a voxel follows only if it is a simple point
// (Bertrand 1994): within its 3 x 3 x 3 neighbourhood, the bone beside it is one piece, and the air
// around it is one. Bone is joined over faces, air over faces and edges, as in the mesh
// (surface/mesher.h). Simple points are moved one after the other, so the whole has the parts,
// cavities and tunnels that it had before.
//
// Units: voxels. Thread: one. The result depends on the order of the list alone.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/volume/bone.h"

namespace burr::importing {

// Depth of a voxel that stays where it is although the smoothed surface lies beyond it [voxel].
inline constexpr double kBesideSurface = 0.02;

// A voxel that is to change sides, and its field then.
struct Flip {
  math::Ijk voxel = math::Ijk::Zero();  // of the bone's grid
  volume::Field field = 0;
};

// Writes the field of those that may change sides; the others keep theirs. Before the session.
void settle(volume::Bone& bone, const std::vector<Flip>& flips);

// Whether the middle of 27 voxels is a simple point. bit x + 3 y + 9 z: that voxel is inside; bit 13,
// the middle, does not count.
[[nodiscard]] bool is_simple(std::uint32_t inside);

}  // namespace burr::importing
