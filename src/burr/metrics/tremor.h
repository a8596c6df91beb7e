// metrics/tremor.h - how much the hand trembles while the burr is in contact.
//
// The hand's way at 100 Hz, between 6 and 12 Hz (metrics/filters.h); of a sine of 9 Hz 98 % of the
// amplitude is left, of 7 and 11 Hz 92 and 80 %, of 6 and 12 Hz half; the root mean square per axis over the samples in contact, in stretches of at least half a
// second. What a drill adds lies far above. Units: m. Thread: any.
#pragma once

#include "burr/metrics/measured.h"
#include "burr/metrics/track.h"

namespace burr::metrics {

struct Tremor {
  double rms = 0;      // per axis [m]
  double seconds = 0;  // in contact, that were used
};

// Not assessable: under 2 s of such contact.
[[nodiscard]] Assessed<Tremor> tremor_of(const Track& track);

}  // namespace burr::metrics
