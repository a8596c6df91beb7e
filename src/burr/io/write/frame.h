// io/write/frame.h - which axes a written file uses. Millimetres in all of them.
#pragma once

#include <cstdint>

namespace burr::io {

enum class Frame : std::uint8_t {
  lps,    // left, posterior, superior: as the scan, and what Slicer expects
  ras,    // right, anterior, superior: x and y negated
  print,  // z up (superior), standing on the bed at z = 0, centred at the origin in x and y
};

}  // namespace burr::io
