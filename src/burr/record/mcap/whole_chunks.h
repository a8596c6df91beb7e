// record/mcap/whole_chunks.h - which chunks of a recording are whole. Plain function.
//
// Thread: any; the reader is read by several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/record/mcap/mcap_reader.h"

namespace burr::record {

// For each of these chunks: 1 if it is whole, else 0. All that is to be unpacked for it is unpacked, by
// several threads.
[[nodiscard]] std::vector<std::uint8_t> whole_chunks(const McapReader& reader,
                                                     const std::vector<std::size_t>& chunks);

}  // namespace burr::record
