// record/mcap/lz4_frame.h - unpacks LZ4 frames (LZ4 Frame Format 1.6), which other writers of MCAP
// use; burr itself writes zstd.
//
// Thread: any.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/record/mcap/mcap_bytes.h"

namespace burr::record {

// False: not LZ4 frames, damaged, in need of a dictionary, or not exactly `size` bytes long. Memory
// grows only as bytes really come out. The checksums inside the frames are not looked at: a chunk of
// MCAP has its own.
[[nodiscard]] bool unpack_lz4(ByteSpan packed, std::uint64_t size, std::vector<std::uint8_t>& out);

}  // namespace burr::record
