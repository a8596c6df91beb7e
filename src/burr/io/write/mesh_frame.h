// io/write/mesh_frame.h - the axes of a written file. Millimetres in all of them.
//
// Plain data.
#pragma once

#include <cstdint>

namespace burr::io {

enum class Frame : std::uint8_t {
  lps,    // left, posterior, superior: as in the scan; 3D Slicer expects it
  ras,    // right, anterior, superior: x and y negated
  print,  // z up (superior), on the print bed at z = 0, centred at the origin in x and y
};

}  // namespace burr::io
