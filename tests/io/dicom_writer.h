// tests/io/dicom_writer.h - small DICOM files for tests: explicit little endian, 16-bit pixels.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>

namespace burr::test {

// One slice of 4 x 4 pixels. Every element can be changed or erased.
class DicomSlice {
 public:
  using Elements = std::map<std::uint32_t, std::pair<std::string, std::string>>;
  Elements elements = {{0x00080008, {"CS", "ORIGINAL\\PRIMARY\\AXIAL"}},
                       {0x00080016, {"UI", "1.2.840.10008.5.1.4.1.1.2"}},
                       {0x00080060, {"CS", "CT"}},
                       {0x00180050, {"DS", "1"}},
                       {0x0020000E, {"UI", "1.2.3"}},
                       {0x00200011, {"IS", "4"}},
                       {0x00200037, {"DS", "1\\0\\0\\0\\1\\0"}},
                       {0x00280004, {"CS", "MONOCHROME2"}},
                       {0x00280030, {"DS", "0.5\\0.5"}},
                       {0x00281052, {"DS", "-1000"}},
                       {0x00281053, {"DS", "1"}}};
  int rows = 4, columns = 4, frames = 1, bits_stored = 16;
  std::uint16_t value = 0;  // of every pixel

  DicomSlice& set(std::uint32_t tag, const std::string& vr, const std::string& text) {
    elements[tag] = {vr, text};
    return *this;
  }
  DicomSlice& at(double z, int instance) {
    set(0x00200032, "DS", "0\\0\\" + number(z));
    set(0x00080018, "UI", "1.2.3." + std::to_string(++made()));
    return set(0x00200013, "IS", std::to_string(instance));
  }
  static std::string number(double value) {
    std::string text = std::to_string(value);
    return text.substr(0, 16);
  }
  [[nodiscard]] std::string bytes() const {
    std::string out(128, '\0');
    out += "DICM";
    element(out, 0x00020010, "UI", "1.2.840.10008.1.2.1");
    Elements all = elements;
    const auto us = [&](std::uint32_t tag, int v) {
      const auto u = static_cast<unsigned>(v);
      all[tag] = {"US", {static_cast<char>(u & 0xFF), static_cast<char>(u >> 8)}};
    };
    us(0x00280002, 1);
    if (frames > 1) all[0x00280008] = {"IS", std::to_string(frames)};
    us(0x00280010, rows);
    us(0x00280011, columns);
    us(0x00280100, 16);
    us(0x00280101, bits_stored);
    us(0x00280102, bits_stored - 1);
    us(0x00280103, 0);
    for (const auto& [tag, content] : all) element(out, tag, content.first, content.second);
    std::string pixels;
    for (int n = 0; n < rows * columns * frames; ++n) {
      pixels += static_cast<char>(value & 0xFF);
      pixels += static_cast<char>(value >> 8);
    }
    element(out, 0x7FE00010, "OW", pixels);
    return out;
  }
  void write(const std::string& path) const { std::ofstream(path, std::ios::binary) << bytes(); }

 private:
  static int& made() {
    static int count = 0;
    return count;
  }
  static void put16(std::string& out, std::size_t v) {
    out += static_cast<char>(v & 0xFF);
    out += static_cast<char>(v >> 8 & 0xFF);
  }
  static void element(std::string& out, std::uint32_t tag, const std::string& vr,
                      std::string text) {
    if (text.size() % 2 != 0) text += vr == "UI" ? '\0' : ' ';
    put16(out, tag >> 16);
    put16(out, tag & 0xFFFF);
    out += vr;
    if (vr == "OW" || vr == "SQ" || vr == "UN") {
      put16(out, 0);
      put16(out, text.size() & 0xFFFF);
      put16(out, text.size() >> 16);
    } else {
      put16(out, text.size());
    }
    out += text;
  }
};

}  // namespace burr::test
