#include "burr/render/stereo.h"

#include <algorithm>
#include <cmath>

#include "burr/base/check.h"

namespace burr::render {
namespace {

// luma of BT.601
std::uint8_t grey(const std::uint8_t* rgb) {
  return static_cast<std::uint8_t>(std::lround(0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]));
}

}  // namespace

Eyes eyes_of(const Camera& camera, double eye_distance) {
  Eyes eyes = {camera, camera};
  eyes.left.aside -= eye_distance / 2;
  eyes.right.aside += eye_distance / 2;
  return eyes;
}

Image join_eyes(const Image& left, const Image& right, Stereo how) {
  BURR_CHECK(left.width == right.width && left.height == right.height);
  Image out = left;
  const auto wide = static_cast<std::size_t>(left.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(left.height); ++y)
    for (std::size_t x = 0; x < wide; ++x) {
      const std::size_t at = 3 * (y * wide + x);
      switch (how) {
        case Stereo::off:
        case Stereo::quad_buffer:
          break;
        case Stereo::side_by_side: {
          const std::size_t half = wide / 2;
          const Image& from = x < half ? left : right;
          const std::size_t first = std::min(2 * (x % std::max<std::size_t>(half, 1)), wide - 1);
          const std::size_t second = std::min(first + 1, wide - 1);
          for (std::size_t c = 0; c < 3; ++c)
            out.rgb[at + c] = static_cast<std::uint8_t>(
                (from.rgb[3 * (y * wide + first) + c] + from.rgb[3 * (y * wide + second) + c]) / 2);
          break;
        }
        case Stereo::anaglyph:
          out.rgb[at] = grey(&left.rgb[at]);
          out.rgb[at + 1] = out.rgb[at + 2] = grey(&right.rgb[at]);
          break;
        case Stereo::interleaved:
          if (y % 2 == 1) std::copy_n(&right.rgb[at], 3, &out.rgb[at]);
          break;
      }
    }
  return out;
}

}  // namespace burr::render
