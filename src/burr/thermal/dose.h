// thermal/dose.h - CEM43: minutes at 43 degrees that would have done the same to the tissue.
//
//     dose = sum R^(43 - T) dt          R = 0.5 above 43 deg C, 0.25 below
//
// Sapareto & Dewey 1984. 47 deg C for 60 s and 50 deg C for 30 s, the thresholds usually quoted for
// bone, are 16 and 64. Below kLeastDoseC nothing is counted: there the rule has no data (Dewhirst
// et al. 2003), and hours at body temperature, harmless, would add up (0.015 min an hour at 37).
#pragma once

#include <cmath>

namespace burr::thermal {

inline constexpr double kLeastDoseC = 39;  // [deg C]

// Minutes of dose in a minute at this temperature.  [-]
[[nodiscard]] inline double cem43_rate(double t_c) {
  if (t_c < kLeastDoseC) return 0;
  return t_c > 43 ? std::exp2(t_c - 43) : std::exp2(2 * (t_c - 43));
}

}  // namespace burr::thermal
