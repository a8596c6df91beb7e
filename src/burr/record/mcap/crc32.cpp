#include "burr/record/mcap/crc32.h"

#include <zlib.h>

namespace burr::record {

std::uint32_t crc32(std::uint32_t crc, ByteSpan bytes) noexcept {
  // crc32_z() takes a null pointer for the question what the start is
  return bytes.empty() ? crc
                       : static_cast<std::uint32_t>(::crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace burr::record
