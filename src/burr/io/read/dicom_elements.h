// io/read/dicom_elements.h - walks the elements of a DICOM data set (PS3.5) and keeps the values of
// those that burr wants. It trusts no length: everything is checked against the size of the data set.
// Internal to io. Thread: any.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace burr::io {

using Tag = std::uint32_t;                  // group << 16 | element
using Values = std::map<Tag, std::string>;  // raw bytes of the wanted elements

// Patient and study: a walk keeps these elements only if DicomWalker::study is set.
[[nodiscard]] std::span<const Tag> dicom_tags_of_study();

// One item of a sequence of a structure set (RTSTRUCT, PS3.3 A.19).
struct DicomItem {
  Tag sequence = 0;
  int parent = -1;  // the item that it lies in, of DicomWalker::structure_items; -1: none
  Values values;
};

class DicomWalker {
 public:
  // total: size of the data set, of which `bytes` is the beginning
  DicomWalker(const std::vector<std::uint8_t>& bytes, std::uint64_t total)
      : bytes_(bytes), total_(total) {}

  bool explicit_vr = true, big_endian = false;
  bool study = false;                     // what is of the patient and the study is wanted too
  bool structure_set = false;             // what is of a structure set is wanted too
  std::deque<DicomItem> structure_items;  // in the order of the file; stay where they are
  Values top, shared, spectral;           // spectral: Multi-energy CT Characteristics Sequence
  std::vector<Values> frames, segments;
  bool has_pixels = false, float_pixels = false, encapsulated = false, modality_lut = false;
  std::uint64_t pixels_at = 0, pixels_length = 0;
  bool cut = false;     // the data set continues beyond `bytes`
  std::string trouble;  // not empty: the structure is invalid

  // Walks the elements from `at` to `end`; depth 0 is the data set itself. Gives where it stopped.
  std::uint64_t walk(std::uint64_t at, std::uint64_t end, int depth, Values* into, bool only_meta);

  [[nodiscard]] std::uint16_t u16(std::uint64_t at) const {
    const auto a = bytes_[at], b = bytes_[at + 1];
    return static_cast<std::uint16_t>(big_endian ? a << 8 | b : b << 8 | a);
  }
  [[nodiscard]] std::uint32_t u32(std::uint64_t at) const {
    return big_endian ? std::uint32_t{u16(at)} << 16 | u16(at + 2)
                      : std::uint32_t{u16(at + 2)} << 16 | u16(at);
  }

 private:
  std::uint64_t fail(std::string why);
  bool begins_with_item(std::uint64_t at, std::uint64_t length);
  [[nodiscard]] bool explicit_inside(std::uint64_t at) const;
  [[nodiscard]] bool is_value(Tag tag) const;
  std::uint64_t items(Tag sequence, std::uint64_t at, std::uint64_t end, std::uint64_t length,
                      int depth);

  const std::vector<std::uint8_t>& bytes_;
  std::uint64_t total_;
  Values* inside_ = nullptr;
  int item_ = -1;  // of structure_items: the one that is walked
};

// The text of an element without the padding; empty: it is not there.
[[nodiscard]] std::string dicom_text(const Values& values, Tag tag);

}  // namespace burr::io
