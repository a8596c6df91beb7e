// metrics/speed_near.h - how fast the burr moves while it cuts, by how near it is to the structures that
// matter: M10 of docs/teach/metrics_recording.md.
//
// The speed is that of the smoothed way (track.h), from the samples 10 ms before and after. Bins as
// near.h has them. Frame: world. Units: SI. Thread: any.
#pragma once

#include <array>
#include <optional>

#include "burr/metrics/measured.h"
#include "burr/metrics/near.h"
#include "burr/metrics/track.h"

namespace burr::metrics {

struct SpeedNear {
  std::array<double, kBins> time = {};                     // cutting [s]
  std::array<std::optional<double>, kBins> bin_mean = {};  // [m/s]; none: nothing was cut there
  // mean at d < 2 mm / mean at d > 4 mm: below 1, the hand is slower near structures. Not assessable:
  // under half a second of cutting in either.
  Assessed<double> ratio = NotAssessable{"not measured"};
};

// Not assessable: nothing was cut at a known distance.
[[nodiscard]] Assessed<SpeedNear> speed_near(const Track& track);

}  // namespace burr::metrics
