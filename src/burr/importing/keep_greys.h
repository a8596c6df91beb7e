// importing/keep_greys.h - a scan's values in half the memory or less, to be looked at while its bone is
// milled.
//
// Whole numbers that span no more than 65535 are kept exactly, others in 65535 steps. A large scan
// is kept coarser: where there are more than `most` voxels, the finest axis is halved, by averages
// of two, until there are not. Thread: any.
#pragma once

#include <cstddef>
#include <memory>

#include "burr/base/progress.h"
#include "burr/io/scan.h"
#include "burr/volume/greys.h"

namespace burr::importing {

inline constexpr std::size_t kMostGreys = 64'000'000;  // voxels, 2 B each

// nullptr for a label map, or where progress was cancelled. iso: where bone begins.
[[nodiscard]] std::shared_ptr<const volume::Greys> keep_greys(const io::Scan& scan, double iso,
                                                              Progress& progress,
                                                              std::size_t most = kMostGreys);

}  // namespace burr::importing
