// scenes/thin_shapes.h - random thin, small and turned shapes as a scanner shows them, for the law of
// importing/scan_law.h.
//
// One to three balls, plates, rods, shells and rings in a grid of 40^3 voxels, 0.3 to 3 voxels thin.
// The picture: bone and soft tissue, each voxel by its signed distance to the shape, over a blurred
// edge (a linear step, 1.2 voxels wide); then noise. The distance is that of each shape's formula.
// Units: mm, HU; thickness in voxels. Thread: any. The same seed gives the same scan.
#pragma once

#include "burr/io/scan.h"

namespace burr::scenes {

struct ThinShapes {
  io::Scan scan;
  double thinnest = 0;  // of the shapes  [voxel]
};

// spacing_mm: of the voxels; shapes are as wide in voxels along each axis. noise: standard deviation
// [HU].
[[nodiscard]] ThinShapes thin_shapes(unsigned seed, const math::Vec3& spacing_mm, double noise);

}  // namespace burr::scenes
