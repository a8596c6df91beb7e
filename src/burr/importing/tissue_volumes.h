// importing/tissue_volumes.h - gives each tissue of a smoothed label map the volume that its voxels had. Internal to
// importing.
//
// Units: voxels. Thread: one, before the session.
#pragma once

#include <vector>

#include "burr/volume/bone.h"

namespace burr::importing {

// Shifts the field of each tissue by a fraction of a voxel until its volume_of is the wanted one
// [voxel]; wanted < 0: no shift. Returns the shifts [voxel].
std::vector<double> restore_tissue_volumes(volume::Bone& bone,
                                           const std::vector<double>& wanted_voxels, int law = 2);

}  // namespace burr::importing
