// record/mcap/crc32.h - the checksum of MCAP (and zip, PNG, Ethernet): CRC-32, polynomial
// 0xEDB88320.
//
// Thread: any.
#pragma once

#include <cstdint>

#include "burr/record/mcap/mcap_bytes.h"

namespace burr::record {

// crc: the value for the bytes before these, 0 at the start. zlib computes it: 0.3 ns per byte.
[[nodiscard]] std::uint32_t crc32(std::uint32_t crc, ByteSpan bytes) noexcept;
[[nodiscard]] inline std::uint32_t crc32(ByteSpan bytes) noexcept { return crc32(0, bytes); }

}  // namespace burr::record
