#include "burr/record/mcap/lz4_frame.h"

#include <algorithm>
#include <cstddef>

namespace burr::record {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kFrame = 0x184D2204U;
constexpr std::uint32_t kSkipped = 0x184D2A50U, kSkippedMask = 0xFFFFFFF0U;
constexpr std::uint32_t kStored = 0x80000000U;  // of a block's size: not packed
constexpr std::size_t kShortestMatch = 4, kFarthest = 65535;

// A length of 15 or more goes on in further bytes.
bool get_length(BytesIn& in, std::size_t& length) {
  if (length != 15) return true;
  for (std::uint8_t more = 255; more == 255;) {
    more = in.get<std::uint8_t>();
    length += more;
    if (!in.ok()) return false;
  }
  return true;
}

// from: where the frame began in `out`; matches reach no further back.
bool unpack_block(ByteSpan block, std::size_t from, std::uint64_t most, Bytes& out) {
  BytesIn in(block);
  while (!in.empty()) {
    const auto token = in.get<std::uint8_t>();
    std::size_t literals = token >> 4U, match = token & 15U;
    if (!get_length(in, literals) || literals > most - out.size()) return false;
    const ByteSpan text = in.take(literals);
    if (!in.ok()) return false;
    out.insert(out.end(), text.begin(), text.end());
    if (in.empty()) return true;  // the last part has no match
    const std::size_t back = in.get<std::uint16_t>();
    if (!get_length(in, match) || !in.ok()) return false;
    match += kShortestMatch;
    if (back == 0 || back > kFarthest || back > out.size() - from || match > most - out.size())
      return false;
    // a match may overlap what it makes
    for (std::size_t n = 0; n < match; ++n) out.push_back(out[out.size() - back]);
  }
  return true;
}

struct FrameHead {
  bool block_checksums = false, content_checksum = false;
};

bool get_head(BytesIn& in, FrameHead& head) {
  const auto flags = in.get<std::uint8_t>();
  in.get<std::uint8_t>();  // largest block: each block says its own size
  const bool version_1 = (flags >> 6U) == 1, has_size = (flags & 8U) != 0,
             dictionary = (flags & 1U) != 0;
  head.block_checksums = (flags & 16U) != 0;
  head.content_checksum = (flags & 4U) != 0;
  if (has_size) in.get<std::uint64_t>();
  in.get<std::uint8_t>();  // checksum of this head
  return in.ok() && version_1 && !dictionary;
}

bool unpack_frame(BytesIn& in, std::uint64_t most, Bytes& out) {
  FrameHead head;
  if (!get_head(in, head)) return false;
  const std::size_t from = out.size();
  for (;;) {
    const auto size = in.get<std::uint32_t>();
    if (!in.ok()) return false;
    if (size == 0) break;
    const ByteSpan block = in.take(size & ~kStored);
    if (head.block_checksums) in.get<std::uint32_t>();
    if (!in.ok()) return false;
    if ((size & kStored) != 0) {
      if (block.size() > most - out.size()) return false;
      out.insert(out.end(), block.begin(), block.end());
    } else if (!unpack_block(block, from, most, out)) {
      return false;
    }
  }
  if (head.content_checksum) in.get<std::uint32_t>();
  return in.ok();
}

}  // namespace

bool unpack_lz4(ByteSpan packed, std::uint64_t size, Bytes& out) {
  constexpr std::uint64_t kBelieved = std::uint64_t{1} << 25;  // before the bytes are there
  out.clear();
  out.reserve(static_cast<std::size_t>(std::min(size, kBelieved)));
  BytesIn in(packed);
  while (!in.empty()) {
    const auto magic = in.get<std::uint32_t>();
    if (!in.ok()) return false;
    if ((magic & kSkippedMask) == kSkipped)
      in.take(in.get<std::uint32_t>());
    else if (magic != kFrame || !unpack_frame(in, size, out))
      return false;
    if (!in.ok()) return false;
  }
  return out.size() == size;
}

}  // namespace burr::record
