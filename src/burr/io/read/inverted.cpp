#include "burr/io/read/inverted.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/io/value_groups.h"

namespace burr::io {
namespace {

bool measured(const Scan& scan, float value) { return !std::isnan(value) && value != scan.outside; }

}  // namespace

int bright_air(const Scan& scan) {
  const ValueSample sample =
      sample_values(scan.values.data(), scan.size, math::Ijk::Zero(), scan.size, scan.outside);
  if (sample.values.size() < 64) return 0;
  const double low = value_at_share(sample, 0.01), high = value_at_share(sample, 0.99);
  if (!(high > low)) return 0;
  // a small cube at each corner, because one voxel is noise
  const math::Ijk edge = (scan.size / 16).cwiseMax(1).cwiseMin(8);
  int bright = 0, dark = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double sum = 0;
    int count = 0;
    for (int k = 0; k < edge.z(); ++k)
      for (int j = 0; j < edge.y(); ++j)
        for (int i = 0; i < edge.x(); ++i) {
          const auto x = static_cast<std::size_t>((corner & 1) != 0 ? scan.size.x() - 1 - i : i),
                     y = static_cast<std::size_t>((corner & 2) != 0 ? scan.size.y() - 1 - j : j),
                     z = static_cast<std::size_t>((corner & 4) != 0 ? scan.size.z() - 1 - k : k);
          const float value =
              scan.values[x + static_cast<std::size_t>(scan.size.x()) *
                                  (y + static_cast<std::size_t>(scan.size.y()) * z)];
          if (!measured(scan, value)) continue;
          sum += double{value};
          ++count;
        }
    if (count == 0) continue;
    const double place = (sum / count - low) / (high - low);
    bright += place > 0.75 ? 1 : 0;
    dark += place < 0.25 ? 1 : 0;
  }
  constexpr int kMost = 5;  // of the corners
  return bright >= kMost ? 1 : dark >= kMost ? -1 : 0;
}

void turn_inverted(Scan& scan, const std::string& file) {
  if (scan.hounsfield || scan.values.empty()) return;
  if (bright_air(scan) < 0) {
    scan.ask(Ask::doubt,
             fmt::format("{}: its header says that dark is dense (MONOCHROME1), but its corners, "
                         "where air lies around a body, are dark; the values were left as they "
                         "are, with bright for dense",
                         file));
    return;
  }
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float value : scan.values) {
    if (!measured(scan, value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(high > low)) return;
  for (float& value : scan.values)
    if (measured(scan, value)) value = low + high - value;
  // what was not measured stays below all others
  if (scan.outside && *scan.outside > low && *scan.outside >= high) {
    const float before = *scan.outside;
    const float below = low - std::max(1.0F, 1e-6F * (high - low));
    for (float& value : scan.values)
      if (value == before) value = below;
    scan.outside = below;
  }
  scan.notices.emplace_back(
      "The picture is inverted (MONOCHROME1): dark is dense in the file, so its values were turned "
      "round, and bright is dense now.");
}

}  // namespace burr::io
