// io/read/geometry.h - the geometry of a scan: turns any affine into a right-handed, orthogonal
// grid in LPS, or says why it cannot. Internal to io. Units: mm. Frame: LPS.
//
// Thread: any. Errors: one sentence.
#pragma once

#include <string_view>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::io {

// The affine of a header: lps = step * ijk + origin. The columns of `step` are the steps along i,
// j, k [mm].
struct Affine {
  math::Mat3 step = math::Mat3::Identity();
  math::Vec3 origin = math::Vec3::Zero();
};

// True: all numbers are finite, no step has length zero, and the three steps span space.
[[nodiscard]] bool usable(const Affine& affine);

// Sets the scan's geometry (its size and voxels must be set). In a left-handed grid the order of
// the slices is reversed. Axes that are not orthogonal are corrected by resampling if only the
// slices are sheared; otherwise it is an error. spacing_mm > 0 in all three overrides the file.
[[nodiscard]] Status place(Scan& scan, const Affine& affine, const math::Vec3& spacing_mm,
                           std::string_view file, Progress& progress);

// What a file without a spacing leaves open: a question, or, of a recording of before 2026-11-29
// (check_scan false), a notice. It is taken for 1 mm.
void no_spacing(std::string_view file, bool check_scan, Scan& scan);

// The true position of one slice, in the frame of the stack.
struct SlicePlace {
  double x_mm = 0, y_mm = 0;  // in-plane offset from the first slice
  double z_mm = 0;            // along the normal, from the first slice; increasing
};

// Makes an upright stack of equal spacing from slices that are shifted (gantry tilt) or unevenly
// spaced: cubic interpolation in the plane, linear between slices. Needs scan.size.z() =
// places.size() and the spacing in x, y; sets size, spacing z, origin. gap_mm: the wanted spacing.
[[nodiscard]] Status resample_upright(Scan& scan, const std::vector<SlicePlace>& places,
                                      double gap_mm, Progress& progress);

}  // namespace burr::io
