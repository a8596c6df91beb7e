// render/image.h - pixels. Plain data.
#pragma once

#include <cstdint>
#include <vector>

namespace burr::render {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // (height x width x 3), top row first
};

}  // namespace burr::render
