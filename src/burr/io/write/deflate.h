// io/write/deflate.h - compresses bytes with zlib into a file: gzip for NRRD, deflate without
// header for zip.
//
// Thread: one. Errors: those of the file, which keeps them; see base/new_file.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "burr/base/new_file.h"

namespace burr::io {

class Deflate {
 public:
  enum class Kind : std::uint8_t { gzip, bare };
  // level: 1 fast .. 9 small
  Deflate(base::NewFile& file, Kind kind, int level);
  ~Deflate();
  Deflate(const Deflate&) = delete;
  Deflate& operator=(const Deflate&) = delete;

  void write(const void* data, std::size_t size);
  void finish();  // no write() after it

  [[nodiscard]] std::uint64_t bytes_in() const { return in_; }
  [[nodiscard]] std::uint32_t crc32() const { return crc_; }  // of the bytes before compression

 private:
  struct Stream;
  void push(const void* data, std::size_t size, int flush);

  base::NewFile& file_;
  std::unique_ptr<Stream> stream_;
  std::uint64_t in_ = 0;
  std::uint32_t crc_ = 0;
};

}  // namespace burr::io
