#include "burr/metrics/speed_near.h"

#include <cmath>
#include <cstddef>
#include <span>

#include "burr/math/sums.h"

namespace burr::metrics {

Assessed<SpeedNear> speed_near(const Track& track) {
  constexpr double kStep = 1 / kTrackRate, kLeast = 0.5;  // [s]
  std::array<Running, kBins> bins = {};
  track.for_each_piece([&](std::span<const TrackSample> piece) {
    for (std::size_t n = 1; n + 1 < piece.size(); ++n) {
      const TrackSample& one = piece[n];
      if (!one.cutting() || std::isnan(one.d)) continue;
      bins[bin_of(one.d)].add(math::norm(piece[n + 1].p - piece[n - 1].p) / (2 * kStep), kStep);
    }
  });
  SpeedNear out;
  double known = 0;
  for (std::size_t n = 0; n < kBins; ++n) {
    known += bins[n].weight;
    out.time[n] = bins[n].weight;
    out.bin_mean[n] = bins[n].mean();
  }
  if (!(known > 0))
    return NotAssessable{"nothing was cut at a known distance from what is to be spared"};
  Running near = bins[0];
  near.sum += bins[1].sum;
  near.weight += bins[1].weight;
  const Running& far = bins[kBins - 1];
  if (near.weight < kLeast || far.weight < kLeast)
    out.ratio =
        NotAssessable{"less than half a second was cut near what is to be spared, or far from it"};
  else if (far.sum > 0)
    out.ratio = (near.sum / near.weight) / (far.sum / far.weight);
  else
    out.ratio = NotAssessable{"the burr did not move while it cut far from what is to be spared"};
  return out;
}

}  // namespace burr::metrics
