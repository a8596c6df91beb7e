// web/unzstd.h - unpacks zstd (RFC 8878) without zstd's library, which Debian does not have for
// WebAssembly. One frame, no dictionary.
//
// Memory: the result, and 200 kB. Any bytes are refused or unpacked, never believed. Thread: any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burr::web {

// False: not zstd, damaged, or not exactly `size` bytes long. The checksum at the end, if there is
// one, is not compared: what burr packs has sums of its own.
[[nodiscard]] bool unzstd(std::span<const std::uint8_t> packed, std::size_t size,
                          std::vector<std::uint8_t>& out);

}  // namespace burr::web
