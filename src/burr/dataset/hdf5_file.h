// dataset/hdf5_file.h - writes one HDF5 file: groups, texts, numbers, and columns that grow.
//
//     Hdf5File file("a.hdf5");
//     Column& time = file.column("/ticks/time", Kind::f64, {}, 4096);
//     time.add(&seconds);                       // a row
//     const Status whole = file.finish();       // written under its name only now
//
// Groups on the way to a name come into being by themselves. The first error is kept, later calls do
// nothing, and finish() tells it. Files hold no times of their own, so equal content is equal bytes,
// and use no feature younger than HDF5 1.8, which h5py and MATLAB have read for years.
// Thread: one at a time in the whole process (Debian's libhdf5 has no locks).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::dataset {

// How a number is stored; little endian. f16: rows are given as bits, see half_of().
enum class Kind : std::uint8_t { f64, f16, i32, u8 };
[[nodiscard]] std::size_t bytes_of(Kind kind);

// The nearest number of 16 bits (IEEE 754), ties to even; too large ones become infinite.
[[nodiscard]] std::uint16_t half_of(float value);

class Hdf5File;

// A dataset that grows by rows; rows are packed (shuffle, gzip 4) some at a time.
class Column {
 public:
  // row: as many numbers as a row has, in the column's own kind.
  void add(const void* row);
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  friend class Hdf5File;
  void flush();

  Hdf5File* file_ = nullptr;
  std::int64_t dataset_ = -1;
  Kind kind_ = Kind::f64;
  std::vector<std::uint64_t> row_shape_;
  std::size_t row_bytes_ = 0, rows_at_once_ = 0;
  std::uint64_t rows_ = 0;          // given
  std::vector<std::byte> waiting_;  // given, not yet in the file
};

class Hdf5File {
 public:
  // Writes beside `path` until finish().
  explicit Hdf5File(std::string path);
  ~Hdf5File();  // without finish(): nothing is left
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  void group(const std::string& name);
  void text(const std::string& name, const std::string& text);  // UTF-8
  void texts(const std::string& name, std::span<const std::string> texts);
  // shape: {} for one number, {3, 3} for nine
  void numbers(const std::string& name, std::span<const double> values,
               std::vector<std::uint64_t> shape);
  // A text that says something of a dataset or group that is there.
  void note(const std::string& name, const char* key, const std::string& text);
  // Another name for `target`.
  void link(const std::string& name, const std::string& target);
  // row_shape: {} for a number a row, {480, 640} for a picture. rows_at_once: packed together.
  Column& column(const std::string& name, Kind kind, std::vector<std::uint64_t> row_shape,
                 std::size_t rows_at_once);

  [[nodiscard]] Status finish();

 private:
  friend class Column;
  void wrong(const std::string& what);
  [[nodiscard]] std::int64_t create(const std::string& name, std::int64_t type, std::int64_t space,
                                    std::int64_t properties);
  void close();

  std::string path_, beside_;
  std::int64_t file_ = -1, links_ = -1;
  std::string trouble_;  // the first; empty: none
  std::deque<Column> columns_;
};

}  // namespace burr::dataset
