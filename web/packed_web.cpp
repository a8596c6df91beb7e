// Packs without zstd's library, in zstd's format: runs of one byte become run-length blocks, all else
// stays as it is (RFC 8878, 3.1.1). A recording is mostly such runs; any zstd can unpack it. To unpack, zstd itself is there,
// in a module of its own that JavaScript holds (pages/common/codecs.mjs).
// In place of record/mcap/packed.cpp.
#include <emscripten.h>

#include <algorithm>

#include "burr/record/mcap/packed.h"

// clang-format off
EM_JS(int, burr_unzstd, (const void* packed, std::size_t packed_size, void* to, std::size_t size), {
  const done = Module['codecs']['zstd'](HEAPU8.subarray(packed, packed + packed_size), size, (bytes) => {
    HEAPU8.set(bytes, to);
    return true;
  });
  return done === true ? 1 : 0;
});
// clang-format on

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

bool unpack(ByteSpan packed, std::uint64_t size, std::vector<std::uint8_t>& out) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;
  // the most that zstd packs into a byte: a block of 128 kB that is one byte again and again takes four
  constexpr std::uint64_t kMostPerByte = kMostBlock / 4;
  out.clear();
  if (packed.empty() || size >= kMost || size > packed.size() * kMostPerByte) return false;
  out.resize(static_cast<std::size_t>(size));
  return burr_unzstd(packed.data(), packed.size(), out.data(), out.size()) == 1;
}

}  // namespace burr::record
