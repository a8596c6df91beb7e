// metrics/filters.h - low pass and band pass without delay: Butterworth of 2nd order, run forwards
// and back. Of this room only.
//
// Run twice, its gain is squared: at the corner 1/2 of the amplitude is left. The ends are continued
// by reflection, so that a straight motion stays straight. Coefficients by the bilinear transform
// with the corner prewarped; sines by same_math.h. Thread: any.
#pragma once

#include <span>
#include <vector>

namespace burr::metrics {

// rate, corner [Hz]; corner below rate / 2. values: replaced.
void low_pass(std::span<double> values, double rate, double corner);
// What is between two corners: low pass at `high`, less low pass at `low`.
[[nodiscard]] std::vector<double> band(std::span<const double> values, double rate, double low,
                                       double high);

}  // namespace burr::metrics
