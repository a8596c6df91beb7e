// importing/surface_field.h - computes the bone's field from "which voxels are inside": a ramp of
// the distance to a surface that runs between the voxels. Internal to importing.
//
// Where an edge of the grid goes from inside to outside, there is a surface point with a normal.
// The distance of a voxel is the mean of its distances to the tangent planes of these points,
// weighted by nearness (implicit moving least squares: Kolluri 2005, Shen et al. 2004). So the
// surface passes through the points of a grey scan, and the staircase of a label map is smoothed.
// Cost: only bricks near a surface are computed, with two workers.
// Units: voxels. Thread: any.
#pragma once

#include <cstddef>
#include <memory>

#include "burr/base/progress.h"
#include "burr/importing/inside_grid.h"
#include "burr/volume/bone.h"

namespace burr::importing {

// grid: that of the bone, with its layers of air. nullptr: cancelled. Bricks without field and tissue take no memory.
[[nodiscard]] std::unique_ptr<volume::Bone> bone_from_inside(
    const volume::Grid& grid, volume::TissueTable tissues, const InsideGrid& inside,
    const GreyTissue& grey_tissue, std::size_t reserve_bricks, Progress& progress);
}  // namespace burr::importing
