// importing/scan_notes.h - what a scan cannot show, said before bone is made of it: bone that goes
// on beyond the border, few slices, thick slices.
//
// Units: mm. Frame: LPS. Thread: any.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "burr/io/scan.h"

namespace burr::importing {

// A box of the scan's voxels.
struct NotedRegion {
  math::Ijk from = {0, 0, 0}, size = {0, 0, 0};
  bool whole = true;  // it is the whole scan
};

// solid(i, j, k): whether this voxel of the scan is bone.
[[nodiscard]] std::vector<std::string> scan_notes(
    const io::Scan& scan, const NotedRegion& region,
    const std::function<bool(int i, int j, int k)>& solid);

}  // namespace burr::importing
