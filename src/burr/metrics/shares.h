// metrics/shares.h - shares of a patch, and how well they are known. Of this room only.
#pragma once

#include <algorithm>
#include <cmath>

#include "burr/metrics/cover.h"

namespace burr::metrics {

// Share of the weight of the samples for which keep(sample, shift) holds; shift: added to the
// thresholds.
template <class Keep>
[[nodiscard]] double share_of(const Cover& cover, double shift, const Keep& keep) {
  double kept = 0;
  for (const CoverSample& one : cover.samples)
    if (keep(one, shift)) kept += one.surface.faces;
  return kept / cover.weight;
}

// Error of a share: that of few samples (two standard errors), and what the error of tau makes of it.
[[nodiscard]] inline double share_error(double share, double low, double high,
                                        std::size_t samples) {
  const double few = 2 * std::sqrt(share * (1 - share) / static_cast<double>(samples));
  return std::max({few, std::abs(share - low), std::abs(high - share)});
}

}  // namespace burr::metrics
