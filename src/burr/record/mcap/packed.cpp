#include "burr/record/mcap/packed.h"

#include <zstd.h>

#include <algorithm>
#include <new>

namespace burr::record {

struct Packer::Context {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  ~Context() { ZSTD_freeCCtx(zstd); }
};

Packer::Packer(int level) : context_(std::make_unique<Context>()) {
  if (context_->zstd == nullptr) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context_->zstd, ZSTD_c_compressionLevel, level);
}
Packer::~Packer() = default;

void Packer::pack(ByteSpan bytes, std::vector<std::uint8_t>& out) {
  const std::size_t before = out.size();
  out.resize(before + ZSTD_compressBound(bytes.size()));
  const std::size_t took = ZSTD_compress2(context_->zstd, out.data() + before, out.size() - before,
                                          bytes.data(), bytes.size());
  // with room for the bound, only a lack of memory can make it fail
  if (ZSTD_isError(took) != 0U) throw std::bad_alloc();
  out.resize(before + took);
}

namespace {

struct Unpacker {
  ZSTD_DCtx* zstd = ZSTD_createDCtx();
  Unpacker() = default;
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  ~Unpacker() { ZSTD_freeDCtx(zstd); }
};

// A promise of more is not believed before the bytes are there: unpack() [byte].
constexpr std::uint64_t kBelieved = std::uint64_t{1} << 25;

// All frames at once, into memory of the promised size.
bool unpack_at_once(ZSTD_DCtx* zstd, ByteSpan packed, std::size_t size,
                    std::vector<std::uint8_t>& out) {
  out.resize(size);
  const std::size_t took =
      ZSTD_decompressDCtx(zstd, out.data(), out.size(), packed.data(), packed.size());
  return ZSTD_isError(took) == 0U && took == size;
}

}  // namespace

bool unpack(ByteSpan packed, std::uint64_t size, std::vector<std::uint8_t>& out) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  constexpr std::uint64_t kMost = std::uint64_t{1} << 34;
  constexpr int kWindowLog = 27;                // 128 MiB, zstd's own default limit
  static thread_local const Unpacker unpacker;  // to make one costs as much as to unpack 50 kB
  ZSTD_DCtx* const zstd = unpacker.zstd;
  if (zstd == nullptr) return false;
  ZSTD_DCtx_reset(zstd, ZSTD_reset_session_and_parameters);
  ZSTD_DCtx_setParameter(zstd, ZSTD_d_windowLogMax, kWindowLog);

  out.clear();
  if (size >= kMost) return false;
  if (size > 0 && size <= kBelieved)
    return unpack_at_once(zstd, packed, static_cast<std::size_t>(size), out);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t filled = 0;
  for (;;) {
    // one byte more than promised, so that a frame that is too long is noticed
    if (filled == out.size())
      out.resize(std::min(static_cast<std::size_t>(size) + 1, std::max(2 * filled, kStep)));
    ZSTD_outBuffer to{out.data(), out.size(), filled};
    const std::size_t more = ZSTD_decompressStream(zstd, &to, &in);
    if (ZSTD_isError(more) != 0U) return false;
    filled = to.pos;
    if (filled > size) return false;
    if (more == 0 && in.pos == in.size) break;                   // otherwise another frame follows
    if (in.pos == in.size && filled < out.size()) return false;  // ends too early
  }
  out.resize(filled);
  return filled == size && in.pos == in.size;
}

}  // namespace burr::record
