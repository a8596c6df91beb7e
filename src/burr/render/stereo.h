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
};

// Eyes this far apart, as if one looked at the target from this camera. A share of the distance is
// comfortable: 1/30.
struct Eyes {
  Camera left, right;
};
[[nodiscard]] Eyes eyes_of(const Camera& camera, double apart);

// Both pictures are of the same size, and so is the result. off: the left one.
[[nodiscard]] Image joined(const Image& left, const Image& right, Stereo how);

}  // namespace burr::render
