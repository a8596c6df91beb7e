// io/read/compare_frames.h - two statements of one file about where its voxels lie, as the sform and
// the qform of NIfTI. Where they agree nothing is said; where they place the scan elsewhere, a note
// names both; where they make it larger or mirror it, the user is asked. Internal to io.
//
// Units: mm. Frame: that of the affines, which must share it. Thread: any.
#pragma once

#include <string>

#include "burr/io/read/geometry.h"
#include "burr/io/scan.h"

namespace burr::io {

struct StatedFrame {
  Affine affine;
  std::string name;  // "sform"
};

// `used` is the one that places the scan. Needs scan.size; both affines must be usable(). file: its
// name.
void compare_frames(const StatedFrame& used, const StatedFrame& other, const std::string& file,
                    Scan& scan);

}  // namespace burr::io
