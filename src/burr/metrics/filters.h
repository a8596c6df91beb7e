// metrics/filters.h - low pass and band pass without delay: Butterworth, run forwards and back. Of
// this room only.
//
// Run twice, its gain is squared: 1 / (1 + (f / corner)^(2 order)) well below rate / 2, so at the corner
// 1/2 of the amplitude is left. The ends are continued
// by reflection, so that a straight motion stays straight. Coefficients by the bilinear transform
// with the corner prewarped; sines by same_math.h. Thread: any.
#pragma once

#include <span>
#include <vector>

namespace burr::metrics {

// rate, corner [Hz]; corner below rate / 2. values: replaced. order: even.
void low_pass(std::span<double> values, double rate, double corner, int order = 2);
// What is between two corners: low pass of order 8 at `high`, less the same at `low`. In the middle of
// an octave 99 % of the amplitude is left.
[[nodiscard]] std::vector<double> band(std::span<const double> values, double rate, double low,
                                       double high);

}  // namespace burr::metrics
