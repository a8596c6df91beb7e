#include "burr/io/read/dicom_elements.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr Tag kItem = 0xFFFEE000, kItemEnd = 0xFFFEE00D, kSequenceEnd = 0xFFFEE0DD;
constexpr Tag kPixelData = 0x7FE00010, kShared = 0x52009229, kPerFrame = 0x52009230;
constexpr Tag kSegments = 0x00620002, kSegmentType = 0x0062000F, kSpectral = 0x00189364;
constexpr int kDeepest = 24;  // nesting of sequences

constexpr Tag kWanted[] = {
    0x00020010, 0x00080005, 0x00080008, 0x00080016, 0x00080018, 0x00080020, 0x00080032, 0x00080033,
    0x00080060, 0x00080100, 0x00080102, 0x00080104, 0x00080119, 0x0008103E, 0x00082111, 0x00089007,
    0x00180050, 0x00180060, 0x00180081, 0x00180088, 0x00181060, 0x00181114, 0x00181164, 0x00181210,
    0x00182005, 0x00182010, 0x00189074, 0x00189082, 0x0018937C, 0x0020000D, 0x0020000E, 0x00200011,
    0x00200012, 0x00200013, 0x00200032, 0x00200037, 0x00200052, 0x00200100, 0x00201002, 0x00201041,
    0x00201209, 0x00204000, 0x00209056, 0x00209128, 0x00209153, 0x00209156, 0x00209157, 0x00209161,
    0x00209162, 0x00209163, 0x00209241, 0x00280002, 0x00280004, 0x00280008, 0x00280010, 0x00280011,
    0x00280030, 0x00280100, 0x00280101, 0x00280102, 0x00280103, 0x00280120, 0x00280121, 0x00281052,
    0x00281053, 0x00281054, 0x00620001, 0x00620004, 0x00620005, 0x0062000B, 0x0062000D, 0x0062000E,
    0x20500020, 0x3004000C};

bool wanted(Tag tag) { return std::binary_search(std::begin(kWanted), std::end(kWanted), tag); }

// Patient, General Study, Patient Study, Frame of Reference; of these the elements that are no
// sequences.
constexpr Tag kOfStudy[] = {0x00080005, 0x00080020, 0x00080030, 0x00080050, 0x00080090, 0x00081030,
                            0x00100010, 0x00100020, 0x00100021, 0x00100030, 0x00100032, 0x00100040,
                            0x00101000, 0x00101001, 0x00101010, 0x00101020, 0x00101030, 0x00102160,
                            0x00120062, 0x00120063, 0x0020000D, 0x00200010, 0x00200052, 0x00201040};

bool of_study(Tag tag) { return std::binary_search(std::begin(kOfStudy), std::end(kOfStudy), tag); }

// Of a structure set, PS3.3 C.8.8.5, C.8.8.6 and C.8.8.8: its sequences (referenced frame of reference, study and series;
// the structures, their contours, what they are and its code), and the values in their items.
constexpr Tag kStructureSequences[] = {0x30060010, 0x30060012, 0x30060014, 0x30060020,
                                       0x30060039, 0x30060040, 0x30060080, 0x30060086};
constexpr Tag kContourData = 0x30060050;
constexpr Tag kOfStructures[] = {0x30060022, 0x30060024,   0x30060026, 0x3006002A, 0x30060042,
                                 0x30060044, kContourData, 0x30060084, 0x300600A4};

bool structure_sequence(Tag tag) {
  return std::binary_search(std::begin(kStructureSequences), std::end(kStructureSequences), tag);
}
bool of_structures(Tag tag) {
  return std::binary_search(std::begin(kOfStructures), std::end(kOfStructures), tag);
}
// The longest value that is kept: a contour may have many points.
std::uint64_t longest(Tag tag) {
  constexpr std::uint64_t kMost = 65536, kMostOfContour = std::uint64_t{1} << 28;
  return tag == kContourData ? kMostOfContour : kMost;
}

// Sequences inside a functional group whose values are not those of the frame: private ones, and
// references to other pictures.
bool of_others(Tag tag) { return (tag >> 16) % 2 == 1 || (tag >> 16) == 8; }

}  // namespace

std::span<const Tag> dicom_tags_of_study() { return kOfStudy; }

// Elements that are wanted as values, and so are no sequences.
bool DicomWalker::is_value(Tag tag) const {
  return wanted(tag) || (structure_set && of_structures(tag));
}

std::uint64_t DicomWalker::walk(std::uint64_t at, std::uint64_t end, int depth, Values* into,
                                bool only_meta) {
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
    const bool groups = depth > 0
                            ? into != nullptr
                            : tag == kShared || tag == kPerFrame || tag == kSegments ||
                                  tag == kSpectral || (structure_set && structure_sequence(tag));
    if (!meta_part && !explicit_vr) {
      length = u32(at + 4);
      sequence = length == kUndefined && (tag != kPixelData || depth > 0);
      sequence = sequence || (groups && !is_value(tag) && begins_with_item(at + head, length));
      if (cut) return at;
    } else {
      const std::string vr(reinterpret_cast<const char*>(&bytes_[at + 4]), 2);
      static const char* const kLong[] = {"OB", "OW", "OF", "OD", "OL", "OV", "SQ",
                                          "UC", "UN", "UR", "UT", "SV", "UV"};
      if (std::any_of(std::begin(kLong), std::end(kLong), [&](const char* v) { return vr == v; })) {
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
                         (groups && !is_value(tag) && begins_with_item(at + head, length)));
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
    const bool taken = is_value(tag) || (study && depth == 0 && of_study(tag));
    if (into != nullptr && taken && length <= longest(tag)) {
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

std::uint64_t DicomWalker::fail(std::string why) {
  if (trouble.empty()) trouble = std::move(why);
  return total_;
}

// A value of this length that begins as the items of a sequence do. Sets `cut` where the bytes to
// tell it are not there yet.
bool DicomWalker::begins_with_item(std::uint64_t at, std::uint64_t length) {
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
bool DicomWalker::explicit_inside(std::uint64_t at) const {
  if (at + 14 > bytes_.size()) return false;
  const std::string_view vr(reinterpret_cast<const char*>(&bytes_[at + 12]), 2);
  static constexpr std::string_view kTypes[] = {
      "AE", "AS", "AT", "CS", "DA", "DS", "DT", "FD", "FL", "IS", "LO", "LT", "OB",
      "OW", "PN", "SH", "SL", "SQ", "SS", "ST", "TM", "UI", "UL", "UN", "US", "UT"};
  return std::find(std::begin(kTypes), std::end(kTypes), vr) != std::end(kTypes);
}

std::uint64_t DicomWalker::items(Tag sequence, std::uint64_t at, std::uint64_t end,
                                 std::uint64_t length, int depth) {
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
    if (depth == 0 && sequence == kSpectral) into = &spectral;
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
    const int item_before = item_;
    if (structure_set && structure_sequence(sequence)) {
      structure_items.push_back({sequence, item_, {}});
      item_ = static_cast<int>(structure_items.size()) - 1;
      into = &structure_items.back().values;
    }
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
    item_ = item_before;
  }
  return open_end ? at : end;
}

std::string dicom_text(const Values& values, Tag tag) {
  const auto found = values.find(tag);
  return found == values.end() ? std::string() : std::string(trimmed(found->second));
}

}  // namespace burr::io
