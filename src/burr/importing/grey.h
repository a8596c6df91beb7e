// importing/grey.h - a grey scan on its way to bone: 16-bit numbers on the scan's grid, smoothed where the
// surface is, then on a cubic grid. Private to io.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/scan.h"

namespace burr::importing {

// value = stored * step + zero; HU and other whole numbers of 16 bit are kept exactly (step 1).
struct Grey {
  math::Ijk size = {0, 0, 0};
  std::vector<std::int16_t> voxels;  // (x fastest)
  double step = 1, zero = 0;
  [[nodiscard]] double value(double stored) const { return stored * step + zero; }
  [[nodiscard]] double stored(double value) const { return (value - zero) / step; }
};

// The box [from, from + size) of a scan.
[[nodiscard]] Grey take_grey(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size);

// Noise, as standard deviation in the scan's unit: from what a voxel differs from the mean of its
// six neighbours, inside the material and around it; the quieter of the two, because texture is no
// noise.
[[nodiscard]] double measure_noise(const io::Scan& scan, const math::Ijk& from,
                                   const math::Ijk& size, double iso);

// Threshold between the two classes of values, Otsu 1979.
[[nodiscard]] double otsu(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size);

// Averages along the surface, not across it, and only within two voxels of the iso-level: over 5^3
// voxels, each value brought to the voxel's own depth by the local slope (least squares), weighted
// by nearness along the surface and by likeness (the range weight of Tomasi & Manduchi 1998). A
// plain bilateral filter leaves the noise on a ramp, because every noisy value finds its like
// across it. noise in stored units.
[[nodiscard]] bool smooth_near(Grey& grey, double iso_stored, double noise_stored,
                               const math::Vec3& spacing_mm, Progress& progress);

// On a grid of `to` voxels, `scale` of the old ones apart, the first centre at `first` old voxels
// along each axis. Catmull-Rom, widened where the new grid is coarser. An axis with scale 1 and
// first 0 is left alone.
[[nodiscard]] bool resample(Grey& grey, const math::Ijk& to, const math::Vec3& scale,
                            const math::Vec3& first, Progress& progress);

}  // namespace burr::importing
