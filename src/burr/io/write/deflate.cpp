#include "burr/io/write/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <vector>

#include "burr/base/check.h"

namespace burr::io {

struct Deflate::Stream {
  z_stream zlib{};
  std::vector<unsigned char> out = std::vector<unsigned char>(std::size_t{1} << 18);
};

Deflate::Deflate(base::NewFile& file, Kind kind, int level)
    : file_(file), stream_(std::make_unique<Stream>()) {
  constexpr int kWindow = 15, kGzip = 16;
  const int bits = kind == Kind::gzip ? kWindow + kGzip : -kWindow;
  BURR_CHECK(deflateInit2(&stream_->zlib, level, Z_DEFLATED, bits, 8, Z_DEFAULT_STRATEGY) == Z_OK);
}

Deflate::~Deflate() { deflateEnd(&stream_->zlib); }

void Deflate::push(const void* data, std::size_t size, int flush) {
  z_stream& z = stream_->zlib;
  z.next_in = static_cast<Bytef*>(const_cast<void*>(data));  // zlib only reads it
  z.avail_in = static_cast<uInt>(size);
  do {
    z.next_out = stream_->out.data();
    z.avail_out = static_cast<uInt>(stream_->out.size());
    BURR_CHECK(deflate(&z, flush) != Z_STREAM_ERROR);
    file_.write(stream_->out.data(), stream_->out.size() - z.avail_out);
  } while (z.avail_out == 0);
}

void Deflate::write(const void* data, std::size_t size) {
  constexpr std::size_t kPiece = std::size_t{1} << 30;  // zlib counts in 32 bits
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const std::size_t now = std::min(size, kPiece);
    crc_ = static_cast<std::uint32_t>(
        ::crc32(crc_, reinterpret_cast<const Bytef*>(bytes), static_cast<uInt>(now)));
    push(bytes, now, Z_NO_FLUSH);
    in_ += now;
    bytes += now;
    size -= now;
  }
}

void Deflate::finish() { push(nullptr, 0, Z_FINISH); }

}  // namespace burr::io
