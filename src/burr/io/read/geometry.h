// io/read/geometry.h - where the voxels of a file lie: any affine becomes a right-handed, orthogonal
// grid in LPS, or a sentence why not. Private to io.  Units: mm. Frame: LPS.
#pragma once

#include <string_view>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

// What a header says: lps = step * ijk + origin. Columns of `step` are the moves of i, j, k  [mm].
struct Affine {
  math::Mat3 step = math::Mat3::Identity();
  math::Vec3 origin = math::Vec3::Zero();
};

// Usable: finite, no move of zero length, and the three moves span space.
[[nodiscard]] bool usable(const Affine& affine);

// Puts a full scan (size and voxels set) into the world. A left-handed grid gets its slices
// reversed; axes that are not square to each other are undone by resampling where only the slices
// are sheared, else refused. spacing_mm > 0 in all three overrides what the file says.
[[nodiscard]] Status place(Scan& scan, const Affine& affine, const math::Vec3& spacing_mm,
                           std::string_view file, Progress& progress);

// Where one slice of a stack really lies, in the stack's own frame.
struct SlicePlace {
  double x_mm = 0, y_mm = 0;  // in-plane offset from the first slice
  double z_mm = 0;            // along the normal, from the first slice; rising
};

// Slices shifted against each other (gantry tilt) or unevenly spaced become an upright, even stack:
// cubic interpolation in the plane, linear between slices. scan.size.z() = places.size(); spacing
// x, y set; sets size, spacing z, origin. gap_mm: the spacing wanted.
[[nodiscard]] Status straighten(Scan& scan, const std::vector<SlicePlace>& places, double gap_mm,
                                Progress& progress);

}  // namespace burr::io
