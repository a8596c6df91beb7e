// render/stereo.h - stereo: the cameras of two eyes, and the joining of their two pictures.
//
// The eyes' axes are parallel, and both pictures show the same part of the target's plane (off-axis
// frusta), so nothing is tilted. Frame: world. Units: m.
// Thread: any.
#pragma once

#include <cstdint>
#include <utility>

#include "burr/render/camera.h"
#include "burr/render/image.h"

namespace burr::render {

enum class Stereo : std::uint8_t {
  off,
  side_by_side,  // left eye's picture at the left, both compressed to half their width
  anaglyph,      // red from the left eye, green and blue from the right; in grey, because colours
                 // would flicker
  interleaved,   // even rows from the left eye, odd ones from the right
  quad_buffer,   // a picture for each eye, for a screen that alternates them; only for windows
};

// Settings of a window for two eyes.
struct TwoEyes {
  Stereo how = Stereo::off;
  double eye_distance = 0;  // distance of the eyes, see eyes_of() [m]
  bool swapped = false;     // left and right exchanged, for screens that need it
  int first_row = 0;        // row of the screen on which the window begins, for interleaved [pixel]
};

// The cameras of two eyes that look at the target from this camera. A comfortable distance between
// the eyes is 1/30 of the distance to the target.
inline constexpr double kComfortable = 1.0 / 30;
struct Eyes {
  Camera left, right;
};
[[nodiscard]] Eyes eyes_of(const Camera& camera, double eye_distance);

// Both pictures have the same size, and so has the result. off, quad_buffer: the left picture.
[[nodiscard]] Image join_eyes(const Image& left, const Image& right, Stereo how);

}  // namespace burr::render
