#include "burr/importing/keep_greys.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burr::importing {

using math::Ijk;

std::shared_ptr<const volume::Greys> keep_greys(const io::Scan& scan, double iso,
                                                Progress& progress, std::size_t most) {
  if (scan.values.empty()) return nullptr;
  auto greys = std::make_shared<volume::Greys>();
  greys->size = scan.size;
  greys->spacing = 1e-3 * scan.spacing_mm;
  greys->axes = scan.axes;
  greys->origin = 1e-3 * scan.origin_mm;
  greys->iso = iso;
  greys->hounsfield = scan.hounsfield;
  // number of scan voxels for one of these, along each axis
  Ijk by = Ijk::Ones();
  const auto count = [&] { return static_cast<std::size_t>(greys->size.cast<long>().prod()); };
  while (count() > most) {
    int finest = -1;
    for (int axis = 0; axis < 3; ++axis)
      if (greys->size[axis] > 1 && (finest < 0 || greys->spacing[axis] < greys->spacing[finest]))
        finest = axis;
    if (finest < 0) break;
    by[finest] *= 2;
    greys->size[finest] = (greys->size[finest] + 1) / 2;
    greys->origin += 0.5 * greys->spacing[finest] * greys->axes.col(finest);
    greys->spacing[finest] *= 2;
  }
  float low = std::numeric_limits<float>::infinity(), high = -low;
  bool whole = true;
  for (const float v : scan.values) {
    if (v == scan.outside) continue;
    low = std::min(low, v);
    high = std::max(high, v);
    whole = whole && v == std::nearbyint(v);
  }
  greys->least = static_cast<double>(low);
  greys->top = static_cast<double>(high);
  const double span = static_cast<double>(high) - greys->least;
  greys->step = whole && span <= 65535 ? 1 : std::max(span, 1e-12) / 65535;

  // what was not measured is as dark as the darkest
  const auto shown = [&](float value) {
    return value == scan.outside && value < low ? low : value;
  };
  greys->stored.resize(count());
  std::size_t out = 0;
  const auto row = static_cast<std::size_t>(scan.size.x()),
             slab = row * static_cast<std::size_t>(scan.size.y());
  for (int k = 0; k < greys->size.z(); ++k) {
    if (progress.cancelled()) return nullptr;
    for (int j = 0; j < greys->size.y(); ++j)
      for (int i = 0; i < greys->size.x(); ++i, ++out) {
        // fewer at the far border
        const Ijk from = Ijk(i, j, k).cwiseProduct(by), to = (from + by).cwiseMin(scan.size);
        double sum = 0;
        for (int z = from.z(); z < to.z(); ++z)
          for (int y = from.y(); y < to.y(); ++y)
            for (int x = from.x(); x < to.x(); ++x)
              sum += static_cast<double>(shown(
                  scan.values[static_cast<std::size_t>(z) * slab +
                              static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x)]));
        const double mean = sum / static_cast<double>((to - from).prod());
        greys->stored[out] = static_cast<std::uint16_t>(
            std::clamp(std::nearbyint((mean - greys->least) / greys->step), 0.0, 65535.0));
      }
  }
  return greys;
}

}  // namespace burr::importing
