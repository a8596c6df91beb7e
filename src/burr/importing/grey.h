// importing/grey.h - grey scans: 16-bit values on the scan's grid, smoothed near the surface, then
// resampled to a cubic grid. Internal to importing.
//
// Units: mm for spacing; values in the scan's unit, or stored where the name says so. Thread: any;
// smooth_near() and resample() use two threads.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::importing {

// value = stored * step + zero. HU and other whole numbers that fit 16 bits are kept exactly (step
// 1).
struct Grey {
  math::Ijk size = {0, 0, 0};
  std::vector<std::int16_t> voxels;  // (x fastest)
  double step = 1, zero = 0;
  [[nodiscard]] double value(double stored) const { return stored * step + zero; }
  [[nodiscard]] double stored(double value) const { return (value - zero) / step; }
};

// Copies the box [from, from + size) of a scan.
[[nodiscard]] Grey take_grey(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size);

// Noise, as a standard deviation in the scan's unit: from the difference between a voxel and the
// mean of its six neighbours. Measured inside the material and around it; the lower value is taken,
// because texture is not noise.
[[nodiscard]] double measure_noise(const io::Scan& scan, const math::Ijk& from,
                                   const math::Ijk& size, double iso);

// Threshold between two classes of values (Otsu 1979).
[[nodiscard]] double otsu(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size);

// Smooths along the surface, not across it, and only within two voxels of the iso-level. Averages
// over 5^3 voxels. Each value is first shifted to the voxel's own depth by the local slope (least
// squares) and weighted by its distance along the surface and by its similarity (range weight of
// Tomasi & Manduchi 1998). A plain bilateral filter leaves the noise on a ramp, because every noisy
// value finds similar ones across it. noise_stored: standard deviation in stored units. faithful: a voxel
// reaches the level only if it, or one that shares a face with it, did before. False: cancelled.
[[nodiscard]] bool smooth_near(Grey& grey, double iso_stored, double noise_stored,
                               const math::Vec3& spacing_mm, bool faithful, Progress& progress);

// A grid of `size` voxels, `scale` old voxels apart, with the first centre at `first` old voxels.
struct NewGrid {
  math::Ijk size = {0, 0, 0};
  math::Vec3 scale = math::Vec3::Ones(), first = math::Vec3::Zero();
  // values below are left as the cubic gives them
  std::int16_t level = std::numeric_limits<std::int16_t>::min();
  bool faithful = true;  // false: as for BoneRecipe::bone_law 1, overshoots and lost voxels stay
};

// Resamples with a Catmull-Rom kernel, widened where the new grid is coarser. On a finer axis a new
// value never leaves the range of the two old ones around it: a cubic overshoots beside a steep edge,
// and would make bone of soft tissue beside air. An axis with scale 1 and first 0 is not changed.
// False: cancelled.
// before_it: gets the voxels as they were, where any axis changes; null: not wanted.
[[nodiscard]] bool resample(Grey& grey, const NewGrid& to, Progress& progress,
                            std::vector<std::int16_t>* before_it = nullptr);

// The same, and no bone is lost between the new voxels: where an old voxel reaches the level and none
// of the new ones around its centre does, the nearest takes its value. Only where no axis is coarser.
[[nodiscard]] bool make_cubic(Grey& grey, std::int16_t level, NewGrid to, Progress& progress);

}  // namespace burr::importing
