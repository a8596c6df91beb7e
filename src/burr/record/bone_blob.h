// record/bone_blob.h - a whole bone as one block of bytes, for --embed.
//
//     "BURRBON1" | u32 length, JSON {grid, tissues, has_intensity} | u32 CRC of the JSON
//     then blocks of at most 4096 bricks, brick numbers rising:
//       u32 n (0 ends) | u64 packed size | zstd of [ n x i32 brick | n x 512 x u16 field
//                                                  | n x 512 x u8 tissue
//                                                  | n x 512 x i16 intensity? ]
//       | u32 CRC of the unpacked block
//
// All little-endian; voxels x fastest. Thread: the bone must not be written meanwhile.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/mcap/mcap_bytes.h"
#include "burr/volume/bone.h"

namespace burr::record {

// Memory: the result, and 10 MiB. Time: about 1 s for 300 MiB of bone.
[[nodiscard]] std::vector<std::uint8_t> bone_to_blob(const volume::Bone& bone);

// The same bone (same content_hash), with room for reserve_bricks more. Error: which part is
// damaged; `where` is the file's name for the message.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> bone_from_blob(ByteSpan blob,
                                                                   std::size_t reserve_bricks,
                                                                   const std::string& where);

}  // namespace burr::record
