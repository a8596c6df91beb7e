#include "burr/metrics/tremor.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "burr/metrics/filters.h"

namespace burr::metrics {
namespace {

constexpr double kLow = 6, kHigh = 12;               // [Hz]
constexpr std::size_t kShortest = 50, kLeast = 200;  // samples

}  // namespace

Assessed<Tremor> tremor_of(const Track& track) {
  double sum = 0;
  std::size_t count = 0;
  track.for_each_piece([&](const auto& piece) {
    std::array<std::vector<double>, 3> shake;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> line;
      for (const TrackSample& one : piece) line.push_back(one.hand[axis]);
      shake[static_cast<std::size_t>(axis)] = band(line, kTrackRate, kLow, kHigh);
    }
    for (std::size_t n = 0; n < piece.size();) {
      std::size_t end = n;
      while (end < piece.size() && piece[end].touching) ++end;
      if (end - n >= kShortest) {
        for (std::size_t s = n; s < end; ++s)
          for (const std::vector<double>& axis : shake) sum += axis[s] * axis[s];
        count += end - n;
      }
      n = end + 1;
    }
  });
  if (count < kLeast) return NotAssessable{"the burr was hardly in contact"};
  return Tremor{std::sqrt(sum / (3 * static_cast<double>(count))),
                static_cast<double>(count) / kTrackRate};
}

}  // namespace burr::metrics
