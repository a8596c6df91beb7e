// dataset/options.h - what a data set is to hold. Plain struct.
//
// Units: m, s. Thread: any.
#pragma once

#include <cstdint>

namespace burr::dataset {

struct Options {
  double fps = 50;                     // samples of vision_data in a second
  std::uint64_t samples_per_file = 0;  // 0: all in one file
  bool old_names = false;              // also the names of FIVRS' layout 2, as links
  double begins = 0;  // time of the first tick, since 1970 [s]: a recording holds no time of day
  int width = 0, height = 0;  // of the pictures [pixel]; 0: none
  double baseline = 4e-3;     // distance of the two eyes [m]
};

}  // namespace burr::dataset
