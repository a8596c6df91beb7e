// importing/cut_off.h - whether the values of a scan were cut off at an end, as a viewer's window
// does when it saves a scan: all that was darker or brighter became the end's own value.
//
// A pile of voxels lies at exactly the lowest or the highest value and hardly any beside it, though
// the other values are spread by noise. In a scan without noise every material is such a pile, and
// nothing can be said.
// Units: those of the scan. Thread: any.
#pragma once

#include <string>

#include "burr/io/value_groups.h"

namespace burr::importing {

struct CutOff {
  bool low = false, high = false;
  double low_value = 0, low_share = 0;  // the end, and its share of the voxels
  double high_value = 0, high_share = 0;
  [[nodiscard]] bool any() const { return low || high; }
};

[[nodiscard]] CutOff find_cut_off(const io::ValueSample& sample);

// "33 % of the voxels hold exactly the lowest value (0) and 3.7 % the highest (255)"
[[nodiscard]] std::string piles_text(const CutOff& cut);

}  // namespace burr::importing
