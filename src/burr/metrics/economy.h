// metrics/economy.h - how much way and how many strokes the work took, and how much of it was done where
// no step asks for it. Descriptive figures.
//
//     per path    volume removed in the regions of the steps / way of the burr
//     strokes     per volume removed
//     outside     share of the volume that was removed while the burr's head reached into no region of a step
//
// Of the way at 100 Hz (metrics/track.h). "Reaches into": the middle of the head is nearer to the region
// than its radius, by the depth of region.h, which is a bound: work right beside a region counts as in
// it. Units: SI. Thread: any.
#pragma once

#include <cstddef>

#include "burr/metrics/measured.h"
#include "burr/metrics/region.h"
#include "burr/metrics/track.h"

namespace burr::metrics {

struct Economy {
  double volume = 0, outside = 0;                             // removed, and of it outside [m^3]
  double path = 0;                                            // [m]
  Assessed<double> per_path = NotAssessable{"not measured"};  // [m^3/m]
  Assessed<double> strokes_per_volume = NotAssessable{"not measured"};  // [1/m^3]
  Assessed<double> outside_share = NotAssessable{"not measured"};
};

// steps: all regions of the steps in one; empty: the case names none. path [m] as of paths_of().
[[nodiscard]] Economy economy_of(const Track& track, double path, std::size_t strokes,
                                 const Region& steps);

}  // namespace burr::metrics
