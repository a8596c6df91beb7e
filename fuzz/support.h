// fuzz/support.h - common to all targets: makes a file of the bytes where a reader needs one, and
// checks the results. docs/develop/fuzzing.md says how to run and add targets.
//
// The readers are called without the fence around them (a fence would only hide a crash). If they
// are renamed, change the calls here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "burr/base/result.h"
#include "burr/io/read/mesh_readers.h"
#include "burr/io/read/read_scan.h"
#include "burr/io/read/readers.h"
#include "burr/io/scan.h"
#include "burr/volume/tissue.h"

namespace burr::fuzz {

using Bytes = std::span<const std::uint8_t>;

// A folder in memory, for this process only; removed at its end.
[[nodiscard]] const std::string& folder();

// Writes the bytes to folder()/name, replacing what was there. Returns the path.
const std::string& as_file(const std::string& name, Bytes bytes);

// What must always be true; otherwise the target stops here as if it had crashed.
void must(bool holds, std::string_view what);

// Checks an error message: not empty, one line, not too long to read, whatever the file put into
// it.
void look_at(const Error& error);
// Checks what the rest of burr relies on in a scan: as many voxels as it says, all finite, a
// right-handed grid with a spacing, colours from 0 to 1.
void look_at(const io::Scan& scan);
void look_at(const volume::TissueTable& tissues);

template <class T>
void look_at_error(const Result<T>& result) {
  if (!result) look_at(result.error());
}

using Reader = Result<io::Scan> (*)(const std::filesystem::path&, const io::ReadOptions&,
                                    Progress&);
// Reads the bytes as a file of that name with one reader.
Result<io::Scan> read_scan_bytes(Reader reader, const std::string& name, Bytes bytes);

// Divides an input into parts: numbers first, text after.
class Pieces {
 public:
  explicit Pieces(Bytes bytes) : left_(bytes) {}
  [[nodiscard]] std::uint8_t byte();
  [[nodiscard]] std::uint16_t word();
  [[nodiscard]] Bytes take(std::size_t size);
  [[nodiscard]] std::string_view line();  // up to the next newline
  [[nodiscard]] Bytes rest() { return take(left_.size()); }
  [[nodiscard]] bool empty() const { return left_.empty(); }

 private:
  Bytes left_;
};

[[nodiscard]] inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace burr::fuzz

// one input; the function that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
