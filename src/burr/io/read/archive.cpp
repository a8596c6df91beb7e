// Zip as in PKWARE's APPNOTE: stored and deflated entries. Encrypted archives, other methods and
// zip64 are refused with what to do instead.
#include "burr/io/read/archive.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "burr/io/read/bytes.h"
#include "burr/io/read/letters.h"

namespace burr::io {
namespace {

constexpr std::size_t kMostEntries = 100000;

struct Entry {
  std::uint64_t at = 0;  // of its local header in the archive
  std::uint64_t packed = 0, size = 0;
  bool deflated = false;
  std::uint32_t crc = 0;
  bool checked = false;  // its bytes are those of the checksum
};

struct Archive {
  std::filesystem::path path;
  std::map<std::string, Entry> entries;
};

Archive& opened() {
  static Archive archive;
  return archive;
}

std::uint32_t u16(const std::vector<std::uint8_t>& b, std::size_t at) {
  return static_cast<std::uint32_t>(b[at] | b[at + 1] << 8);
}
std::uint32_t u32(const std::vector<std::uint8_t>& b, std::size_t at) {
  return u16(b, at) | u16(b, at + 2) << 16;
}

Result<std::vector<std::uint8_t>> bytes_at(const std::filesystem::path& path, std::uint64_t at,
                                           std::size_t n) {
  auto file = open_file(path, at);
  if (!file) return file.error();
  std::vector<std::uint8_t> bytes(n);
  if (Status status = read_exactly(*file->source, bytes.data(), n); !status) return status.error();
  return bytes;
}

// At most so many bytes of another source.
class Limited final : public ByteSource {
 public:
  Limited(std::unique_ptr<ByteSource> source, std::uint64_t most)
      : source_(std::move(source)), left_(most) {}
  Result<std::size_t> read(void* to, std::size_t n) override {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(n, left_));
    if (part == 0) return std::size_t{0};
    auto got = source_->read(to, part);
    if (got) left_ -= *got;
    return got;
  }

 private:
  std::unique_ptr<ByteSource> source_;
  std::uint64_t left_;
};

Result<std::unique_ptr<ByteSource>> bytes_of(const Archive& archive, const Entry& entry) {
  constexpr std::size_t kLocal = 30;
  const auto head = bytes_at(archive.path, entry.at, kLocal);
  if (!head || u32(*head, 0) != 0x04034B50) return error("damaged");
  auto file = open_file(archive.path, entry.at + kLocal + u16(*head, 26) + u16(*head, 28));
  if (!file) return file.error();
  std::unique_ptr<ByteSource> source =
      std::make_unique<Limited>(std::move(file->source), entry.packed);
  if (entry.deflated) source = inflate_raw(std::move(source));
  source = std::make_unique<Limited>(std::move(source), entry.size);
  return source;
}

// Damaged bytes often unpack without complaint; only the checksum shows it.
bool whole(const Archive& archive, const Entry& entry) {
  auto source = bytes_of(archive, entry);
  if (!source) return false;
  std::vector<std::uint8_t> block(std::size_t{1} << 16);
  std::uint64_t length = 0;
  unsigned long crc = ::crc32(0, nullptr, 0);
  while (true) {
    auto got = (*source)->read(block.data(), block.size());
    if (!got) return false;
    if (*got == 0) break;
    crc = ::crc32(crc, block.data(), static_cast<unsigned>(*got));
    length += *got;
  }
  return crc == entry.crc && length == entry.size;
}

std::optional<Result<OpenFile>> open_inside(const std::filesystem::path& path,
                                            std::uint64_t offset) {
  Archive& archive = opened();
  const auto found = archive.entries.find(path.string());
  if (found == archive.entries.end()) return std::nullopt;
  Entry& entry = found->second;
  const auto damaged = [&] {
    return error(fmt::format("{}: is damaged inside its zip archive; copy the archive again",
                             short_name(path)));
  };
  if (!entry.checked) {  // while headers are read, by one thread
    if (!whole(archive, entry)) return damaged();
    entry.checked = true;
  }
  auto bytes = bytes_of(archive, entry);
  if (!bytes) return damaged();
  std::unique_ptr<ByteSource> source = std::move(*bytes);
  if (Status status = skip(*source, std::min(offset, entry.size)); !status) return damaged();
  return OpenFile{std::move(source), entry.size};
}

// A name as it stands in the table: Windows writes backslashes, and old programs the letters of DOS or
// Japan.
std::string name_in(std::string_view stored) {
  const bool windows = stored.find('\\') != std::string_view::npos;
  std::string name = windows ? with_slashes(std::string(stored)) : std::string(stored);
  if (windows) name.erase(0, std::min(name.find_first_not_of('/'), name.size()));
  return utf8_of_name(name);
}

// A name inside the archive: parts that are names, and no way out of it.
bool plain(const std::string& name) {
  if (name.empty() || name.front() == '/' || name.find('\0') != std::string::npos) return false;
  const std::filesystem::path path(name);
  return std::none_of(path.begin(), path.end(),
                      [](const std::filesystem::path& part) { return part == ".."; });
}

}  // namespace

bool is_zip(const std::vector<std::uint8_t>& head) {
  return head.size() >= 4 && head[0] == 'P' && head[1] == 'K' &&
         ((head[2] == 3 && head[3] == 4) || (head[2] == 5 && head[3] == 6));
}

Status open_archive(const std::filesystem::path& path) {
  const std::string file = short_name(path);
  const auto refuse = [&](const std::string& why) {
    return error(fmt::format("{}: {}; unpack it and give burr the folder", file, why));
  };
  opened() = {};
  set_files_inside(&open_inside);
  auto whole = open_file(path);
  if (!whole) return whole.error();
  const std::uint64_t size = whole->size;
  // the end of the table: 22 bytes and a comment
  constexpr std::uint64_t kEnd = 22;
  const auto cut = [&] {
    return error(
        fmt::format("{}: is a zip archive that is cut off or damaged; copy it again", file));
  };
  if (size < kEnd) return cut();
  const std::uint64_t from = size - std::min<std::uint64_t>(size, kEnd + 65535);
  const auto tail = bytes_at(path, from, static_cast<std::size_t>(size - from));
  if (!tail) return tail.error();
  std::size_t at = tail->size() - kEnd;
  while (u32(*tail, at) != 0x06054B50) {
    if (at == 0) return cut();
    --at;
  }
  const std::uint64_t count = u16(*tail, at + 10), length = u32(*tail, at + 12),
                      table_at = u32(*tail, at + 16);
  if (count == 0xFFFF || length == 0xFFFFFFFF || table_at == 0xFFFFFFFF)
    return refuse("is a zip archive of more than 4 GB or 65 000 files (zip64)");
  if (table_at > size || length > size - table_at) return cut();
  const auto table = bytes_at(path, table_at, static_cast<std::size_t>(length));
  if (!table) return table.error();
  Archive archive{path, {}};
  constexpr std::size_t kHead = 46;
  for (std::size_t p = 0; p + kHead <= table->size() && u32(*table, p) == 0x02014B50;) {
    const std::size_t name_length = u16(*table, p + 28);
    const std::size_t next = p + kHead + name_length + u16(*table, p + 30) + u16(*table, p + 32);
    if (p + kHead + name_length > table->size()) return cut();
    const std::string name =
        name_in({reinterpret_cast<const char*>(table->data()) + p + kHead, name_length});
    const std::uint32_t flags = u16(*table, p + 8), method = u16(*table, p + 10);
    const Entry entry{u32(*table, p + 42), u32(*table, p + 20), u32(*table, p + 24),
                      method == 8,         u32(*table, p + 16), false};
    p = next;
    if (name.ends_with('/') || !plain(name)) continue;
    if ((flags & 1) != 0) return refuse("is an encrypted zip archive");
    if (method != 0 && method != 8) return refuse("is a zip archive packed in an unusual way");
    const bool possible = entry.at < size && entry.packed <= size &&
                          entry.size <= (entry.deflated ? entry.packed * kMostGzip : entry.packed);
    if (!possible) return cut();
    archive.entries[(path / name).string()] = entry;
    if (archive.entries.size() > kMostEntries) return refuse("is a zip archive of too many files");
  }
  if (archive.entries.empty()) return refuse("is a zip archive without a file");
  opened() = std::move(archive);
  return fine();
}

std::optional<std::vector<std::filesystem::path>> files_in_archive(
    const std::filesystem::path& archive) {
  if (opened().entries.empty() || opened().path != archive) return std::nullopt;
  std::vector<std::filesystem::path> all;
  for (const auto& [name, entry] : opened().entries) all.emplace_back(name);
  return all;
}

std::optional<std::vector<std::filesystem::path>> archive_around(
    const std::filesystem::path& path) {
  for (auto at = path.parent_path(); !at.empty(); at = at.parent_path()) {
    if (auto files = files_in_archive(at)) return files;
    if (at == at.parent_path()) break;
  }
  return std::nullopt;
}

}  // namespace burr::io
