// web/import/jpeg_2000_blocks.h - the code blocks of JPEG 2000 (ITU-T T.800, annexes C and D). Thread-safe: shares nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burr::web {

// How a block is coded (table A.19).
enum BlockStyle : int {
  kBypass = 1,       // the lower planes are plain bits
  kForget = 2,       // contexts begin anew with each pass
  kEachPass = 4,     // each pass ends its codeword
  kCausal = 8,       // no stripe looks into the next one
  kSegmentMark = 32  // four bits behind each clean-up
};

enum class Band { ll, hl, lh, hh };

// Some passes of a block that share a codeword.
struct Segment {
  int passes = 0;
  std::vector<std::uint8_t> bytes;
};

// The coefficients of a block, twice as large as they are, since the last bit that was read stands for a
// half more; rows from the top. planes: of magnitude bits.
[[nodiscard]] std::vector<std::int32_t> decode_block(int wide, int high, int planes, Band band,
                                                     int style, std::span<const Segment> segments);

}  // namespace burr::web
