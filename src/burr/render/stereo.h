// render/stereo.h - two eyes: the cameras, and their two pictures as one.
//
// Both eyes look at the same plane, that of the target, without turning in (off-axis frusta), so
// that nothing is tilted. Frame: world. Units: m.
#pragma once

#include <cstdint>
#include <utility>

#include "burr/render/camera.h"
#include "burr/render/image.h"

namespace burr::render {

enum class Stereo : std::uint8_t {
  off,
  side_by_side,  // left eye's picture at the left, both squeezed to half their width
  anaglyph,      // red from the left eye, green and blue from the right; shades of grey, as
                 // colours of their own would flicker
  interleaved,   // even rows from the left eye, odd ones from the right
  quad_buffer,   // a picture each, for a screen that shows them in turn; of windows only
};

// How a window is looked at with two eyes.
struct TwoEyes {
  Stereo how = Stereo::off;
  double apart = 0;      // the eyes, see eyes_of()                                         [m]
  bool swapped = false;  // left and right changed over, for screens that show them so
  int first_row = 0;     // of the screen on which the window begins, for interleaved       [pixel]
};

// Eyes this far apart, as if one looked at the target from this camera. A share of the distance is
// comfortable: 1/30.
inline constexpr double kComfortable = 1.0 / 30;
struct Eyes {
  Camera left, right;
};
[[nodiscard]] Eyes eyes_of(const Camera& camera, double apart);

// Both pictures are of the same size, and so is the result. off, quad_buffer: the left one.
[[nodiscard]] Image joined(const Image& left, const Image& right, Stereo how);

}  // namespace burr::render
