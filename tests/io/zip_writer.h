// tests/io/zip_writer.h - a zip archive of stored files, whose names are written as they are given.
#pragma once

#include <string>

#include "io/picture_writer.h"

namespace burr::test {

class ZipWriter {
 public:
  ZipWriter& add(const std::string& name, const std::string& bytes) {
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    const std::string facts = number_bytes(0, 4) + number_bytes(0, 4) + number_bytes(crc, 4) +
                              number_bytes(bytes.size(), 4) + number_bytes(bytes.size(), 4) +
                              number_bytes(name.size(), 2) + number_bytes(0, 2);
    table_ += "PK\x01\x02" + number_bytes(20, 2) + number_bytes(20, 2) + facts +
              number_bytes(0, 10) + number_bytes(out_.size(), 4) + name;
    out_ += "PK\x03\x04" + number_bytes(20, 2) + facts + name + bytes;
    ++files_;
    return *this;
  }
  [[nodiscard]] std::string bytes() const {
    return out_ + table_ + "PK\x05\x06" + number_bytes(0, 4) + number_bytes(files_, 2) +
           number_bytes(files_, 2) + number_bytes(table_.size(), 4) + number_bytes(out_.size(), 4) +
           number_bytes(0, 2);
  }

 private:
  std::string out_, table_;
  std::size_t files_ = 0;
};

}  // namespace burr::test
