// web/import/jpeg_2000_wavelet.h - the inverse wavelets of JPEG 2000 (ITU-T T.800, annex F). Thread-safe: shares nothing.
#pragma once

#include <cstddef>
#include <vector>

namespace burr::web {

// A part of the picture's grid: [x0, x1) x [y0, y1).
struct Area {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] int wide() const { return x1 - x0; }
  [[nodiscard]] int high() const { return y1 - y0; }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(wide()) * static_cast<std::size_t>(high());
  }
};

// Makes the values of `area` from its four bands, which lie in it already as they belong: those of low
// frequency at even places of the grid, those of high frequency at odd ones. whole: the wavelet of whole
// numbers (5-3), else 9-7.
void unwave(std::vector<float>& values, const Area& area, bool whole);

}  // namespace burr::web
