#include "burr/io/read/dicomdir.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using Tag = std::uint32_t;
constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr Tag kItem = 0xFFFEE000, kItemEnd = 0xFFFEE00D, kSequenceEnd = 0xFFFEE0DD;
constexpr Tag kFirstRecord = 0x00041200, kRecords = 0x00041220, kNext = 0x00041400,
              kInUse = 0x00041410, kLower = 0x00041420, kType = 0x00041430, kFile = 0x00041500,
              kInstance = 0x00041511, kSeries = 0x0020000E;
constexpr std::size_t kMostRecords = 200000;
constexpr int kDeepest = 16;  // nesting of sequences, and of records

struct Element {
  Tag tag = 0;
  std::size_t at = 0, length = 0;  // of its value
  bool open = false;               // of undefined length
};

struct Record {
  std::string type, series, instance;
  std::filesystem::path file;
  std::uint32_t next = 0, lower = 0;
  bool in_use = true;
};

class Index {
 public:
  explicit Index(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  std::vector<Listed> pictures() {
    std::size_t at = 132;
    Element element;
    while (take(at, bytes_.size(), element)) {
      if (element.tag == kFirstRecord) first_ = number(element);
      if (element.tag == kRecords) {
        take_records(element);
        break;
      }
      at = end_of(element, bytes_.size(), 0);
    }
    visit(first_, "", 0);
    // an index whose offsets lead nowhere: its records follow each other
    if (out_.empty()) {
      std::string series;
      for (const auto& [offset, record] : records_) add(record, series);
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::uint32_t u16(std::size_t at) const {
    return std::uint32_t{bytes_[at]} | std::uint32_t{bytes_[at + 1]} << 8;
  }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return u16(at) | u16(at + 2) << 16; }

  // The element at this place. False: there is none that fits.
  bool take(std::size_t at, std::size_t end, Element& out) const {
    if (end > bytes_.size() || at + 8 > end) return false;
    out.tag = u16(at) << 16 | u16(at + 2);
    std::uint32_t length = u32(at + 4);
    std::size_t head = 8;
    const bool typed = bytes_[at + 4] >= 'A' && bytes_[at + 4] <= 'Z' && bytes_[at + 5] >= 'A' &&
                       bytes_[at + 5] <= 'Z';
    if (out.tag >> 16 != 0xFFFE && typed) {
      const std::string_view vr(reinterpret_cast<const char*>(&bytes_[at + 4]), 2);
      static constexpr std::string_view kLong[] = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                   "SV", "UC", "UN", "UR", "UT", "UV"};
      if (std::find(std::begin(kLong), std::end(kLong), vr) != std::end(kLong)) {
        if (at + 12 > end) return false;
        length = u32(at + 8);
        head = 12;
      } else {
        length = u16(at + 6);
      }
    }
    out.at = at + head;
    out.open = length == kUndefined;
    out.length = out.open ? end - out.at : length;
    return out.length <= end - out.at;
  }

  // Behind an element, whatever it holds.
  [[nodiscard]] std::size_t end_of(const Element& element, std::size_t end, int depth) const {
    if (!element.open) return element.at + element.length;
    if (depth > kDeepest) return end;
    std::size_t at = element.at;
    Element inside;
    while (take(at, end, inside)) {
      if (inside.tag == kSequenceEnd || inside.tag == kItemEnd) return inside.at;
      at = end_of(inside, end, depth + 1);
    }
    return end;
  }

  [[nodiscard]] std::string text(const Element& element) const {
    constexpr std::size_t kLongest = 1024;
    const char* begin = reinterpret_cast<const char*>(bytes_.data()) + element.at;
    return std::string(trimmed({begin, std::min(element.length, kLongest)}));
  }
  [[nodiscard]] std::uint32_t number(const Element& element) const {
    return element.length == 4 ? u32(element.at) : element.length == 2 ? u16(element.at) : 0;
  }

  void take_records(const Element& sequence) {
    const std::size_t end = sequence.at + sequence.length;
    std::size_t at = sequence.at;
    Element item;
    while (records_.size() < kMostRecords && take(at, end, item) && item.tag == kItem) {
      const std::size_t after = end_of(item, end, 0);
      records_[static_cast<std::uint32_t>(at)] = record_of(item.at, after);
      at = after;
    }
  }

  [[nodiscard]] Record record_of(std::size_t at, std::size_t end) const {
    Record out;
    Element element;
    while (take(at, end, element) && element.tag != kItemEnd) {
      switch (element.tag) {
        case kNext:
          out.next = number(element);
          break;
        case kLower:
          out.lower = number(element);
          break;
        case kInUse:
          out.in_use = number(element) != 0;
          break;
        case kType:
          out.type = text(element);
          break;
        case kSeries:
          out.series = text(element);
          break;
        case kInstance:
          out.instance = text(element);
          break;
        case kFile:
          out.file = path_of(text(element));
          break;
        default:
          break;
      }
      at = end_of(element, end, 0);
    }
    return out;
  }

  // "DICOM\IM0001" as a path below the folder; empty: it is none.
  static std::filesystem::path path_of(std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    std::filesystem::path path = std::filesystem::path(name).lexically_normal();
    const bool leads_out = path.is_absolute() || (!path.empty() && *path.begin() == "..");
    return leads_out || name.find('\0') != std::string::npos ? std::filesystem::path() : path;
  }

  void add(const Record& record, std::string& series) {
    if (record.type == "SERIES") series = record.series;
    const bool picture = record.type == "IMAGE" && record.in_use;
    if (picture && (!record.file.empty() || !record.instance.empty()))
      out_.push_back({series, record.instance, record.file});
  }

  // Records beside each other are a list, and those below one are a list of their own.
  void visit(std::uint32_t offset, const std::string& above, int depth) {
    if (depth > kDeepest) return;
    while (offset != 0) {
      const auto found = records_.find(offset);
      if (found == records_.end() || !seen_.emplace(offset, true).second) return;
      std::string series = above;
      add(found->second, series);
      visit(found->second.lower, series, depth + 1);
      offset = found->second.next;
    }
  }

  const std::vector<std::uint8_t>& bytes_;
  std::uint32_t first_ = 0;
  std::map<std::uint32_t, Record> records_;  // by where each begins in the file
  std::map<std::uint32_t, bool> seen_;
  std::vector<Listed> out_;
};

}  // namespace

std::vector<Listed> listed_in(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < 140 || std::memcmp(bytes.data() + 128, "DICM", 4) != 0) return {};
  return Index(bytes).pictures();
}

std::vector<Listed> read_dicomdir(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  const auto bytes = first_bytes(path, kMostBytes);
  return bytes ? listed_in(*bytes) : std::vector<Listed>();
}

}  // namespace burr::io
