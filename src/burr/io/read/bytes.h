// io/read/bytes.h - the source of a file format's bytes: a file, a gzip or bzip2 stream in it, or
// several files in a row. Read once, from front to back; holds one block in memory at most.
//
// Only regular files are opened (no device, pipe or socket, which may never end). Internal to io.
// Thread: one reader each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
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

  // Reads up to n bytes and returns how many; 0 is the end. Errors are sentences about the stream
  // ("the gzip stream is damaged").
  [[nodiscard]] virtual Result<std::size_t> read(void* to, std::size_t n) = 0;
};

// Reads n bytes; the error says how many there were.
[[nodiscard]] Status read_exactly(ByteSource& source, void* to, std::size_t n);
[[nodiscard]] Status skip(ByteSource& source, std::uint64_t n);

// An open file and its size.
struct OpenFile {
  std::unique_ptr<ByteSource> source;
  std::uint64_t size = 0;  // [byte]
};

// Files inside an archive, which open_file() asks before the disk: the file from that offset on, or
// nothing if it is none of these. Set before reading begins, from one thread.
using OpenInside = std::optional<Result<OpenFile>> (*)(const std::filesystem::path& path,
                                                       std::uint64_t offset);
void set_files_inside(OpenInside open);

// follow_links false: a symbolic link is refused (for names that come from another file).
[[nodiscard]] Result<OpenFile> open_file(const std::filesystem::path& path,
                                         std::uint64_t offset = 0, bool follow_links = true);
[[nodiscard]] std::unique_ptr<ByteSource> gunzip(std::unique_ptr<ByteSource> packed);
// a zlib stream, as in MetaImage
[[nodiscard]] std::unique_ptr<ByteSource> inflate_zlib(std::unique_ptr<ByteSource> packed);
// a deflate stream without header, as in deflated DICOM
[[nodiscard]] std::unique_ptr<ByteSource> inflate_raw(std::unique_ptr<ByteSource> packed);
[[nodiscard]] std::unique_ptr<ByteSource> bunzip2(std::unique_ptr<ByteSource> packed);
[[nodiscard]] std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes);
// opens each file when the one before it has ended
[[nodiscard]] std::unique_ptr<ByteSource> concatenate_files(
    std::vector<std::filesystem::path> paths, std::uint64_t skip_each);

// A file whose bytes may be packed with gzip or bzip2, more than once: told by the bytes, not by the
// name.
struct UnpackedFile {
  std::unique_ptr<ByteSource> source;
  std::uint64_t most = 0;  // largest number of bytes that it can give
  bool packed = false;
};
[[nodiscard]] Result<UnpackedFile> open_unpacked(const std::filesystem::path& path,
                                                 bool follow_links = true);
// The first n bytes of it, or all of them if there are fewer.
[[nodiscard]] Result<std::vector<std::uint8_t>> first_unpacked_bytes(
    const std::filesystem::path& path, std::size_t n);

// The first n bytes of a file, or all of them if it is shorter.
[[nodiscard]] Result<std::vector<std::uint8_t>> first_bytes(const std::filesystem::path& path,
                                                            std::size_t n,
                                                            bool follow_links = true);

// An index of DICOM files (DICOMDIR), by its first bytes: the files lie in its folder.
[[nodiscard]] bool is_dicomdir(const std::filesystem::path& path);

// The file's name without its folder, for error messages: the folder may carry a patient's name.
[[nodiscard]] std::string short_name(const std::filesystem::path& path);

// Deflate packs at most 1032 : 1, bzip2 about 45 000 : 1 on zeros; a header that promises more is
// false.
inline constexpr std::uint64_t kMostGzip = 1032;
inline constexpr std::uint64_t kMostBzip2 = 50000;

}  // namespace burr::io
