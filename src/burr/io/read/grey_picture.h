// io/read/grey_picture.h - one picture of a stack as grey numbers, exactly as they are stored: no gamma, no
// colour profile. Internal to io.
//
// Thread: any. Errors: one sentence that names the file without its folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/samples.h"

namespace burr::io {

enum class PictureKind : std::uint8_t { none, tiff, png, bmp };
// By the first bytes of the file.
[[nodiscard]] PictureKind picture_kind(const std::vector<std::uint8_t>& head);
[[nodiscard]] const char* name_of(PictureKind kind);

struct GreyPicture {
  int width = 0, height = 0;
  int bits = 8;  // as the file states them; fewer than 8 are a byte each here
  SampleType type = SampleType::u8;
  std::vector<std::uint8_t>
      samples;            // rows from above to below, in the byte order of this computer
  bool inverted = false;  // the file calls white 0; turned round here
};

// Numbers of `channels` for each pixel, the last of which is opaqueness where it is the second or fourth:
// what is left is the grey value. Error: it is a colour.
[[nodiscard]] Status keep_grey(GreyPicture& picture, int channels, const std::string& file);

[[nodiscard]] Result<GreyPicture> read_grey_png(const std::filesystem::path& path);
[[nodiscard]] Result<GreyPicture> read_grey_bmp(const std::filesystem::path& path);

}  // namespace burr::io
