// DICOM files as in PS3.5 and PS3.10 of the standard: with or without preamble, implicit or
// explicit value representation, little or big endian, deflated.
#include "burr/io/read/dicom_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using Tag = std::uint32_t;  // group << 16 | element
constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr Tag kItem = 0xFFFEE000, kItemEnd = 0xFFFEE00D, kSequenceEnd = 0xFFFEE0DD;
constexpr Tag kPixelData = 0x7FE00010, kShared = 0x52009229, kPerFrame = 0x52009230;
constexpr Tag kSegments = 0x00620002, kSegmentType = 0x0062000F;
constexpr int kDeepest = 24;  // nesting of sequences

using Values = std::map<Tag, std::string>;  // raw bytes of the wanted elements

constexpr Tag kWanted[] = {
    0x00020010, 0x00080005, 0x00080008, 0x00080016, 0x00080018, 0x00080020, 0x00080032, 0x00080033,
    0x00080060, 0x00080100, 0x00080102, 0x00080104, 0x00080119, 0x0008103E, 0x00089007, 0x00180050,
    0x00180060, 0x00180081, 0x00180088, 0x00181060, 0x00181210, 0x00182005, 0x00189074, 0x00189082,
    0x0020000D, 0x0020000E, 0x00200011, 0x00200012, 0x00200013, 0x00200032, 0x00200037, 0x00200052,
    0x00200100, 0x00201002, 0x00201041, 0x00201209, 0x00209056, 0x00209128, 0x00209153, 0x00209156,
    0x00209157, 0x00209161, 0x00209162, 0x00209163, 0x00209241, 0x00280002, 0x00280004, 0x00280008,
    0x00280010, 0x00280011, 0x00280030, 0x00280100, 0x00280101, 0x00280102, 0x00280103, 0x00280120,
    0x00280121, 0x00281052, 0x00281053, 0x00281054, 0x00620001, 0x00620004, 0x00620005, 0x0062000B,
    0x0062000D, 0x0062000E, 0x20500020, 0x3004000C};

bool wanted(Tag tag) { return std::binary_search(std::begin(kWanted), std::end(kWanted), tag); }

// Patient, General Study, Patient Study, Frame of Reference; of these the elements that are no
// sequences.
constexpr Tag kOfStudy[] = {0x00080005, 0x00080020, 0x00080030, 0x00080050, 0x00080090, 0x00081030,
                            0x00100010, 0x00100020, 0x00100021, 0x00100030, 0x00100032, 0x00100040,
                            0x00101000, 0x00101001, 0x00101010, 0x00101020, 0x00101030, 0x00102160,
                            0x00120062, 0x00120063, 0x0020000D, 0x00200010, 0x00200052, 0x00201040};

bool of_study(Tag tag) { return std::binary_search(std::begin(kOfStudy), std::end(kOfStudy), tag); }

// Sequences inside a functional group whose values are not those of the frame: private ones, and
// references to other pictures.
bool of_others(Tag tag) { return (tag >> 16) % 2 == 1 || (tag >> 16) == 8; }

class Walker {
 public:
  // total: size of the data set, of which `bytes` is the beginning
  Walker(const std::vector<std::uint8_t>& bytes, std::uint64_t total)
      : bytes_(bytes), total_(total) {}

  bool explicit_vr = true, big_endian = false;
  bool study = false;  // what is of the patient and the study is wanted too
  Values top, shared;
  std::vector<Values> frames, segments;
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
      // inside the groups of frames, and these groups themselves
      const bool groups =
          depth > 0 ? into != nullptr : tag == kShared || tag == kPerFrame || tag == kSegments;
      if (!meta_part && !explicit_vr) {
        length = u32(at + 4);
        sequence = length == kUndefined && (tag != kPixelData || depth > 0);
        sequence = sequence || (groups && !wanted(tag) && begins_with_item(at + head, length));
        if (cut) return at;
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
        sequence = vr == "SQ" || (length == kUndefined && (tag != kPixelData || depth > 0));
        const bool unknown =
            vr == "UN" && (length == kUndefined ||
                           (groups && !wanted(tag) && begins_with_item(at + head, length)));
        if (cut) return at;
        if (unknown) {  // implicit inside, PS3.5 6.2.2; some programs write explicit all the same
          const bool before = explicit_vr;
          explicit_vr = explicit_inside(at + head);
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
        if (pixels_at + pixels_length > total_) fail("it is cut off in its pixels");
        return at;
      }
      if (sequence) {
        at = items(tag, at + head, end, length, depth);
        continue;
      }
      if (length == kUndefined || at + head + length > total_)
        return fail(
            fmt::format("element ({:04x},{:04x}) is longer than the file, or the file is "
                        "cut off",
                        tag >> 16, tag & 0xFFFF));
      const bool taken = wanted(tag) || (study && depth == 0 && of_study(tag));
      if (into != nullptr && taken && length <= 65536) {
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

  // A value of this length that begins as the items of a sequence do. Sets `cut` where the bytes to
  // tell it are not there yet.
  bool begins_with_item(std::uint64_t at, std::uint64_t length) {
    if (length < 8 || length == kUndefined) return false;
    if (at + 8 > bytes_.size()) {
      cut = bytes_.size() < total_;
      return false;
    }
    const std::uint64_t item = u32(at + 4);
    return u16(at) == (kItem >> 16) && u16(at + 2) == (kItem & 0xFFFF) &&
           (item == kUndefined || item + 8 <= length);
  }
  // Whether the first element of the first item states its type.
  [[nodiscard]] bool explicit_inside(std::uint64_t at) const {
    if (at + 14 > bytes_.size()) return false;
    const std::string_view vr(reinterpret_cast<const char*>(&bytes_[at + 12]), 2);
    static constexpr std::string_view kTypes[] = {
        "AE", "AS", "AT", "CS", "DA", "DS", "DT", "FD", "FL", "IS", "LO", "LT", "OB",
        "OW", "PN", "SH", "SL", "SQ", "SS", "ST", "TM", "UI", "UL", "UN", "US", "UT"};
    return std::find(std::begin(kTypes), std::end(kTypes), vr) != std::end(kTypes);
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
      if (depth == 0 && sequence == kSegments) {
        segments.emplace_back();
        into = &segments.back();
      }
      if (depth > 0 && !of_others(sequence)) into = inside_;
      // of the codes of a segment only its type: the others say "tissue", or on which side it lies
      if (depth > 0 && into != nullptr && !segments.empty() && into == &segments.back() &&
          sequence != kSegmentType)
        into = nullptr;
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

// The numbers of a DS element. A single comma in a number is a decimal comma: nothing else can be
// meant, because DS separates its numbers by backslashes.
struct Decimals {
  std::vector<double> values;  // empty: none stated, or one of them is no number
  bool comma = false, broken = false;
};

Decimals decimals_of(std::string_view text, std::size_t wanted_count) {
  Decimals out;
  std::string_view rest = trimmed(text);
  while (!rest.empty() && !out.broken) {
    const std::size_t end = std::min(rest.find('\\'), rest.size());
    std::string piece(trimmed(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (piece.empty()) continue;
    const auto commas = std::count(piece.begin(), piece.end(), ',');
    if (commas == 1 && piece.find('.') == std::string::npos) {
      std::replace(piece.begin(), piece.end(), ',', '.');
      out.comma = true;
    }
    double value = 0;
    if (to_number(piece, value)) {
      out.values.push_back(value);
      continue;
    }
    // some programs separate the numbers by blanks or commas
    const std::vector<double> several = numbers(piece);
    out.broken = several.size() != wanted_count || wanted_count < 2 || !out.values.empty();
    if (!out.broken) out.values = several;
  }
  out.broken =
      out.broken || (!out.values.empty() && out.values.size() < wanted_count) ||
      std::any_of(out.values.begin(), out.values.end(), [](double v) { return !std::isfinite(v); });
  if (out.broken) out.values.clear();
  return out;
}

int whole(const Values& values, Tag tag, int otherwise) {
  const std::vector<double> found = decimals_of(text_of(values, tag), 1).values;
  return !found.empty() && std::abs(found[0]) < 1e9 ? static_cast<int>(found[0]) : otherwise;
}

// Reads the facts of one frame, and notes in the header which of them are no numbers.
class Facts {
 public:
  Facts(DicomHeader& header, bool big_endian) : header_(header), big_endian_(big_endian) {}

  void of_frame(const Values& values, DicomFrame& frame) {
    const auto position = decimals(values, 0x00200032, 3, "Image Position (Patient)"),
               orientation = decimals(values, 0x00200037, 6, "Image Orientation (Patient)"),
               spacing = decimals(values, 0x00280030, 2, "Pixel Spacing"),
               thickness = decimals(values, 0x00180050, 1, "Slice Thickness"),
               between = decimals(values, 0x00180088, 1, "Spacing Between Slices"),
               location = decimals(values, 0x00201041, 1, "Slice Location"),
               slope = decimals(values, 0x00281053, 1, "Rescale Slope"),
               intercept = decimals(values, 0x00281052, 1, "Rescale Intercept");
    if (position.size() == 3) {
      frame.position_mm = {position[0], position[1], position[2]};
      frame.has_position = true;
    }
    if (orientation.size() == 6) {
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
    if (spacing.size() == 2 && spacing[0] > 0 && spacing[1] > 0) {
      frame.row_gap_mm = spacing[0];
      frame.column_gap_mm = spacing[1];
      frame.has_spacing = true;
    }
    if (!thickness.empty() && thickness[0] > 0) frame.thickness_mm = thickness[0];
    if (!between.empty() && header_.between_slices_mm == 0)
      header_.between_slices_mm = std::abs(between[0]);
    if (!location.empty()) {
      frame.location_mm = location[0];
      frame.has_location = true;
    }
    // a slope of 0 is meaningless, and then so is the intercept
    if (!slope.empty() && slope[0] != 0) {
      frame.slope = slope[0];
      if (!intercept.empty()) frame.intercept = intercept[0];
      frame.has_rescale = true;
    } else if (slope.empty() && !intercept.empty()) {
      frame.has_lone_intercept = true;
      frame.lone_intercept = intercept[0];
    }
    whole_bits(values, 0x0062000B, 2, frame.segment);
    of_phase(values, frame.phase);
  }

  void of_segment(const Values& values, const std::string& letters, DicomSegment& segment) const {
    whole_bits(values, 0x00620004, 2, segment.number);
    segment.label = utf8_of(text_of(values, 0x00620005), letters);
    segment.code = text_of(values, 0x00080100);
    if (segment.code.empty()) segment.code = text_of(values, 0x00080119);  // a long one
    segment.scheme = text_of(values, 0x00080102);
    segment.meaning = utf8_of(text_of(values, 0x00080104), letters);
    const auto lab = values.find(0x0062000D);
    segment.has_colour = lab != values.end() && lab->second.size() == 6;
    for (std::size_t n = 0; n < 3 && segment.has_colour; ++n)
      segment.lab[n] = static_cast<int>(bits(lab->second, 2 * n, 2));
  }

 private:
  // Letters of ISO 8859-1 as UTF-8, where Specific Character Set says that they are.
  static std::string utf8_of(std::string text, const std::string& letters) {
    if (letters.find("ISO_IR 100") == std::string::npos &&
        letters.find("ISO 2022 IR 100") == std::string::npos)
      return text;
    std::string out;
    for (const char c : text) {
      const auto code = static_cast<unsigned char>(c);
      if (code >= 0x80) out += static_cast<char>(0xC0 | code >> 6);
      out += static_cast<char>(code >= 0x80 ? 0x80 | (code & 0x3F) : code);
    }
    return out;
  }
  std::vector<double> decimals(const Values& values, Tag tag, std::size_t count, const char* name) {
    const auto found = values.find(tag);
    if (found == values.end()) return {};
    Decimals read = decimals_of(found->second, count);
    header_.decimal_commas = header_.decimal_commas || read.comma;
    if (read.broken) {
      std::string& where =
          tag == 0x00281052 || tag == 0x00281053 ? header_.bad_scale : header_.unreadable;
      if (where.empty())
        where = fmt::format("{} \"{}\"", name, base::printable(trimmed(found->second), 40));
    }
    return std::move(read.values);
  }
  // A number that is stored in binary form, of `width` bytes.
  [[nodiscard]] std::uint64_t bits(const std::string& value, std::size_t at,
                                   std::size_t width) const {
    std::uint64_t out = 0;
    for (std::size_t n = 0; n < width; ++n)
      out |= std::uint64_t{static_cast<std::uint8_t>(value[at + n])}
             << 8 * (big_endian_ ? width - 1 - n : n);
    return out;
  }
  void whole_bits(const Values& values, Tag tag, std::size_t width, int& out) const {
    const auto found = values.find(tag);
    if (found != values.end() && found->second.size() == width)
      out =
          static_cast<int>(static_cast<std::uint32_t>(bits(found->second, 0, width)) & 0x7FFFFFFF);
  }
  void real_bits(const Values& values, Tag tag, double& out) const {
    const auto found = values.find(tag);
    if (found == values.end()) return;
    double value = DicomPhase::kUnknown;
    if (found->second.size() == 4)
      value = std::bit_cast<float>(static_cast<std::uint32_t>(bits(found->second, 0, 4)));
    else if (found->second.size() == 8)
      value = std::bit_cast<double>(bits(found->second, 0, 8));
    if (std::isfinite(value)) out = value;
  }
  static void real_text(const Values& values, Tag tag, double& out) {
    const std::vector<double> read = decimals_of(text_of(values, tag), 1).values;
    if (!read.empty()) out = read[0];
  }
  // "hhmmss.ffffff", or the same after "yyyymmdd"; only differences of it mean anything.
  static void time(const Values& values, Tag tag, double& out) {
    const std::string text = text_of(values, tag);
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    double number = 0;
    if (digits < 6 || digits > 14 || !to_number(text.substr(0, digits), number)) return;
    double rest = 0;
    if (digits < text.size() && (text[digits] == '.' || text[digits] == ',')) {
      const std::size_t end =
          std::min(text.find_first_not_of("0123456789", digits + 1), text.size());
      if (!to_number("0." + text.substr(digits + 1, end - digits - 1), rest)) rest = 0;
    }
    const double day = std::floor(number / 1e6), clock = number - day * 1e6;
    const double hours = std::floor(clock / 1e4), minutes = std::floor((clock - hours * 1e4) / 1e2);
    out = day * 86400 + hours * 3600 + minutes * 60 + (clock - hours * 1e4 - minutes * 1e2) + rest;
  }

  void of_phase(const Values& values, DicomPhase& phase) const {
    phase.acquisition = whole(values, 0x00200012, phase.acquisition);
    whole_bits(values, 0x00209156, 2, phase.acquisition);
    phase.temporal = whole(values, 0x00200100, phase.temporal);
    whole_bits(values, 0x00209128, 4, phase.temporal);
    real_bits(values, 0x00209241, phase.cardiac_percent);
    real_text(values, 0x00181060, phase.trigger_ms);
    real_bits(values, 0x00209153, phase.trigger_ms);
    real_text(values, 0x00180060, phase.kvp);
    real_text(values, 0x00180081, phase.echo_ms);
    real_bits(values, 0x00189082, phase.echo_ms);
    for (const Tag tag : {0x00080033U, 0x00080032U, 0x00189074U}) time(values, tag, phase.time_s);
    const std::pair<Tag, std::string*> texts[] = {{0x00181210, &phase.kernel},
                                                  {0x00080008, &phase.type},
                                                  {0x00089007, &phase.type},
                                                  {0x00209056, &phase.stack}};
    for (const auto& [tag, out] : texts)
      if (values.count(tag) != 0) *out = text_of(values, tag);
    const auto index = values.find(0x00209157);
    constexpr std::size_t kMostIndices = 8;
    if (index != values.end() && index->second.size() % 4 == 0 &&
        index->second.size() <= 4 * kMostIndices) {
      phase.index.clear();
      for (std::size_t at = 0; at < index->second.size(); at += 4)
        phase.index.push_back(static_cast<std::uint32_t>(bits(index->second, at, 4)));
    }
  }

  DicomHeader& header_;
  bool big_endian_;
};

// Frames whose places along the stack stand in one list: of a secondary capture, or of a dose grid.
void places_of_frames(const Values& top, DicomHeader& header) {
  for (const Tag tag : {0x00182005U, 0x3004000CU}) {
    const auto found = top.find(tag);
    if (found == top.end()) continue;
    const std::vector<double> places = decimals_of(found->second, header.frames.size()).values;
    if (places.size() != header.frames.size()) continue;
    for (std::size_t f = 0; f < places.size(); ++f) {
      DicomFrame& frame = header.frames[f];
      frame.location_mm = places[f];
      frame.has_location = true;
      if (!frame.has_position || header.own_positions > 0) continue;
      frame.position_mm += frame.row.cross(frame.column) * (places[f] - places[0]);
    }
    if (header.frames.front().has_position) header.own_positions = header.frame_count;
    return;
  }
}

// What only a segmentation states.
void take_segments(const Walker& set, const Facts& facts, DicomHeader& header) {
  header.segmentation_type = text_of(set.top, 0x00620001);
  const std::string letters = text_of(set.top, 0x00080005);
  for (const Values& values : set.segments)
    facts.of_segment(values, letters, header.segments.emplace_back());
  const auto other = [&](const Values& values) {
    const std::string own = text_of(values, 0x00200052);
    return !own.empty() && own != header.frame_of_reference;
  };
  header.other_frame_of_reference =
      other(set.shared) || std::any_of(set.frames.begin(), set.frames.end(), other);
}

// The maker of a private transfer syntax, by the root of its number.
const char* maker_of(const std::string& syntax) {
  constexpr std::pair<const char*, const char*> kMakers[] = {{"1.2.840.113619.", "GE"},
                                                             {"1.3.46.670589.", "Philips"},
                                                             {"1.3.12.2.1107.", "Siemens"},
                                                             {"1.2.392.200036.9116.", "Canon"}};
  for (const auto& [root, name] : kMakers)
    if (syntax.starts_with(root)) return name;
  return nullptr;
}

constexpr const char* kGePrivate = "1.2.840.113619.5.2";  // implicit, with big-endian pixels

// Is there an element with a plausible tag and type here?
bool plausible(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  if (bytes.size() < at + 8) return false;
  const int group = bytes[at] | bytes[at + 1] << 8;
  return group == 2 || group == 8 || group == 0x10;
}

// A date as people write it, "2019-03-07", of "20190307" or the "2019.03.07" of old files; empty: it
// is none.
std::string date_of(std::string text) {
  std::erase(text, '.');
  const bool digits = text.size() == 8 && std::all_of(text.begin(), text.end(),
                                                      [](char c) { return c >= '0' && c <= '9'; });
  if (!digits) return {};
  return text.substr(0, 4) + "-" + text.substr(4, 2) + "-" + text.substr(6, 2);
}

// Copies the facts of a data set into the header.
void take_facts(const Walker& set, DicomHeader& header) {
  const Values& top = set.top;
  header.sop_class = text_of(top, 0x00080016);
  header.sop_instance = text_of(top, 0x00080018);
  header.study = text_of(top, 0x0020000D);
  header.study_date = date_of(text_of(top, 0x00080020));
  header.series = text_of(top, 0x0020000E);
  header.frame_of_reference = text_of(top, 0x00200052);
  header.modality = text_of(top, 0x00080060);
  header.image_type = text_of(top, 0x00080008);
  header.kernel = text_of(top, 0x00181210);
  header.description = text_of(top, 0x0008103E);
  header.photometric = text_of(top, 0x00280004);
  header.rescale_type = text_of(top, 0x00281054);
  header.inverted = header.photometric == "MONOCHROME1" || text_of(top, 0x20500020) == "INVERSE";
  header.images_in_acquisition = std::max(0, whole(top, 0x00201002, 0));
  header.instances_in_series = std::max(0, whole(top, 0x00201209, 0));
  header.described_frames = static_cast<int>(set.frames.size());
  header.concatenation = text_of(top, 0x00209161);
  for (const Values* inside : {&set.shared, set.frames.empty() ? nullptr : &set.frames.front()})
    if (inside != nullptr && header.kernel.empty()) header.kernel = text_of(*inside, 0x00181210);
  header.series_number = whole(top, 0x00200011, 0);
  header.acquisition = whole(top, 0x00200012, 0);
  header.instance = whole(top, 0x00200013, 0);
  header.has_modality_lut = set.modality_lut;
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
  header.frame_count = whole(top, 0x00280008, 1);
  header.part = number(0x00209162, 0);
  header.parts = number(0x00209163, 0);
  header.most_fractional = number(0x0062000E, 0);
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
  header.big_endian = set.big_endian || header.transfer_syntax == kGePrivate;
  header.has_pixels = set.has_pixels;
  header.float_pixels = set.float_pixels;
  header.encapsulated = set.encapsulated;
  header.pixels_at = set.pixels_at;
  header.pixels_length = set.pixels_length;

  if (header.frame_count < 1 || header.frame_count > 100000) {
    if (header.damage.empty())
      header.damage = fmt::format("it states {} frames, not 1 to 100000", header.frame_count);
    header.frame_count = 1;
  }
  Facts facts(header, set.big_endian);
  DicomFrame common;
  facts.of_frame(top, common);
  facts.of_frame(set.shared, common);
  header.frames.assign(static_cast<std::size_t>(header.frame_count), common);
  for (std::size_t f = 0; f < std::min(header.frames.size(), set.frames.size()); ++f) {
    facts.of_frame(set.frames[f], header.frames[f]);
    if (set.frames[f].count(0x00200032) != 0) ++header.own_positions;
  }
  places_of_frames(top, header);
  take_segments(set, facts, header);
}

// Inflates a deflated data set. Error: why it cannot be.
Result<std::vector<std::uint8_t>> inflated(const std::filesystem::path& path, std::uint64_t at,
                                           std::uint64_t total) {
  // within deflate's largest ratio
  auto source = open_file(path, at);
  if (!source) return source.error();
  const std::uint64_t most =
      std::min<std::uint64_t>((total - at) * kMostGzip, std::uint64_t{1} << 30);
  auto inflating = inflate_raw(std::move(source->source));
  std::vector<std::uint8_t> bytes, block(std::size_t{1} << 16);
  while (bytes.size() <= most) {
    auto got = inflating->read(block.data(), block.size());
    if (!got) return error("its compressed data cannot be decompressed");
    if (*got == 0) break;
    bytes.insert(bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  if (bytes.size() < 8) return error("its compressed data is empty");
  return bytes;
}

// Why a file that is none of the formats is refused.
std::string not_read(const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string());
  if (ending == ".raw" || ending == ".zraw")  // people choose it instead of the header beside it
    return fmt::format(
        "{}: holds the numbers of a volume without their size and type; give its header (.nhdr or "
        ".mhd)",
        short_name(path));
  return fmt::format("{}: is not a file that burr reads; give DICOM, NRRD, NIfTI or MetaImage",
                     short_name(path));
}

// study: filled with what the file states of patient and study; nullptr: not read.
Result<DicomHeader> read_header(const std::filesystem::path& path, DicomStudy* study) {
  const std::string file = short_name(path);
  const auto broken = [&](const std::string& why) {
    return error(fmt::format("{}: is a damaged DICOM file ({}); copy it again", file, why));
  };
  // a header seldom needs more than the first block; read more until it fits
  std::size_t part = std::size_t{1} << 16;
  while (true) {
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
      return marked ? broken("it holds nothing behind its mark") : error(not_read(path));

    Walker meta(*bytes, total);
    if ((*bytes)[at] == 2) {
      at = meta.walk(at, total, 0, &meta.top, true);
      if (!meta.trouble.empty()) return broken(meta.trouble);
      header.transfer_syntax = text_of(meta.top, 0x00020010);
    }
    const std::string& syntax = header.transfer_syntax;
    if (!syntax.empty() && !syntax.starts_with("1.2.840.10008.1.2") && syntax != kGePrivate) {
      const char* maker = maker_of(syntax);
      return error(fmt::format(
          "{}: is DICOM of a transfer syntax that burr does not read: {}{}; export the scan again "
          "as Explicit VR Little Endian",
          file, base::printable(syntax),
          maker != nullptr ? fmt::format(", private to {}", maker) : ""));
    }
    if (syntax == "1.2.840.10008.1.2.1.99") {
      auto set = inflated(path, at, total);
      if (!set) return broken(set.error().text);
      *bytes = std::move(*set);
      total = bytes->size();
      at = 0;
      header.deflated = true;
    }

    Walker set(*bytes, total);
    set.big_endian = syntax == "1.2.840.10008.1.2.2";
    set.explicit_vr = syntax != "1.2.840.10008.1.2";
    if (syntax.empty() || !set.explicit_vr || syntax == kGePrivate) {
      // No statement, or the usual wrong one: letters in the place of the type mean explicit.
      if (at + 6 > bytes->size()) return broken("it holds no data");
      const auto letter = [&](std::uint64_t p) { return (*bytes)[p] >= 'A' && (*bytes)[p] <= 'Z'; };
      set.explicit_vr = letter(at + 4) && letter(at + 5);
    }
    set.study = study != nullptr;
    set.walk(at, total, 0, &set.top, false);
    if (set.cut && !whole_file && !header.deflated) {
      part *= 8;
      if (part > (std::size_t{1} << 31)) return broken("its header does not end");
      continue;
    }
    header.damage = set.trouble;
    take_facts(set, header);
    if (study != nullptr) {
      study->characters = text_of(set.top, 0x00080005);
      for (const Tag tag : kOfStudy)
        if (tag != 0x00080005 && set.top.count(tag) != 0)
          study->values[tag] = text_of(set.top, tag);
    }
    return header;
  }
}

}  // namespace

Result<DicomHeader> read_dicom_header(const std::filesystem::path& path) {
  return read_header(path, nullptr);
}

Result<DicomStudy> read_dicom_study(const std::filesystem::path& path) {
  DicomStudy study;
  if (auto header = read_header(path, &study); !header) return header.error();
  return study;
}

}  // namespace burr::io
