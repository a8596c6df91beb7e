// io/read/bytes.h - where a format's bytes come from: a file, a member of a gzip or bzip2 stream,
// several files in a row. Read once, front to back; never more memory than one block.
//
// Only regular files are opened (no device, pipe or socket that never ends). Private to io.
// Thread: one reader each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::io {

class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  // Up to n bytes; 0 is the end. Errors are sentences about the stream ("the gzip stream is
  // damaged").
  [[nodiscard]] virtual Result<std::size_t> read(void* to, std::size_t n) = 0;
};

// n bytes or an error that says how many there were
[[nodiscard]] Status read_exactly(ByteSource& source, void* to, std::size_t n);
[[nodiscard]] Status skip(ByteSource& source, std::uint64_t n);

// What opening told about a file.
struct OpenFile {
  std::unique_ptr<ByteSource> source;
  std::uint64_t size = 0;  // [byte]
};

// follow_links false: a symbolic link is refused (for names that came out of another file).
[[nodiscard]] Result<OpenFile> open_file(const std::filesystem::path& path,
                                         std::uint64_t offset = 0, bool follow_links = true);
[[nodiscard]] std::unique_ptr<ByteSource> gunzip(std::unique_ptr<ByteSource> packed);
// zlib's own wrapping, as MetaImage has it
[[nodiscard]] std::unique_ptr<ByteSource> inflate_zlib(std::unique_ptr<ByteSource> packed);
// no wrapping at all, as deflated DICOM has it
[[nodiscard]] std::unique_ptr<ByteSource> inflate_raw(std::unique_ptr<ByteSource> packed);
[[nodiscard]] std::unique_ptr<ByteSource> bunzip2(std::unique_ptr<ByteSource> packed);
[[nodiscard]] std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes);
// opens one after the other as they are needed
[[nodiscard]] std::unique_ptr<ByteSource> files_in_a_row(std::vector<std::filesystem::path> paths,
                                                         std::uint64_t skip_each);

// The first n bytes of a file, or all of them if it is shorter.
[[nodiscard]] Result<std::vector<std::uint8_t>> first_bytes(const std::filesystem::path& path,
                                                            std::size_t n,
                                                            bool follow_links = true);

// A name that a header gave for its data file, beside the header: refused when it is absolute,
// climbs or names another folder. `named_in` is the header's own name, for the sentence.
[[nodiscard]] Result<std::filesystem::path> beside(const std::filesystem::path& header,
                                                   const std::string& name);

// A file's name without its folder, for error sentences: the folder may carry a patient's name.
[[nodiscard]] std::string short_name(const std::filesystem::path& path);

// Deflate packs at most 1032 : 1, bzip2 about 45 000 : 1 on zeros; a header that promises more
// lies.
inline constexpr std::uint64_t kMostGzip = 1032;
inline constexpr std::uint64_t kMostBzip2 = 50000;

}  // namespace burr::io
