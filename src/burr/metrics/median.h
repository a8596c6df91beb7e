// metrics/median.h - the median of plain numbers. Of this room only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace burr::metrics {

// Of two in the middle their mean. values: at least one.
[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace burr::metrics
