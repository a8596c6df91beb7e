// io/read/contour_voxels.h - the contours of a structure set as structures on the voxels of a scan. Internal to io.
//
// A voxel counts if its centre is inside. In the plane of contours that is the even-odd rule (contour_plane.h). Between
// two planes the distances to their edges are interpolated, so the shape goes over from one to the other (Raya & Udupa
// 1990); beyond the last plane it goes on for half the usual distance of the planes, as each contour stands for a slab.
// Planes that are more than 1.5 times the usual distance apart have nothing between them. Planes may lie at any angle to
// the voxels. Points and open curves have no inside.
// Units: mm. Frame: LPS. Thread: one at a time. Memory: a bit for each voxel of the scan; for planes that lie on no axis of
// the voxels also 5 bytes for each pixel of a structure's planes.
#pragma once

#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_contours.h"
#include "burr/io/read/merge_structures.h"
#include "burr/io/scan.h"

namespace burr::io {

// One structure for each of the set, in its order, perhaps without a voxel. What was left out or assumed becomes a notice
// of the scan. Error: only Trouble::interrupted.
[[nodiscard]] Result<std::vector<LooseStructure>> voxels_of_contours(const ContourSet& set,
                                                                     const VoxelPlaces& on,
                                                                     Scan& scan,
                                                                     Progress& progress);

}  // namespace burr::io
