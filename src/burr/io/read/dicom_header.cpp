// DICOM files as in PS3.5 and PS3.10 of the standard: with or without preamble, implicit or
// explicit value representation, little or big endian, deflated.
#include "burr/io/read/dicom_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using Tag = std::uint32_t;  // group << 16 | element
constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr Tag kItem = 0xFFFEE000, kItemEnd = 0xFFFEE00D, kSequenceEnd = 0xFFFEE0DD;
constexpr Tag kPixelData = 0x7FE00010, kShared = 0x52009229, kPerFrame = 0x52009230;
constexpr int kDeepest = 24;  // nesting of sequences

using Values = std::map<Tag, std::string>;  // raw bytes of the wanted elements

bool wanted(Tag tag) {
  switch (tag) {
    case 0x00020010:
    case 0x00080008:
    case 0x00080016:
    case 0x00080060:
    case 0x0008103E:
    case 0x00180050:
    case 0x00180088:
    case 0x00181210:
    case 0x0020000E:
    case 0x00200011:
    case 0x00200012:
    case 0x00200013:
    case 0x00200032:
    case 0x00200037:
    case 0x00280002:
    case 0x00280004:
    case 0x00280008:
    case 0x00280010:
    case 0x00280011:
    case 0x00280030:
    case 0x00280100:
    case 0x00280101:
    case 0x00280102:
    case 0x00280103:
    case 0x00280120:
    case 0x00280121:
    case 0x00281052:
    case 0x00281053:
    case 0x00281054:
      return true;
    default:
      return false;
  }
}

class Walker {
 public:
  // total: size of the data set, of which `bytes` is the beginning
  Walker(const std::vector<std::uint8_t>& bytes, std::uint64_t total)
      : bytes_(bytes), total_(total) {}

  bool explicit_vr = true, big_endian = false;
  Values top, shared;
  std::vector<Values> frames;
  bool has_pixels = false, float_pixels = false, encapsulated = false, modality_lut = false;
  std::uint64_t pixels_at = 0, pixels_length = 0;
  bool cut = false;     // the data set continues beyond `bytes`
  std::string trouble;  // not empty: the structure is invalid

  // Walks the elements from `at` to `end`; depth 0 is the data set itself.
  std::uint64_t walk(std::uint64_t at, std::uint64_t end, int depth, Values* into, bool only_meta) {
    if (depth > kDeepest) return fail("its sequences are nested too deeply");
    while (at + 8 <= end && trouble.empty() && !cut) {
      if (at + 12 > bytes_.size()) {
        cut = bytes_.size() < total_;
        if (cut || at + 8 > bytes_.size()) return at;
      }
      const bool meta_part = only_meta;
      const Tag tag = (std::uint32_t{u16(at)} << 16) | u16(at + 2);
      if (only_meta && (tag >> 16) != 2) return at;
      if (tag == kItemEnd || tag == kSequenceEnd) return at + 8;
      std::uint64_t length = 0, head = 8;
      bool sequence = false;
      if (!meta_part && !explicit_vr) {
        length = u32(at + 4);
        sequence = length == kUndefined && tag != kPixelData;
        sequence = sequence || tag == kShared || tag == kPerFrame;
      } else {
        const std::string vr(reinterpret_cast<const char*>(&bytes_[at + 4]), 2);
        static const char* const kLong[] = {"OB", "OW", "OF", "OD", "OL", "OV", "SQ",
                                            "UC", "UN", "UR", "UT", "SV", "UV"};
        if (std::any_of(std::begin(kLong), std::end(kLong),
                        [&](const char* v) { return vr == v; })) {
          if (at + 12 > bytes_.size()) return fail("an element is cut off");
          length = u32(at + 8);
          head = 12;
        } else {
          if (vr[0] < 'A' || vr[0] > 'Z' || vr[1] < 'A' || vr[1] > 'Z')
            return fail("an element has an unknown type");
          length = u16(at + 6);
        }
        sequence = vr == "SQ" || (length == kUndefined && tag != kPixelData);
        if (vr == "UN" && length == kUndefined) {  // implicit inside, PS3.5 6.2.2
          const bool before = explicit_vr;
          explicit_vr = false;
          at = items(tag, at + head, end, length, depth);
          explicit_vr = before;
          continue;
        }
      }
      if (depth == 0 && tag == 0x00283000) modality_lut = true;
      if (depth == 0 && (tag == kPixelData || tag == 0x7FE00008 || tag == 0x7FE00009)) {
        has_pixels = true;
        float_pixels = tag != kPixelData;
        pixels_at = at + head;
        encapsulated = length == kUndefined;
        pixels_length = encapsulated ? total_ - std::min(total_, pixels_at) : length;
        if (pixels_at + pixels_length > total_) fail("the pixel data is cut off");
        return at;
      }
      if (sequence) {
        at = items(tag, at + head, end, length, depth);
        continue;
      }
      if (length == kUndefined || at + head + length > total_)
        return fail(fmt::format("element ({:04x},{:04x}) is longer than the file", tag >> 16,
                                tag & 0xFFFF));
      if (into != nullptr && wanted(tag) && length <= 65536) {
        if (at + head + length > bytes_.size()) {
          cut = true;
          return at;
        }
        // of repeated elements the first counts
        into->emplace(tag, std::string(reinterpret_cast<const char*>(bytes_.data() + at + head),
                                       static_cast<std::size_t>(length)));
      }
      at += head + length;
      if (depth == 0 && at > total_) return fail("an element is cut off");
    }
    return at;
  }

  [[nodiscard]] std::uint16_t u16(std::uint64_t at) const {
    const auto a = bytes_[at], b = bytes_[at + 1];
    return static_cast<std::uint16_t>(big_endian ? a << 8 | b : b << 8 | a);
  }
  [[nodiscard]] std::uint32_t u32(std::uint64_t at) const {
    return big_endian ? std::uint32_t{u16(at)} << 16 | u16(at + 2)
                      : std::uint32_t{u16(at + 2)} << 16 | u16(at);
  }

 private:
  std::uint64_t fail(std::string why) {
    if (trouble.empty()) trouble = std::move(why);
    return total_;
  }

  std::uint64_t items(Tag sequence, std::uint64_t at, std::uint64_t end, std::uint64_t length,
                      int depth) {
    const bool open_end = length == kUndefined;
    if (!open_end) {
      if (at + length > end) return fail("a sequence is longer than the file");
      end = at + length;
    }
    while (at + 8 <= end && trouble.empty() && !cut) {
      if (at + 8 > bytes_.size()) {
        cut = bytes_.size() < total_;
        return cut ? at : fail("a sequence is cut off");
      }
      const Tag tag = (std::uint32_t{u16(at)} << 16) | u16(at + 2);
      const std::uint64_t item = u32(at + 4);
      if (tag == kSequenceEnd) return at + 8;
      if (tag != kItem) return fail("a sequence holds something that is not an item");
      Values* into = nullptr;
      if (depth == 0 && sequence == kShared) into = &shared;
      if (depth == 0 && sequence == kPerFrame) {
        frames.emplace_back();
        into = &frames.back();
      }
      if (depth > 0) into = inside_;
      Values* before = inside_;
      inside_ = into;
      if (item == kUndefined) {
        at = walk(at + 8, end, depth + 1, into, false);
      } else {
        if (at + 8 + item > end) {
          inside_ = before;
          return fail("an item is longer than its sequence");
        }
        // only into wanted sequences; unknown private ones are skipped whole
        if (into != nullptr) walk(at + 8, at + 8 + item, depth + 1, into, false);
        at += 8 + item;
      }
      inside_ = before;
    }
    return open_end ? at : end;
  }

  const std::vector<std::uint8_t>& bytes_;
  std::uint64_t total_;
  Values* inside_ = nullptr;
};

std::string text_of(const Values& values, Tag tag) {
  const auto found = values.find(tag);
  return found == values.end() ? std::string() : std::string(trimmed(found->second));
}

std::vector<double> decimals(const Values& values, Tag tag) {
  std::string text = text_of(values, tag);
  std::replace(text.begin(), text.end(), '\\', ' ');
  return numbers(text);
}

int whole(const Values& values, Tag tag, int otherwise) {
  const std::vector<double> found = decimals(values, tag);
  return !found.empty() && std::isfinite(found[0]) && std::abs(found[0]) < 1e9
             ? static_cast<int>(found[0])
             : otherwise;
}

void frame_facts(const Values& values, DicomFrame& frame) {
  const auto position = decimals(values, 0x00200032), orientation = decimals(values, 0x00200037),
             spacing = decimals(values, 0x00280030), thickness = decimals(values, 0x00180050),
             slope = decimals(values, 0x00281053), intercept = decimals(values, 0x00281052);
  const auto all_finite = [](const std::vector<double>& v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  };
  if (position.size() == 3 && all_finite(position)) {
    frame.position_mm = {position[0], position[1], position[2]};
    frame.has_position = true;
  }
  if (orientation.size() == 6 && all_finite(orientation)) {
    const math::Vec3 row(orientation[0], orientation[1], orientation[2]),
        column(orientation[3], orientation[4], orientation[5]);
    // not of unit length or not perpendicular: ignored
    if (std::abs(row.norm() - 1) < 0.01 && std::abs(column.norm() - 1) < 0.01 &&
        std::abs(row.dot(column)) < 0.01) {
      frame.row = row.normalized();
      frame.column = (column - frame.row * frame.row.dot(column)).normalized();
      frame.has_orientation = true;
    }
  }
  if (spacing.size() == 2 && all_finite(spacing) && spacing[0] > 0 && spacing[1] > 0) {
    frame.row_gap_mm = spacing[0];
    frame.column_gap_mm = spacing[1];
    frame.has_spacing = true;
  }
  if (!thickness.empty() && thickness[0] > 0) frame.thickness_mm = thickness[0];
  // a slope of 0 is meaningless, and then so is the intercept
  if (!slope.empty() && std::isfinite(slope[0]) && slope[0] != 0) {
    frame.slope = slope[0];
    if (!intercept.empty() && std::isfinite(intercept[0])) frame.intercept = intercept[0];
    frame.has_rescale = true;
  }
}

// Is there an element with a plausible tag and type here?
bool plausible(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  if (bytes.size() < at + 8) return false;
  const int group = bytes[at] | bytes[at + 1] << 8;
  return group == 2 || group == 8 || group == 0x10;
}

Error broken(const std::filesystem::path& path, const std::string& why) {
  return error(
      fmt::format("{}: is a damaged DICOM file ({}); copy it again", short_name(path), why));
}

// The data set of a deflated file, which is compressed from `at` on.
Result<std::vector<std::uint8_t>> inflated(const std::filesystem::path& path, std::uint64_t at,
                                           std::uint64_t file_size) {
  auto source = open_file(path, at);
  if (!source) return source.error();
  // all of it, within deflate's largest ratio
  const std::uint64_t most =
      std::min<std::uint64_t>((file_size - at) * kMostGzip, std::uint64_t{1} << 30);
  auto inflating = inflate_raw(std::move(source->source));
  std::vector<std::uint8_t> bytes, block(std::size_t{1} << 16);
  while (bytes.size() <= most) {
    auto got = inflating->read(block.data(), block.size());
    if (!got) return broken(path, "its compressed data cannot be decompressed");
    if (*got == 0) break;
    bytes.insert(bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  if (bytes.size() < 8) return broken(path, "its compressed data is empty");
  return bytes;
}

// Letters in the place of the type mean explicit.
bool looks_explicit(const std::vector<std::uint8_t>& bytes, std::uint64_t at) {
  const auto letter = [&](std::uint64_t p) { return bytes[p] >= 'A' && bytes[p] <= 'Z'; };
  return letter(at + 4) && letter(at + 5);
}

// What the image is and which series it belongs to.
void series_facts(const Values& top, DicomHeader& header) {
  header.sop_class = text_of(top, 0x00080016);
  header.series = text_of(top, 0x0020000E);
  header.modality = text_of(top, 0x00080060);
  header.image_type = text_of(top, 0x00080008);
  header.kernel = text_of(top, 0x00181210);
  header.description = text_of(top, 0x0008103E);
  header.photometric = text_of(top, 0x00280004);
  header.rescale_type = text_of(top, 0x00281054);
  header.series_number = whole(top, 0x00200011, 0);
  header.acquisition = whole(top, 0x00200012, 0);
  header.instance = whole(top, 0x00200013, 0);
  header.frame_count = whole(top, 0x00280008, 1);
  const auto between = decimals(top, 0x00180088);
  if (!between.empty() && std::isfinite(between[0]))
    header.between_slices_mm = std::abs(between[0]);
}

// How the pixels are stored, and where.
void pixel_facts(const Walker& set, DicomHeader& header) {
  const Values& top = set.top;
  const auto number = [&](Tag tag, int otherwise) {
    const auto found = top.find(tag);
    if (found == top.end() || found->second.size() < 2) return otherwise;
    const auto a = static_cast<std::uint8_t>(found->second[0]),
               b = static_cast<std::uint8_t>(found->second[1]);
    return set.big_endian ? a << 8 | b : b << 8 | a;
  };
  header.rows = number(0x00280010, 0);
  header.columns = number(0x00280011, 0);
  header.samples = number(0x00280002, 1);
  header.bits_allocated = number(0x00280100, 0);
  header.bits_stored = number(0x00280101, header.bits_allocated);
  header.high_bit = number(0x00280102, header.bits_stored - 1);
  header.is_signed = number(0x00280103, 0) == 1;
  header.has_padding = top.count(0x00280120) != 0 && top.at(0x00280120).size() >= 2;
  if (header.has_padding) {
    const auto sign = [&](int v) {
      return header.is_signed ? int{static_cast<std::int16_t>(v)} : v;
    };
    header.padding = sign(number(0x00280120, 0));
    header.padding_end = header.padding;
    if (top.count(0x00280121) != 0) {
      header.padding_range = true;
      header.padding_end = sign(number(0x00280121, 0));
      if (header.padding_end < header.padding) std::swap(header.padding, header.padding_end);
    }
  }
  header.has_modality_lut = set.modality_lut;
  header.big_endian = set.big_endian;
  header.has_pixels = set.has_pixels;
  header.float_pixels = set.float_pixels;
  header.encapsulated = set.encapsulated;
  header.pixels_at = set.pixels_at;
  header.pixels_length = set.pixels_length;
}

// Reads the header from the first `part` bytes of the file. Nothing: it is longer than that.
Result<std::optional<DicomHeader>> read_first(const std::filesystem::path& path, std::size_t part) {
  auto bytes = first_bytes(path, part);
  if (!bytes) return bytes.error();
  auto opened = open_file(path);
  if (!opened) return opened.error();
  std::uint64_t total = opened->size;
  const bool whole_file = bytes->size() >= total;

  DicomHeader header;
  header.path = path;
  std::uint64_t at = 0;
  const bool marked = bytes->size() >= 132 && std::memcmp(bytes->data() + 128, "DICM", 4) == 0;
  if (marked) at = 132;
  if (!plausible(*bytes, at))
    return error(
        fmt::format("{}: is not a file that burr reads; give DICOM, NRRD, NIfTI or MetaImage",
                    short_name(path)));

  Walker meta(*bytes, total);
  if ((*bytes)[at] == 2) {
    at = meta.walk(at, total, 0, &meta.top, true);
    if (!meta.trouble.empty()) return broken(path, meta.trouble);
    header.transfer_syntax = text_of(meta.top, 0x00020010);
  }
  if (header.transfer_syntax == "1.2.840.10008.1.2.1.99") {
    auto unpacked = inflated(path, at, total);
    if (!unpacked) return unpacked.error();
    *bytes = std::move(*unpacked);
    total = bytes->size();
    at = 0;
    header.deflated = true;
  }

  Walker set(*bytes, total);
  set.big_endian = header.transfer_syntax == "1.2.840.10008.1.2.2";
  set.explicit_vr = header.transfer_syntax != "1.2.840.10008.1.2";
  if (header.transfer_syntax.empty() || header.transfer_syntax == "1.2.840.10008.1.2") {
    // no statement, or the usual wrong one
    if (at + 6 > bytes->size()) return broken(path, "it holds no data");
    set.explicit_vr = looks_explicit(*bytes, at);
  }
  set.walk(at, total, 0, &set.top, false);
  if (set.cut && !whole_file && !header.deflated) return std::optional<DicomHeader>();
  if (!set.trouble.empty()) return broken(path, set.trouble);

  series_facts(set.top, header);
  pixel_facts(set, header);
  if (header.frame_count < 1 || header.frame_count > 100000)
    return broken(path, fmt::format("it states {} frames, not 1 to 100000", header.frame_count));
  DicomFrame common;
  frame_facts(set.top, common);
  frame_facts(set.shared, common);
  header.frames.assign(static_cast<std::size_t>(header.frame_count), common);
  for (std::size_t f = 0; f < std::min(header.frames.size(), set.frames.size()); ++f)
    frame_facts(set.frames[f], header.frames[f]);
  return std::optional(std::move(header));
}

}  // namespace

Result<DicomHeader> read_dicom_header(const std::filesystem::path& path) {
  // a header seldom needs more than the first block; read more until it fits
  for (std::uint64_t part = std::uint64_t{1} << 16; part <= std::uint64_t{1} << 31; part *= 8) {
    auto header = read_first(path, static_cast<std::size_t>(part));
    if (!header) return header.error();
    if (*header) return std::move(**header);
  }
  return broken(path, "its header does not end");
}

}  // namespace burr::io
