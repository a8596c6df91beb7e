// importing/keep_greys.h - keeps a scan's values in half the memory or less, to show them while the
// bone is milled.
//
// Whole numbers that span no more than 65535 are kept exactly, others in 65535 steps. A large scan
// is kept coarser: while there are more than `most` voxels, the finest axis is halved, by averages
// of two. Thread: any.
#pragma once

#include <cstddef>
#include <memory>

#include "burr/base/progress.h"
#include "burr/io/scan.h"
#include "burr/volume/greys.h"

namespace burr::importing {

inline constexpr std::size_t kMostGreys = 64'000'000;  // [voxel], 2 bytes each

// nullptr for a label map, or if progress was cancelled. iso: the value at which bone begins.
[[nodiscard]] std::shared_ptr<const volume::Greys> keep_greys(const io::Scan& scan, double iso,
                                                              Progress& progress,
                                                              std::size_t most = kMostGreys);

}  // namespace burr::importing
