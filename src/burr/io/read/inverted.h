// io/read/inverted.h - pictures in which dark is dense (MONOCHROME1) and whose values are not HU:
// they are turned round, so that bone is bright as everywhere else. Internal to io.
//
// Around a body lies air, so the corners of a scan tell whether the header is right.
// Units: those of the file. Thread: any.
#pragma once

#include <string>

#include "burr/io/scan.h"

namespace burr::io {

// Whether air, as the corners show it, is the bright end of the values (1), the dark end (-1), or
// neither can be said (0). Voxels that are NaN, or Scan::outside, were not measured.
[[nodiscard]] int bright_air(const Scan& scan);

// Of a scan that is not in HU and whose header says that dark is dense: each value v becomes
// least + greatest - v. Where the corners are dark nothing is turned, and the user is asked.
// file: its name.
void turn_inverted(Scan& scan, const std::string& file);

}  // namespace burr::io
