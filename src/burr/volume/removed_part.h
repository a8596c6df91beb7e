// volume/removed_part.h - the material removed between two states of a bone, as a bone of its own.
//
// With depth d below the surface, removed = in `before` and not in `after`:
//
//     d_removed = min(d_before, -d_after)                      where the field changed
//
// Where the field did not change, d_after = d_before means only that the cut was not deeper than
// the old surface. min(d, -d) would leave a thin sheet just below the iso-level along the whole old
// surface, and volume_of() would count it. So the cut is continued there from the changed
// neighbours (a distance falls by one voxel per voxel), but never above -|d_before|. Untouched bone
// then adds nothing: volume_of(before) = volume_of(after) + volume_of(removed) within 0.1 % for
// cuts of a few voxels, and the sharp rim is right to about a third of a voxel.
//
// A removed layer thinner than a voxel is lost between the voxels of that minimum, although both
// its sides are known exactly. For such layers the minimum can be taken on a finer grid, from the
// two interpolated depths.
//
// Tissue and intensity are those of `before`. Added material is not included. Thread: one, while
// nothing writes to either bone.
#pragma once

#include <memory>

#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::volume {

// finer: 1, the same grid; or 2..8: voxels that many times smaller, on a grid one old voxel larger
// on each side, without intensity. Errors: Trouble::data if the grids differ, if nothing was
// removed, or if the finer bone would take more than 1 GB.
[[nodiscard]] Result<std::unique_ptr<Bone>> removed_part(const Bone& before, const Bone& after,
                                                         int finer = 1);

// The removed volume, voxel by voxel: equals `removed` of the ledger if nothing was added. The two
// grids must be the same.  [m^3]
[[nodiscard]] double removed_volume(const Bone& before, const Bone& after);

}  // namespace burr::volume
