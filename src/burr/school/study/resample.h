// school/study/resample.h - 95 % intervals by drawing again from what was seen (the bootstrap of Efron 1979, percentiles).
//
// The same seed gives the same interval on every machine. Thread: any.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "burr/people/random_stream.h"
#include "burr/school/study/interval.h"

namespace burr::school::study {

// q: 0 to 1; linear between neighbours (type 7 of Hyndman and Fan 1996, R's default). values: sorted, at least one.
[[nodiscard]] inline double quantile(const std::vector<double>& values, double q) {
  const double at = q * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(std::floor(at));
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - std::floor(at)) * (values[high] - values[low]);
}

// statistic(RandomStream&): of one drawn sample; none where it cannot be computed (such draws are left out).
template <class Statistic>
[[nodiscard]] Interval resampled(int draws, std::uint64_t seed, const Statistic& statistic) {
  std::vector<double> values;
  for (int n = 0; n < draws; ++n) {
    people::RandomStream random(seed, static_cast<std::uint64_t>(n));
    if (const std::optional<double> value = statistic(random)) values.push_back(*value);
  }
  if (values.empty()) return {std::nan(""), std::nan("")};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

}  // namespace burr::school::study
