// web/import/unpack.h - unpacks compressed pictures of DICOM: JPEG lossless, JPEG-LS, JPEG 2000, RLE. On a desktop GDCM does
// this, for which Debian has no library for WebAssembly. JPEG-LS and JPEG 2000 are CharLS and OpenJPEG (codecs_web.cpp), the
// others are ours. Pictures have one channel, as burr's reader has checked.
//
// No input makes these read or write beyond what they are given, or take more memory than some times the picture. They throw
// nothing, but for codecs that are not loaded yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burr::web {

// What is asked for, and what comes of it. The values are rows from the top, as the picture stores them: a
// negative one where the picture itself has signs (JPEG 2000 alone).
struct Unpacked {
  int columns = 0, rows = 0;  // as the caller expects them
  std::vector<std::int32_t> values;
};

// False: damaged, cut off, of another size, or of a kind that is not known here.
[[nodiscard]] bool unpack_jpeg_lossless(std::span<const std::uint8_t> bytes, Unpacked& to);
[[nodiscard]] bool unpack_jpeg_ls(std::span<const std::uint8_t> bytes, Unpacked& to);
[[nodiscard]] bool unpack_jpeg_2000(std::span<const std::uint8_t> bytes, Unpacked& to);
// width: bytes of a value, 1 to 4.
[[nodiscard]] bool unpack_rle(std::span<const std::uint8_t> bytes, int width, Unpacked& to);

}  // namespace burr::web
