// io/read/dicom_divide.h - divides slices of one size and orientation by what tells volumes apart:
// kernel, energy, phase, acquisition, time, and blocks that lie far from each other. Internal to io.
// Units: mm. Thread: any.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burr/io/read/dicom_series.h"

namespace burr::io {

using Slices = std::vector<Slice>;

constexpr double kSameSlicePlace = 1e-3;  // slices nearer to each other lie at one place [mm]

struct SliceGroup {
  Slices slices;
  std::string part;            // Volume::part
  bool mixed = false;          // Volume::mixed
  std::size_t same_place = 0;  // Volume::same_place
};

// ordered_by_place: the places are positions, not numbers of pictures, so gaps between blocks count.
[[nodiscard]] std::vector<SliceGroup> divide_slices(const Series& series, Slices slices,
                                                    bool ordered_by_place);

}  // namespace burr::io
