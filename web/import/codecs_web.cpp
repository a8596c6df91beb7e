// Codecs of others, which JavaScript holds (pages/common/codecs.mjs): zlib's functions by pako, JPEG-LS and JPEG 2000. Where one is
// not loaded yet, the call ends this module with what is missing; the worker loads it and begins again.
#include <emscripten.h>
#include <zlib.h>

#include <cstddef>
#include <cstring>

#include "burr/record/mcap/crc32.h"
#include "unpack.h"

// clang-format off
EM_JS(void, burr_need_codec, (const char* name), {
  const codec = UTF8ToString(name);
  if (!Module['codecs'][codec]) throw Object.assign(new Error('it needs ' + codec), {codec: codec});
});

EM_JS(int, burr_inflate_make, (int window_bits), {
  const zlib = Module['codecs']['zlib'];
  const stream = new zlib.ZStream();
  if (zlib.zlibInflateInit2(stream, window_bits) !== 0) return 0;
  const streams = Module['streams'] || (Module['streams'] = new Map());
  const number = Module['streams_made'] = (Module['streams_made'] || 0) + 1;
  streams.set(number, stream);
  return number;
});
EM_JS(int, burr_inflate_reset, (int number), {
  return Module['codecs']['zlib'].zlibInflateReset(Module['streams'].get(number));
});
EM_JS(void, burr_inflate_end, (int number), {
  Module['streams'].delete(number);
});
// The five numbers are z_stream's next_in, avail_in, next_out, avail_out and total_out.
EM_JS(int, burr_inflate, (int number, unsigned* five), {
  const stream = Module['streams'].get(number);
  const at = five >> 2;
  stream.input = stream.output = HEAPU8;
  stream.next_in = HEAPU32[at];
  stream.avail_in = HEAPU32[at + 1];
  stream.next_out = HEAPU32[at + 2];
  stream.avail_out = HEAPU32[at + 3];
  const said = Module['codecs']['zlib'].zlibInflate(stream, 0);
  HEAPU32[at] = stream.next_in;
  HEAPU32[at + 1] = stream.avail_in;
  HEAPU32[at + 2] = stream.next_out;
  HEAPU32[at + 3] = stream.avail_out;
  HEAPU32[at + 4] = stream.total_out;
  stream.input = stream.output = null;
  return said;
});

EM_JS(int, burr_unpack_picture, (const char* name, const void* bytes, std::size_t size, int columns, int rows, void* to), {
  const values = Module['codecs'][UTF8ToString(name)](HEAPU8.subarray(bytes, bytes + size), columns, rows);
  if (values === null) return 0;
  HEAP32.set(values, to >> 2);
  return 1;
});
// clang-format on

namespace burr::web {
namespace {

bool unpack(const char* codec, std::span<const std::uint8_t> bytes, Unpacked& to) {
  burr_need_codec(codec);
  to.values.resize(static_cast<std::size_t>(to.columns) * static_cast<std::size_t>(to.rows));
  return burr_unpack_picture(codec, bytes.data(), bytes.size(), to.columns, to.rows,
                             to.values.data()) == 1;
}

}  // namespace

bool unpack_jpeg_ls(std::span<const std::uint8_t> bytes, Unpacked& to) {
  return unpack("jpeg_ls", bytes, to);
}

bool unpack_jpeg_2000(std::span<const std::uint8_t> bytes, Unpacked& to) {
  return unpack("jpeg_2000", bytes, to);
}

}  // namespace burr::web

extern "C" {

static_assert(offsetof(z_stream, avail_in) == 4 && offsetof(z_stream, next_out) == 8 &&
              offsetof(z_stream, avail_out) == 12 && offsetof(z_stream, total_out) == 16);

int inflateInit2(z_stream* stream, int window_bits) {
  burr_need_codec("zlib");
  stream->total_out = 0;
  stream->number = burr_inflate_make(window_bits);
  return stream->number == 0 ? Z_MEM_ERROR : Z_OK;
}

int inflateReset(z_stream* stream) {
  stream->total_out = 0;
  return burr_inflate_reset(stream->number);
}

int inflateEnd(z_stream* stream) {
  if (stream->number != 0) burr_inflate_end(stream->number);
  stream->number = 0;
  return Z_OK;
}

int inflate(z_stream* stream, int) {
  return burr_inflate(stream->number, reinterpret_cast<unsigned*>(stream));
}

unsigned long crc32(unsigned long so_far, const Bytef* bytes, uInt count) {
  if (bytes == nullptr) return 0;
  return burr::record::crc32(static_cast<std::uint32_t>(so_far), {bytes, count});
}

}  // extern "C"
