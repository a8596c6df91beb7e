// tests/io/seg_writer.h - DICOM segmentations for tests, written byte by byte from a formula: the
// value at (segment, column, row, slice).
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "io/dicom_writer.h"

namespace burr::test {

class SegFile {
 public:
  struct Segment {
    int number = 1;
    std::string label, scheme, code, meaning;
    std::string lab;  // three numbers of 16 bit, in hexadecimal as in a dump; may be empty
  };
  struct Frame {
    int segment = 0;  // 0: not stated
    int slice = 0;
  };
  std::string sop_class = "1.2.840.10008.5.1.4.1.1.66.4", type = "BINARY",
              syntax = "1.2.840.10008.1.2.1", series = "1.2.7";
  int columns = 13, rows = 11, bits = 1;  // 143 pixels: frames do not begin at a byte
  int most_fractional = 0;
  std::string orientation = "1\\0\\0\\0\\1\\0", spacing = "0.5\\0.4", thickness = "0.6",
              between = "0.6";
  std::vector<Segment> segments;
  std::vector<Frame> frames;
  // where slice k lies
  std::function<std::string(int k)> position = [](int k) {
    return "1\\2\\" + DicomSlice::number(3 + 0.6 * k);
  };
  std::function<int(int segment, int i, int j, int k)> at;
  std::string in_frames;   // more elements of each frame's groups
  std::string characters;  // Specific Character Set
  std::string pixels_cut;  // not empty: the pixels instead
  bool encapsulated = false;

  static std::string element(std::uint32_t tag, const std::string& vr, std::string text) {
    if (text.size() % 2 != 0) text += vr == "UI" || vr == "OB" ? '\0' : ' ';
    std::string out = number16(tag >> 16) + number16(tag & 0xFFFF) + vr;
    if (vr == "OW" || vr == "OB" || vr == "SQ")
      out += number16(0) + number16(text.size() & 0xFFFF) + number16(text.size() >> 16);
    else
      out += number16(text.size());
    return out + text;
  }
  static std::string sequence(std::uint32_t tag, const std::vector<std::string>& items) {
    std::string all;
    for (const std::string& item : items)
      all += number16(0xFFFE) + number16(0xE000) + number16(item.size() & 0xFFFF) +
             number16(item.size() >> 16) + item;
    return element(tag, "SQ", all);
  }
  static std::string number16(std::size_t v) {
    return {static_cast<char>(v & 0xFF), static_cast<char>(v >> 8 & 0xFF)};
  }
  static std::string us(std::uint32_t tag, int v) {
    return element(tag, "US", number16(static_cast<std::size_t>(v)));
  }

  [[nodiscard]] std::string meta() const {
    return std::string(128, '\0') + "DICM" + element(0x00020010, "UI", syntax);
  }
  // bits that run on over the frames, or numbers of 8 or 16 bit
  [[nodiscard]] std::string pixels() const {
    std::string out;
    std::size_t n = 0;
    for (const Frame& frame : frames)
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i, ++n) {
          const int value = at(frame.segment, i, j, frame.slice);
          if (bits == 1) {
            if (n % 8 == 0) out += '\0';
            if (value != 0) out.back() = static_cast<char>(out.back() | 1 << n % 8);
          } else {
            out += static_cast<char>(value & 0xFF);
            if (bits == 16) out += static_cast<char>(value >> 8 & 0xFF);
          }
        }
    return out;
  }
  [[nodiscard]] std::string data_set() const {
    std::string out;
    if (!characters.empty()) out += element(0x00080005, "CS", characters);
    out += element(0x00080016, "UI", sop_class) + element(0x00080060, "CS", "SEG") +
           element(0x0020000E, "UI", series) + element(0x00200052, "UI", "1.2.5") +
           us(0x00280002, 1) + element(0x00280004, "CS", "MONOCHROME2") +
           element(0x00280008, "IS", std::to_string(frames.size())) + us(0x00280010, rows) +
           us(0x00280011, columns) + us(0x00280100, bits) + us(0x00280101, bits) +
           us(0x00280102, bits - 1) + us(0x00280103, 0);
    if (!type.empty()) out += element(0x00620001, "CS", type);
    std::vector<std::string> items;
    for (const Segment& s : segments) items.push_back(item_of(s));
    if (!items.empty()) out += sequence(0x00620002, items);
    if (most_fractional > 0) out += us(0x0062000E, most_fractional);
    std::string measures;
    if (!thickness.empty()) measures += element(0x00180050, "DS", thickness);
    if (!between.empty()) measures += element(0x00180088, "DS", between);
    if (!spacing.empty()) measures += element(0x00280030, "DS", spacing);
    std::string shared;
    if (!orientation.empty())
      shared += sequence(0x00209116, {element(0x00200037, "DS", orientation)});
    shared += sequence(0x00289110, {measures});
    out += sequence(0x52009229, {shared});
    items.clear();
    for (const Frame& f : frames) {
      std::string item;
      const std::string place = position(f.slice);
      if (!place.empty()) item += sequence(0x00209113, {element(0x00200032, "DS", place)});
      item += in_frames;
      if (f.segment > 0) item += sequence(0x0062000A, {us(0x0062000B, f.segment)});
      items.push_back(item);
    }
    out += sequence(0x52009230, items);
    const std::string stored = pixels_cut.empty() ? pixels() : pixels_cut;
    if (encapsulated)
      return out + number16(0x7FE0) + number16(0x0010) + "OB" + number16(0) + number16(0xFFFF) +
             number16(0xFFFF) + stored;
    return out + element(0x7FE00010, bits == 16 ? "OW" : "OB", stored);
  }
  void write(const std::string& path) const {
    std::ofstream(path, std::ios::binary) << meta() + data_set();
  }

 private:
  static std::string item_of(const Segment& s) {
    const auto code = [](const std::string& value, const std::string& scheme,
                         const std::string& meaning) {
      return element(0x00080100, "SH", value) + element(0x00080102, "SH", scheme) +
             element(0x00080104, "LO", meaning);
    };
    // the category of a segment says "tissue" and must not be taken for its type
    std::string out = sequence(0x00620003, {code("85756007", "SCT", "Tissue")}) +
                      us(0x00620004, s.number) + element(0x00620005, "LO", s.label);
    if (!s.lab.empty()) {
      std::string bytes;
      for (std::size_t n = 0; n + 4 <= s.lab.size(); n += 4)
        bytes += number16(std::stoul(s.lab.substr(n, 4), nullptr, 16));
      out += element(0x0062000D, "US", bytes);
    }
    if (!s.code.empty()) out += sequence(0x0062000F, {code(s.code, s.scheme, s.meaning)});
    return out;
  }
};

}  // namespace burr::test
