// io/read/png.h - one PNG picture as red, green, blue and alpha of 8 bit each, exactly as they are
// stored: no gamma, no colour profile. Decoded by libpng. Internal to io.
//
// Thread: any. Errors: one sentence that names the file without its folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "burr/base/result.h"

namespace burr::io {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows from above to below; 4 bytes a pixel
};

// The file must be a regular one, no link. Pictures of 16 bit are refused: with 8 bits their labels
// would change.
[[nodiscard]] Result<Picture> read_png(const std::filesystem::path& path);

}  // namespace burr::io
