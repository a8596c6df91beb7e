#include "burr/io/read/bytes.h"

#include <bzlib.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "burr/base/plain_file.h"
#include "burr/base/printable.h"

namespace burr::io {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;

class FileSource final : public ByteSource {
 public:
  explicit FileSource(int handle) : handle_(handle) {}
  ~FileSource() override { ::close(handle_); }

  Result<std::size_t> read(void* to, std::size_t n) override {
    while (true) {
      const ssize_t got = ::read(handle_, to, std::min(n, std::size_t{1} << 30));
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno != EINTR) return error(Trouble::io, std::strerror(errno));
    }
  }

 private:
  int handle_;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  Result<std::size_t> read(void* to, std::size_t n) override {
    const std::size_t take = std::min(n, bytes_.size() - at_);
    if (take > 0) std::memcpy(to, bytes_.data() + at_, take);
    at_ += take;
    return take;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

class FilesSource final : public ByteSource {
 public:
  FilesSource(std::vector<std::filesystem::path> paths, std::uint64_t skip_each)
      : paths_(std::move(paths)), skip_(skip_each) {}

  Result<std::size_t> read(void* to, std::size_t n) override {
    while (true) {
      if (!now_) {
        if (next_ == paths_.size()) return std::size_t{0};
        auto file = open_file(paths_[next_++], skip_, false);
        if (!file) return file.error();
        now_ = std::move(file->source);
      }
      auto got = now_->read(to, n);
      if (!got || *got > 0) return got;
      now_.reset();
    }
  }

 private:
  std::vector<std::filesystem::path> paths_;
  std::uint64_t skip_;
  std::size_t next_ = 0;
  std::unique_ptr<ByteSource> now_;
};

// zlib with any wrapping. Several gzip members in a row are one stream; junk after them is ignored.
class Inflate final : public ByteSource {
 public:
  Inflate(std::unique_ptr<ByteSource> packed, int window_bits)
      : packed_(std::move(packed)), members_(window_bits > 16) {
    ready_ = inflateInit2(&stream_, window_bits) == Z_OK;
  }
  ~Inflate() override { inflateEnd(&stream_); }

  Result<std::size_t> read(void* to, std::size_t n) override {
    if (!ready_) return error(Trouble::io, "there is not enough memory to decompress the data");
    n = std::min(n, std::size_t{1} << 30);
    stream_.next_out = static_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(n);
    while (stream_.avail_out > 0 && !done_) {
      if (stream_.avail_in == 0) {
        auto got = packed_->read(in_.data(), in_.size());
        if (!got) return got.error();
        if (*got == 0) {
          if (between_members_) done_ = true;
          if (n > stream_.avail_out || done_) break;
          return error("the compressed data ends early; the file is cut off, copy it again");
        }
        stream_.next_in = in_.data();
        stream_.avail_in = static_cast<uInt>(*got);
      }
      const int state = ::inflate(&stream_, Z_NO_FLUSH);
      if (state == Z_STREAM_END) {
        between_members_ = true;
        if (!members_ || inflateReset(&stream_) != Z_OK) done_ = true;
      } else if (state != Z_OK && state != Z_BUF_ERROR) {
        if (!between_members_) return error("the compressed data is damaged; copy the file again");
        done_ = true;  // the last member is followed by something else than gzip
      } else {
        between_members_ = between_members_ && stream_.total_out == 0;
      }
    }
    return n - stream_.avail_out;
  }

 private:
  std::unique_ptr<ByteSource> packed_;
  z_stream stream_{};
  std::array<Bytef, kBlock> in_{};
  bool members_, ready_ = false, done_ = false, between_members_ = false;
};

// Gives some bytes that were read ahead, then the rest.
class ReadAhead final : public ByteSource {
 public:
  ReadAhead(std::vector<std::uint8_t> first, std::unique_ptr<ByteSource> rest)
      : first_(std::move(first)), rest_(std::move(rest)) {}
  Result<std::size_t> read(void* to, std::size_t n) override {
    if (at_ == first_.size()) return rest_->read(to, n);
    const std::size_t take = std::min(n, first_.size() - at_);
    std::memcpy(to, first_.data() + at_, take);
    at_ += take;
    return take;
  }

 private:
  std::vector<std::uint8_t> first_;
  std::size_t at_ = 0;
  std::unique_ptr<ByteSource> rest_;
};

class Bunzip2 final : public ByteSource {
 public:
  explicit Bunzip2(std::unique_ptr<ByteSource> packed) : packed_(std::move(packed)) {
    ready_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK;
  }
  ~Bunzip2() override {
    if (ready_) BZ2_bzDecompressEnd(&stream_);
  }

  Result<std::size_t> read(void* to, std::size_t n) override {
    if (!ready_) return error(Trouble::io, "there is not enough memory to decompress the data");
    n = std::min(n, std::size_t{1} << 30);
    stream_.next_out = static_cast<char*>(to);
    stream_.avail_out = static_cast<unsigned>(n);
    while (stream_.avail_out > 0 && !done_) {
      if (stream_.avail_in == 0) {
        auto got = packed_->read(in_.data(), in_.size());
        if (!got) return got.error();
        if (*got == 0) {
          if (n > stream_.avail_out) break;
          return error("the compressed data ends early; the file is cut off, copy it again");
        }
        stream_.next_in = in_.data();
        stream_.avail_in = static_cast<unsigned>(*got);
      }
      const int state = BZ2_bzDecompress(&stream_);
      if (state == BZ_STREAM_END) {
        done_ = true;
      } else if (state != BZ_OK) {
        return error("the compressed data is damaged; copy the file again");
      }
    }
    return n - stream_.avail_out;
  }

 private:
  std::unique_ptr<ByteSource> packed_;
  bz_stream stream_{};
  std::array<char, kBlock> in_{};
  bool ready_ = false, done_ = false;
};

}  // namespace

Status read_exactly(ByteSource& source, void* to, std::size_t n) {
  auto* at = static_cast<std::uint8_t*>(to);
  std::size_t have = 0;
  while (have < n) {
    auto got = source.read(at + have, n - have);
    if (!got) return got.error();
    if (*got == 0)
      return error(fmt::format("the data ends {} bytes early; the file is cut off, copy it again",
                               n - have));
    have += *got;
  }
  return fine();
}

Status skip(ByteSource& source, std::uint64_t n) {
  std::vector<std::uint8_t> block(kBlock);
  while (n > 0) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(n, block.size()));
    if (Status status = read_exactly(source, block.data(), part); !status) return status;
    n -= part;
  }
  return fine();
}

namespace {
OpenInside open_inside = nullptr;
}  // namespace

void set_files_inside(OpenInside open) { open_inside = open; }

Result<OpenFile> open_file(const std::filesystem::path& path, std::uint64_t offset,
                           bool follow_links) {
  if (open_inside != nullptr)
    if (auto inside = open_inside(path, offset)) return std::move(*inside);
  const auto refused = [&](const char* why) {
    return error(Trouble::io, fmt::format("{}: {}", short_name(path), why));
  };
  // check it before opening: merely opening a device can have an effect
  struct stat facts = {};
  if (::fstatat(AT_FDCWD, path.c_str(), &facts, follow_links ? 0 : AT_SYMLINK_NOFOLLOW) != 0)
    return refused(fmt::format("cannot be opened: {}", std::strerror(errno)).c_str());
  if (S_ISLNK(facts.st_mode))
    return refused("cannot be opened: it is a link, and burr does not follow links in this place");
  if (const std::string wrong = base::no_plain_file(facts.st_mode); !wrong.empty())
    return refused(wrong.c_str());
  // O_NONBLOCK: if it has become a pipe since, opening must not wait for a writer
  const int handle = ::open(
      path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | (follow_links ? 0 : O_NOFOLLOW));
  if (handle < 0) return refused(fmt::format("cannot be opened: {}", std::strerror(errno)).c_str());
  auto source = std::make_unique<FileSource>(handle);
  if (::fstat(handle, &facts) != 0) return refused("cannot be read");
  if (const std::string wrong = base::no_plain_file(facts.st_mode); !wrong.empty())
    return refused(wrong.c_str());
  if (offset > 0 && ::lseek(handle, static_cast<off_t>(offset), SEEK_SET) < 0)
    return error(Trouble::io,
                 fmt::format("{}: cannot be read: {}", short_name(path), std::strerror(errno)));
  return OpenFile{std::move(source), static_cast<std::uint64_t>(facts.st_size)};
}

std::unique_ptr<ByteSource> gunzip(std::unique_ptr<ByteSource> packed) {
  return std::make_unique<Inflate>(std::move(packed), 16 + MAX_WBITS);
}
std::unique_ptr<ByteSource> inflate_zlib(std::unique_ptr<ByteSource> packed) {
  return std::make_unique<Inflate>(std::move(packed), MAX_WBITS);
}
std::unique_ptr<ByteSource> inflate_raw(std::unique_ptr<ByteSource> packed) {
  return std::make_unique<Inflate>(std::move(packed), -MAX_WBITS);
}
std::unique_ptr<ByteSource> bunzip2(std::unique_ptr<ByteSource> packed) {
  return std::make_unique<Bunzip2>(std::move(packed));
}
std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes) {
  return std::make_unique<MemorySource>(std::move(bytes));
}
std::unique_ptr<ByteSource> concatenate_files(std::vector<std::filesystem::path> paths,
                                              std::uint64_t skip_each) {
  return std::make_unique<FilesSource>(std::move(paths), skip_each);
}

Result<UnpackedFile> open_unpacked(const std::filesystem::path& path, bool follow_links) {
  constexpr int kMostLayers = 3;  // of packing; more is no accident
  auto file = open_file(path, 0, follow_links);
  if (!file) return file.error();
  UnpackedFile out;
  out.most = file->size;
  out.source = std::move(file->source);
  for (int layer = 0;; ++layer) {
    std::vector<std::uint8_t> head(3);
    std::size_t have = 0;
    while (have < head.size()) {
      auto got = out.source->read(head.data() + have, head.size() - have);
      if (!got) return got.error();
      if (*got == 0) break;
      have += *got;
    }
    head.resize(have);
    const bool gzip = have >= 2 && head[0] == 0x1F && head[1] == 0x8B;
    const bool bzip = have == 3 && head[0] == 'B' && head[1] == 'Z' && head[2] == 'h';
    out.source = std::make_unique<ReadAhead>(std::move(head), std::move(out.source));
    if (!gzip && !bzip) return out;
    if (layer == kMostLayers)
      return error("the data is packed more than three times; unpack it first");
    out.source = gzip ? gunzip(std::move(out.source)) : bunzip2(std::move(out.source));
    const std::uint64_t ratio = gzip ? kMostGzip : kMostBzip2;
    out.most = std::min(out.most, std::numeric_limits<std::uint64_t>::max() / ratio) * ratio;
    out.packed = true;
  }
}

Result<std::vector<std::uint8_t>> first_unpacked_bytes(const std::filesystem::path& path,
                                                       std::size_t n) {
  auto file = open_unpacked(path);
  if (!file) return file.error();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(n, file->most)));
  std::size_t have = 0;
  while (have < bytes.size()) {
    auto got = file->source->read(bytes.data() + have, bytes.size() - have);
    if (!got)
      return error(got.error().trouble, fmt::format("{}: {}", short_name(path), got.error().text));
    if (*got == 0) break;
    have += *got;
  }
  bytes.resize(have);
  return bytes;
}

Result<std::vector<std::uint8_t>> first_bytes(const std::filesystem::path& path, std::size_t n,
                                              bool follow_links) {
  auto file = open_file(path, 0, follow_links);
  if (!file) return file.error();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(n, file->size)));
  std::size_t have = 0;
  while (have < bytes.size()) {
    auto got = file->source->read(bytes.data() + have, bytes.size() - have);
    if (!got)
      return error(Trouble::io,
                   fmt::format("{}: cannot be read: {}", short_name(path), got.error().text));
    if (*got == 0) break;
    have += *got;
  }
  bytes.resize(have);
  return bytes;
}

bool is_dicomdir(const std::filesystem::path& path) {
  constexpr std::size_t kHead = 512;
  const auto head = first_bytes(path, kHead);
  if (!head || head->size() < 132 || std::memcmp(head->data() + 128, "DICM", 4) != 0) return false;
  const std::string_view bytes(reinterpret_cast<const char*>(head->data()), head->size());
  return bytes.find("1.2.840.10008.1.3.10") != std::string_view::npos;
}

Result<std::filesystem::path> beside(const std::filesystem::path& header, const std::string& name) {
  std::string plain = name;
  while (plain.rfind("./", 0) == 0) plain.erase(0, 2);
  const bool bad = plain.empty() || plain == "." || plain == ".." ||
                   plain.find('/') != std::string::npos || plain.find('\\') != std::string::npos ||
                   plain.find('\0') != std::string::npos;
  if (bad)
    return error(
        fmt::format("{}: its data file must be in the same folder, but the header names another "
                    "place; move the file and correct its name in the header",
                    short_name(header)));
  return header.parent_path() / plain;
}

std::string short_name(const std::filesystem::path& path) {
  constexpr std::size_t kLongestName = 255;  // of a file name, on every system [byte]
  const auto name = path.filename().string();
  if (!name.empty() && name != ".") return base::printable(name, kLongestName);
  const auto parent = path.parent_path().filename().string();
  return base::printable(parent.empty() ? path.string() : parent, kLongestName);
}

}  // namespace burr::io
