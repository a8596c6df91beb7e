// fuzz/support.h - what all targets share: bytes become a file where a reader wants one, and what
// comes back is looked at. docs/fuzzing.md says how to run and add targets.
//
// The readers are called without the fence around them (a fence would only hide a crash); if their
// names change, this is the place to follow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "burr/base/result.h"
#include "burr/io/read/read_scan.h"
#include "burr/io/read/readers.h"
#include "burr/io/scan.h"
#include "burr/volume/tissue.h"

namespace burr::fuzz {

using Bytes = std::span<const std::uint8_t>;

// A folder in memory of this process alone, gone at its end.
[[nodiscard]] const std::string& folder();

// Puts the bytes into folder()/name, whatever was there before. The path.
const std::string& as_file(const std::string& name, Bytes bytes);

// What must always be true; else the target stops here as if it had crashed.
void must(bool holds, std::string_view what);

// A sentence: there, one line, not longer than people read, whatever the file put into it.
void look_at(const Error& error);
// A scan as the rest of burr may rely on it: as many voxels as it says, all finite, a right-handed
// grid with a spacing, colours from 0 to 1.
void look_at(const io::Scan& scan);
void look_at(const volume::TissueTable& tissues);

template <class T>
void look_at_error(const Result<T>& result) {
  if (!result) look_at(result.error());
}

using Reader = Result<io::Scan> (*)(const std::filesystem::path&, const io::ReadOptions&,
                                    Progress&);
// The bytes as a file of that name, through one reader.
Result<io::Scan> read_scan_bytes(Reader reader, const std::string& name, Bytes bytes);

// Takes an input apart: numbers first, text after.
class Pieces {
 public:
  explicit Pieces(Bytes bytes) : left_(bytes) {}
  [[nodiscard]] std::uint8_t byte();
  [[nodiscard]] std::uint16_t word();
  [[nodiscard]] Bytes take(std::size_t size);
  [[nodiscard]] std::string_view line();  // up to the next line feed
  [[nodiscard]] Bytes rest() { return take(left_.size()); }
  [[nodiscard]] bool empty() const { return left_.empty(); }

 private:
  Bytes left_;
};

[[nodiscard]] inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace burr::fuzz

// one input; the greeting libFuzzer knows
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
