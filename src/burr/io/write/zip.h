// io/write/zip.h - a zip file: entries one after another, compressed, without times, so that the same
// content gives the same file (ECMA-376 part 2 for 3MF).
//
//     Zip zip(file);
//     zip.add("a.csv", [&](Deflate& to) { to.write(text.data(), text.size()); return true; });
//     if (!zip.finish()) ...                                   // larger than 4 GB
//
// Thread: one. Errors: those of the file, which keeps them; see base/new_file.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/io/write/deflate.h"

namespace burr::io {

class Zip {
 public:
  explicit Zip(base::NewFile& file) : file_(file) {}

  // fill: writes the content; false to stop, and then add() is false too.
  bool add(const std::string& name, const std::function<bool(Deflate&)>& fill);

  // False: larger than a zip without the 64-bit extension can be.
  [[nodiscard]] bool finish();

 private:
  struct Entry {
    std::string name;
    std::size_t offset = 0;
    std::uint32_t crc = 0;
    std::size_t packed = 0, size = 0;
  };
  void write_header(const Entry& entry, std::uint32_t signature);
  base::NewFile& file_;
  std::vector<Entry> entries_;
};

}  // namespace burr::io
