// Packs without zstd's library, in zstd's format: runs of one byte become run-length blocks, all else
// stays as it is (RFC 8878, 3.1.1). A recording is mostly such runs; any zstd can unpack it.
// In place of record/mcap/packed.cpp.
#include <algorithm>
#include <cstring>

#include "burr/record/mcap/packed.h"

namespace burr::record {
namespace {

constexpr std::uint32_t kMagic = 0xFD2FB528;
constexpr std::uint8_t kWhole = 0xA0;  // one segment, with its size in four bytes
constexpr std::size_t kMostBlock = 128 * 1024;
constexpr std::size_t kLeastRun = 12;  // shorter ones are not worth two block headers
enum Kind : std::uint32_t { raw = 0, run = 1 };

void put(std::vector<std::uint8_t>& out, std::uint32_t value, int bytes) {
  for (int n = 0; n < bytes; ++n) out.push_back(static_cast<std::uint8_t>(value >> (8 * n)));
}

void put_block(std::vector<std::uint8_t>& out, Kind kind, ByteSpan bytes, bool last) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  put(out, (last ? 1U : 0U) | kind << 1 | size << 3, 3);
  if (kind == run)
    out.push_back(bytes.front());
  else
    out.insert(out.end(), bytes.begin(), bytes.end());
}

// How many bytes from here on are the same.
std::size_t run_at(ByteSpan bytes, std::size_t at) {
  std::size_t end = at + 1;
  while (end < bytes.size() && bytes[end] == bytes[at]) ++end;
  return end - at;
}

std::uint32_t word_at(ByteSpan bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t n = 0; n < 4; ++n) word |= std::uint32_t{bytes[at + n]} << (8 * n);
  return word;
}

}  // namespace

struct Packer::Context {};
Packer::Packer(int) {}
Packer::~Packer() = default;

void Packer::pack(ByteSpan bytes, std::vector<std::uint8_t>& out) {
  put(out, kMagic, 4);
  out.push_back(kWhole);
  put(out, static_cast<std::uint32_t>(bytes.size()), 4);
  const auto put_pieces = [&](Kind kind, std::size_t from, std::size_t to) {
    for (std::size_t at = from; at < to; at += kMostBlock)
      put_block(out, kind, bytes.subspan(at, std::min(kMostBlock, to - at)), false);
  };
  std::size_t kept = 0;  // from here on nothing is written yet
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t same = run_at(bytes, at);
    if (same >= kLeastRun) {
      put_pieces(raw, kept, at);
      put_pieces(run, at, at + same);
      kept = at + same;
    }
    at += same;
  }
  put_pieces(raw, kept, bytes.size());
  put_block(out, raw, {}, true);
}

// Only what pack() wrote.
bool unpack(ByteSpan packed, std::uint64_t size, std::vector<std::uint8_t>& out) {
  out.clear();
  if (packed.size() < 9 || word_at(packed, 0) != kMagic || packed[4] != kWhole ||
      word_at(packed, 5) != size)
    return false;
  for (std::size_t at = 9; at + 3 <= packed.size();) {
    const std::uint32_t head =
        packed[at] | std::uint32_t{packed[at + 1]} << 8 | std::uint32_t{packed[at + 2]} << 16;
    const std::uint32_t kind = head >> 1 & 3, length = head >> 3;
    at += 3;
    if (length > size - out.size() || kind > run) return false;
    const std::size_t took = kind == run ? 1 : length;
    if (took > packed.size() - at) return false;
    if (kind == run)
      out.insert(out.end(), length, packed[at]);
    else
      out.insert(out.end(), packed.begin() + static_cast<std::ptrdiff_t>(at),
                 packed.begin() + static_cast<std::ptrdiff_t>(at + took));
    at += took;
    if ((head & 1) != 0) return at == packed.size() && out.size() == size;
  }
  return false;
}

}  // namespace burr::record
