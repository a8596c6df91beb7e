#include "burr/io/write/zip.h"

namespace burr::io {
namespace {

constexpr std::size_t kLimit = 0xFFFFFFFFULL;

struct Bytes {
  std::string bytes;
  Bytes& u16(std::size_t value) { return append(value, 2); }
  Bytes& u32(std::size_t value) { return append(value, 4); }
  Bytes& append(std::size_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFFU);
    return *this;
  }
};

}  // namespace

bool Zip::add(const std::string& name, const std::function<bool(Deflate&)>& fill) {
  Entry entry{name, file_.size(), 0, 0, 0};
  write_header(entry, 0x04034b50U);
  file_.write(name);
  const std::size_t start = file_.size();
  Deflate deflate(file_, Deflate::Kind::bare, 6);
  if (!fill(deflate)) return false;
  deflate.finish();
  entry.crc = deflate.crc32();
  entry.packed = file_.size() - start;
  entry.size = deflate.bytes_in();
  // crc and sizes stand before the data but are known only after it
  const std::uint32_t known[3] = {entry.crc, static_cast<std::uint32_t>(entry.packed),
                                  static_cast<std::uint32_t>(entry.size)};
  file_.write_at(entry.offset + 14, known, sizeof known);
  entries_.push_back(entry);
  return true;
}

bool Zip::finish() {
  const std::size_t start = file_.size();
  bool fits = start < kLimit;
  for (const Entry& entry : entries_) {
    fits = fits && entry.size < kLimit && entry.packed < kLimit;
    write_header(entry, 0x02014b50U);
    file_.write(entry.name);
  }
  Bytes end;
  end.u32(0x06054b50U).u16(0).u16(0);
  end.u16(entries_.size()).u16(entries_.size());
  end.u32(file_.size() - start).u32(start).u16(0);
  file_.write(end.bytes.data(), end.bytes.size());
  return fits;
}

// The local and the central header have the middle part in common.
void Zip::write_header(const Entry& entry, std::uint32_t signature) {
  const bool central = signature == 0x02014b50U;
  constexpr std::size_t kVersion = 20, kDeflated = 8, kFirstDay = 0x21;  // 1980-01-01
  Bytes h;
  h.u32(signature);
  if (central) h.u16(kVersion);
  h.u16(kVersion).u16(0).u16(kDeflated).u16(0).u16(kFirstDay);
  h.u32(entry.crc).u32(entry.packed).u32(entry.size).u16(entry.name.size()).u16(0);
  if (central) h.u16(0).u16(0).u16(0).u32(0).u32(entry.offset);
  file_.write(h.bytes.data(), h.bytes.size());
}

}  // namespace burr::io
