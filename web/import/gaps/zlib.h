// What burr's readers use of zlib, which Debian has no library of for WebAssembly. pako does it: web/import/codecs_web.cpp.
// Only reading, and only Z_NO_FLUSH.
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

using Bytef = unsigned char;
using uInt = unsigned int;

struct z_stream {  // NOLINT(readability-identifier-naming): zlib's name
  Bytef* next_in;
  uInt avail_in;
  Bytef* next_out;
  uInt avail_out;
  unsigned long total_out;
  int number;  // of its stream in JavaScript
};

enum { Z_OK = 0, Z_STREAM_END = 1, Z_DATA_ERROR = -3, Z_MEM_ERROR = -4, Z_BUF_ERROR = -5 };
enum { Z_NO_FLUSH = 0, MAX_WBITS = 15 };

// window_bits: MAX_WBITS: zlib's wrapping; 16 + MAX_WBITS: gzip's; -MAX_WBITS: none.
int inflateInit2(z_stream* stream, int window_bits);
int inflate(z_stream* stream, int flush);
int inflateReset(z_stream* stream);
int inflateEnd(z_stream* stream);
unsigned long crc32(unsigned long so_far, const Bytef* bytes, uInt count);

#ifdef __cplusplus
}
#endif
