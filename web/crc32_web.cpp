// CRC-32 by a table. In place of record/mcap/crc32.cpp, which asks zlib.
#include <array>

#include "burr/record/mcap/crc32.h"

namespace burr::record {
namespace {

constexpr std::array<std::uint32_t, 256> table() {
  std::array<std::uint32_t, 256> all{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xEDB88320U ^ c >> 1 : c >> 1;
    all[n] = c;
  }
  return all;
}
constexpr std::array<std::uint32_t, 256> kTable = table();

}  // namespace

std::uint32_t crc32(std::uint32_t so_far, ByteSpan bytes) noexcept {
  std::uint32_t c = ~so_far;
  for (const std::uint8_t byte : bytes) c = kTable[(c ^ byte) & 0xFF] ^ c >> 8;
  return ~c;
}

}  // namespace burr::record
