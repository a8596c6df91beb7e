// edit/piece_body.h - a piece of bone as a body that a hand holds: one part of the kind `grid`, with
// the distances to the piece's surface.
//
// Where the field crosses its surface between two voxels, so does the lattice: the body's surface is
// that of the piece's points of touch. Beyond a voxel a distance is that to the nearest point that was
// found on a neighbour (closest points carried along in sweeps: Danielsson 1980).
//
// The lattice is kept for as long as the program runs (tool/shape_grid.h), 1.2 MB at most for each
// piece that is lifted, and about as much again for the points of its surface. Thread: any but the tick. Frame of the tool: origin at the piece's centre, axes
// of the world where the piece came free. Units: SI.
#pragma once

#include <cstdint>

#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/tool/tool.h"
#include "burr/volume/bone.h"

namespace burr::edit {

struct BodyGrid {
  tool::Tool tool;
  std::uint64_t hash = 0;  // of the lattice and its place
};

// low, high: box around all voxels of `piece` that are not 0. centre: of the piece, p_grid. The edge of
// a cell is a voxel, or the smallest whole number of them that keeps the lattice small enough. Error:
// the piece is thinner than a cell, or needs cells of more than three voxels. Memory while it is made: 33 bytes a voxel of
// the box, at most 180 MB.
[[nodiscard]] Result<BodyGrid> body_of(const volume::Bone& piece, const math::Ijk& low,
                                       const math::Ijk& high, const math::Vec3& centre);

}  // namespace burr::edit
