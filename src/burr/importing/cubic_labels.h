// importing/cubic_labels.h - labels on a grid of cubic voxels: the solid share of each new voxel, and
// its label. Internal to importing.
// Units: voxels. Thread: any; uses two workers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burr/base/progress.h"
#include "burr/importing/import_plan.h"

namespace burr::importing {

struct CubicLabels {
  std::vector<std::uint8_t> labels;
  std::vector<std::uint8_t> share;  // solid share of each voxel, 0..255; empty: all or nothing
};

// False: cancelled.
[[nodiscard]] bool resample_labels(const LabelRegion& region, const Plan& plan,
                                   const std::array<bool, 256>& solid, CubicLabels& out,
                                   Progress& progress);

}  // namespace burr::importing
