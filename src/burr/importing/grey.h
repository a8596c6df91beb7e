// importing/grey.h - grey scans: 16-bit values on the scan's grid, smoothed near the surface, then
// resampled to a cubic grid. Internal to importing.
//
// Units: mm for spacing; values in the scan's unit, or stored where the name says so. Thread: any;
// smooth_near() and resample() use two threads.
#pragma once

#include <cstdint>
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
// value finds similar ones across it. noise_stored: standard deviation in stored units. False:
// cancelled.
[[nodiscard]] bool smooth_near(Grey& grey, double iso_stored, double noise_stored,
                               const math::Vec3& spacing_mm, Progress& progress);

// Resamples to a grid of `to` voxels, `scale` old voxels apart, with the first centre at `first`
// old voxels along each axis. Catmull-Rom kernel, widened where the new grid is coarser. An axis
// with scale 1 and first 0 is not changed. False: cancelled.
[[nodiscard]] bool resample(Grey& grey, const math::Ijk& to, const math::Vec3& scale,
                            const math::Vec3& first, Progress& progress);

}  // namespace burr::importing
