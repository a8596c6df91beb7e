// io/read/tiff.h - the pages of a TIFF file as grey pictures. Decoded by libtiff, from memory, with limits on
// what it may ask for. Internal to io.
//
// Thread: one at a time. Errors: one sentence that names the file without its folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/grey_picture.h"

namespace burr::io {

// What the first page says of the picture as a whole.
struct TiffWords {
  std::string description;  // Image Description: ImageJ's or OME's lines, or free text
  double per_unit_x = 0, per_unit_y = 0;  // pixels in a unit; 0: not stated
};

class TiffFile {
 public:
  [[nodiscard]] static Result<std::unique_ptr<TiffFile>> open(const std::filesystem::path& path);
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;
  virtual ~TiffFile() = default;

  // Pages of full size; thumbnails and smaller copies are not counted.
  [[nodiscard]] virtual std::size_t pages() const = 0;
  [[nodiscard]] virtual const TiffWords& words() const = 0;
  [[nodiscard]] virtual Result<GreyPicture> read(std::size_t page) = 0;

 protected:
  TiffFile() = default;
};

}  // namespace burr::io
