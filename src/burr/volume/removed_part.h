// volume/removed_part.h - what was taken away between two states of a bone, as a bone of its own.
//
// With depths d below the surface, removed = before and not after:
//
//     d_removed = min(d_before, -d_after)                      where the field changed
//
// Where it did not change, d_after = d_before says only that the cut was not deeper than the old
// surface; min(d, -d) would leave a sheet just below the iso-level all along the old surface, which
// volume_of() counts. There the cut is continued from the changed neighbours instead (a distance
// falls by one voxel per voxel), never above -|d_before|. So untouched bone adds nothing:
// volume_of(before) = volume_of(after) + volume_of(removed) within 0.1 % for cuts of a few voxels,
// and the sharp rim is true to about a third of a voxel.
//
// A layer thinner than a voxel falls between the voxels of that minimum, though both its sides are
// known exactly. So the minimum can be taken on a finer grid, of the two depths interpolated.
//
// Tissue and intensity are those of `before`. Deposited material is not part of it. Thread: one,
// both bones at rest.
#pragma once

#include <memory>

#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::volume {

// finer: 1, on the same grid; or 2..8: voxels so many times smaller, on a grid one old voxel larger
// on each side, without intensity. Errors: Trouble::data if the grids differ, nothing was removed,
// or the finer bone would take more than 1 GB.
[[nodiscard]] Result<std::unique_ptr<Bone>> removed_part(const Bone& before, const Bone& after,
                                                         int finer = 1);

// How much was taken away, voxel by voxel: what the ledger calls removed, if nothing was deposited.
// The two grids must be the same.  [m^3]
[[nodiscard]] double removed_volume(const Bone& before, const Bone& after);

}  // namespace burr::volume
