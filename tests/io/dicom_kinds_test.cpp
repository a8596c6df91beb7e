// DICOM of less usual kinds: pictures computed for several energies, packings that few programs know, pictures of
// flat detectors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <set>

#include "burr/io/read/read_scan.h"
#include "io/dicom_writer.h"
#include "io/folder_of_test.h"
#include "io/high_throughput.h"
#include "io/picture_writer.h"
#include "io/seg_writer.h"

namespace burr::io {
namespace {

using test::DicomSlice;
using test::SegFile;

Result<Scan> read(const std::filesystem::path& path, const std::string& series = "") {
  ReadOptions options;
  options.series = series;
  NoProgress progress;
  return read_scan(path, options, progress);
}
std::string all_of(const Scan& scan) {
  std::string text;
  for (const std::string& n : scan.notices) text += n + "\n";
  for (const Question& q : scan.questions) text += "? " + q.text + "\n";
  return text;
}
bool says(const Scan& scan, const std::string& words) {
  return all_of(scan).find(words) != std::string::npos;
}

std::string real64(double value) {
  std::string out(8, '\0');
  std::memcpy(out.data(), &value, 8);
  return out;
}

class DicomKinds : public test::FolderTest {
 protected:
  // Volumes of five slices, one for each energy; the stored value is ten times the energy.
  void energies(const std::set<int>& all,
                const std::function<void(DicomSlice&, int kev)>& state) const {
    int instance = 0;
    for (const int kev : all)
      for (int k = 0; k < 5; ++k) {
        DicomSlice slice;
        slice.at(k, ++instance);
        slice.value = static_cast<std::uint16_t>(1000 + 10 * kev);
        state(slice, kev);
        slice.write(path(std::to_string(kev) + "_" + std::to_string(k) + ".dcm"));
      }
  }
  void expect_energy(const std::string& series, int kev) const {
    const auto scan = read(folder, series);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_EQ(scan->size.z(), 5) << all_of(*scan);
    for (const float v : scan->values) ASSERT_EQ(v, static_cast<float>(10 * kev)) << all_of(*scan);
  }
};

const std::set<int> kEnergies = {40, 55, 70, 100, 140};

TEST_F(DicomKinds, OfASpectralSeries70KevIsTakenAndOthersByName) {
  struct Way {
    const char* name;
    std::function<void(DicomSlice&, int kev)> state;
  };
  const auto description = [](DicomSlice& s, int kev) {
    s.set(0x0008103E, "LO", "MonoE " + std::to_string(kev) + "keV[HU]");
    s.set(0x0020000E, "UI", "1.2.3." + std::to_string(kev));
  };
  const Way ways[] = {
      {"Monoenergetic Energy Equivalent",
       [](DicomSlice& s, int kev) {
         const std::string item = SegFile::element(0x0018937C, "FD", real64(kev));
         s.set(0x00189364, "SQ",
               "\xFE\xFF" + std::string("\x00\xE0", 2) + test::number_bytes(item.size(), 4) + item);
       }},
      {"Image Comments",
       [](DicomSlice& s, int kev) {
         s.set(0x00204000, "LT", "VMI, " + std::to_string(kev) + " keV");
       }},
      {"Series Description", description}};
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    energies(kEnergies, way.state);
    const auto scan = read(folder);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_EQ(scan->series.size(), 5U) << all_of(*scan);
    EXPECT_TRUE(says(*scan, "computed for 40, 55, 70, 100 and 140 keV: 70 keV was taken"))
        << all_of(*scan);
    expect_energy("", 70);
    expect_energy("140 keV", 140);
    expect_energy("55kev", 55);
    const auto none = read(folder, "60 keV");
    ASSERT_FALSE(none.ok());
    EXPECT_NE(none.error().text.find("no volume is of 60 keV"), std::string::npos);
  }
}

TEST_F(DicomKinds, WithoutSeventyTheNearestIsTakenAndOneAloneNeedsNoWord) {
  const auto comment = [](DicomSlice& s, int kev) {
    s.set(0x00204000, "LT", std::to_string(kev) + " keV");
  };
  energies({50, 65, 110}, comment);
  expect_energy("", 65);
  for (const char* kev : {"50", "110"})
    for (int k = 0; k < 5; ++k)
      std::filesystem::remove(path(std::string(kev) + "_" + std::to_string(k) + ".dcm"));
  const auto scan = read(folder);
  ASSERT_TRUE(scan.ok());
  EXPECT_FALSE(says(*scan, "computed for")) << all_of(*scan);
}

// ---- packings

// An MR, whose values are never taken for HU.
std::string packed_slice(const std::string& syntax, const std::string& code, int bits,
                         bool is_signed, int k) {
  const auto element = &SegFile::element;
  std::string out = std::string(128, '\0') + "DICM" + element(0x00020010, "UI", syntax);
  out += element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.4") +
         element(0x00080018, "UI", "1.2.9." + std::to_string(k)) + element(0x00080060, "CS", "MR") +
         element(0x0020000E, "UI", "1.2.3") + element(0x00200013, "IS", std::to_string(k)) +
         element(0x00200032, "DS", "0\\0\\" + std::to_string(k)) +
         element(0x00200037, "DS", "1\\0\\0\\0\\1\\0") + SegFile::us(0x00280002, 1) +
         element(0x00280004, "CS", "MONOCHROME2") + SegFile::us(0x00280010, 16) +
         SegFile::us(0x00280011, 16) + element(0x00280030, "DS", "0.5\\0.5") +
         SegFile::us(0x00280100, 16) + SegFile::us(0x00280101, bits) +
         SegFile::us(0x00280102, bits - 1) + SegFile::us(0x00280103, is_signed ? 1 : 0);
  const auto item = [](const std::string& bytes) {
    return std::string("\xFE\xFF\x00\xE0", 4) + test::number_bytes(bytes.size(), 4) + bytes;
  };
  out += std::string("\xE0\x7F\x10\x00OB\0\0\xFF\xFF\xFF\xFF", 12) + item("") +
         item(code + std::string(code.size() % 2, '\0')) +
         std::string("\xFE\xFF\xDD\xE0\0\0\0\0", 8);
  return out;
}

TEST_F(DicomKinds, HighThroughputJpeg2000IsRead) {
  for (const bool is_signed : {false, true}) {
    const std::string code =
        is_signed ? std::string(reinterpret_cast<const char*>(test::kHighThroughputSigned),
                                sizeof test::kHighThroughputSigned)
                  : std::string(reinterpret_cast<const char*>(test::kHighThroughput),
                                sizeof test::kHighThroughput);
    for (const char* syntax :
         {"1.2.840.10008.1.2.4.201", "1.2.840.10008.1.2.4.202", "1.2.840.10008.1.2.4.203"}) {
      for (int k = 0; k < 4; ++k)
        test::write_bytes(path(std::to_string(k) + ".dcm"),
                          packed_slice(syntax, code, is_signed ? 16 : 12, is_signed, k));
      const auto scan = read(folder);
      ASSERT_TRUE(scan.ok()) << scan.error().text;
      ASSERT_EQ(scan->size, math::Ijk(16, 16, 4)) << all_of(*scan);
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
          ASSERT_EQ(
              scan->values[static_cast<std::size_t>(16 * y + x)],
              static_cast<float>(is_signed ? 37 * x + 91 * y - 1500 : (37 * x + 91 * y) % 4000))
              << x << " " << y;
    }
    // a damaged one is a sentence
    std::string damaged = code;
    for (std::size_t n = damaged.size() / 2; n < damaged.size(); ++n) damaged[n] ^= 0x5A;
    for (int k = 0; k < 4; ++k)
      test::write_bytes(
          path(std::to_string(k) + ".dcm"),
          packed_slice("1.2.840.10008.1.2.4.201", damaged.substr(0, 60), 12, false, k));
    EXPECT_FALSE(read(folder).ok());
  }
}

TEST_F(DicomKinds, PackingsThatAreNotReadAreCalledByTheirNames) {
  const std::pair<const char*, const char*> names[] = {
      {"1.2.840.10008.1.2.4.110", "stored as JPEG XL, which burr does not read"},
      {"1.2.840.10008.1.2.4.112", "stored as JPEG XL"},
      {"1.2.840.10008.1.2.4.102", "stored as MPEG-4 video"},
      {"1.2.840.10008.1.2.4.94", "a reference to a server that holds them"},
      {"1.3.46.670589.33.1.4.1", "private to Philips"},
      {"1.2.392.200036.9125.1.1", "private to Fujifilm"},
      {"1.9.9.9", "a transfer syntax that burr does not read: 1.9.9.9"}};
  for (const auto& [syntax, words] : names) {
    test::write_bytes(path("a.dcm"), packed_slice(syntax, "\xFF\x0A", 12, false, 1));
    const auto scan = read(path("a.dcm"));
    ASSERT_FALSE(scan.ok()) << syntax;
    EXPECT_NE(scan.error().text.find(words), std::string::npos) << scan.error().text;
    EXPECT_NE(scan.error().text.find(syntax), std::string::npos) << scan.error().text;
    EXPECT_NE(scan.error().text.find("export the scan again"), std::string::npos);
  }
}

// ---- pictures of flat detectors

TEST_F(DicomKinds, ImagerPixelSpacingIsOfferedWhereSpacingIsAsked) {
  for (int k = 0; k < 5; ++k) {
    DicomSlice slice;
    slice.at(k, k + 1);
    slice.value = static_cast<std::uint16_t>(1000 + k);
    slice.elements.erase(0x00280030);
    slice.set(0x00181164, "DS", "0.3\\0.2");
    slice.set(0x00181114, "DS", "1.25");
    slice.write(path(std::to_string(k) + ".dcm"));
  }
  const auto scan = read(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->spacing_mm.x(), 1);  // offered, not taken
  EXPECT_TRUE(says(*scan, "Imager Pixel Spacing, at the detector, is 0.2 x 0.3 mm"))
      << all_of(*scan);
  EXPECT_TRUE(says(*scan, "0.16 x 0.24 mm in the patient (magnification 1.25)")) << all_of(*scan);
}

}  // namespace
}  // namespace burr::io
