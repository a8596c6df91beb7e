// thermal/dose.h - CEM43: the minutes at 43 deg C that would have the same effect on the tissue.
//
//     dose = sum R^(43 - T) dt          R = 0.5 above 43 deg C, 0.25 below
//
// Sapareto & Dewey 1984. The thresholds usually quoted for bone, 47 deg C for 60 s and 50 deg C for
// 30 s, are 16 and 64 minutes. Below kLeastDoseC nothing is counted: the rule has no data there
// (Dewhirst et al. 2003), and hours at body temperature, which are harmless, would add up (0.015
// min an hour at 37 deg C).
#pragma once

#include <cmath>

namespace burr::thermal {

inline constexpr double kLeastDoseC = 39;  // [deg C]

// Minutes of dose per minute at the temperature t_c [deg C].  [-]
[[nodiscard]] inline double cem43_rate(double t_c) {
  if (t_c < kLeastDoseC) return 0;
  return t_c > 43 ? std::exp2(t_c - 43) : std::exp2(2 * (t_c - 43));
}

}  // namespace burr::thermal
