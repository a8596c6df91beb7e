// Names as Windows, Macs and Japan write them: of files, in archives, and inside DICOM. The texts of DICOM are
// the examples of the standard (PS3.5, annexes H, I and J, and PS3.3 C.12.1.1.2).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"
#include "io/seg_writer.h"
#include "io/zip_writer.h"

namespace burr::io {
namespace {

using test::write_bytes;

Result<Scan> read(const std::filesystem::path& path) {
  NoProgress progress;
  return read_scan(path, {}, progress);
}
bool says(const Scan& scan, const std::string& words) {
  return std::any_of(scan.notices.begin(), scan.notices.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

// 24 voxels of 16 bits.
std::string voxels() {
  std::string out;
  for (std::uint64_t n = 0; n < 24; ++n) out += test::number_bytes(1000 * n - 1000, 2);
  return out;
}
std::string mhd(const std::string& data) {
  return "ObjectType = Image\r\nNDims = 3\r\nBinaryData = True\r\nElementSpacing = 0.5 0.5 0.5\r\n"
         "DimSize = 4 3 2\r\nElementType = MET_SHORT\r\nElementDataFile = " +
         data + "\r\n";
}
std::string nhdr(const std::string& data) {
  return "NRRD0004\ntype: int16\ndimension: 3\nsizes: 4 3 2\nspacings: 0.5 0.5 0.5\n"
         "endian: little\nencoding: raw\ndata file: " +
         data + "\n";
}

class ForeignNames : public test::FolderTest {
 protected:
  static void expect_read(const Result<Scan>& scan, const std::string& says_so) {
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    ASSERT_EQ(scan->values.size(), 24U);
    EXPECT_EQ(scan->values[23], 22000.0F);
    if (!says_so.empty()) {
      EXPECT_TRUE(says(*scan, says_so)) << (scan->notices.empty() ? "no notice" : scan->notices[0]);
    }
  }
  // The header names its data `stated`; the file beside it is `there`.
  void expect_found(const std::string& stated, const std::string& there,
                    const std::string& says_so) {
    SCOPED_TRACE(stated);
    write_bytes(path(there), voxels());
    write_bytes(path("a.mhd"), mhd(stated));
    write_bytes(path("a.nhdr"), nhdr(stated));
    expect_read(read(path("a.mhd")), says_so);
    expect_read(read(path("a.nhdr")), says_so);
    std::filesystem::remove(path(there));
  }
};

TEST_F(ForeignNames, OfDataFilesAreFoundBesideTheHeaderAndSaid) {
  expect_found("D:\\Scans\\Jaw\\JAW.RAW", "jaw.raw", "in another folder; jaw.raw beside");
  expect_found("/home/me/jaw.raw", "jaw.raw", "in another folder; jaw.raw beside");
  expect_found("JAW.raw", "jaw.RAW", "The header names its data file JAW.raw; jaw.RAW beside");
  expect_found("jaw.raw", "jaw.raw", "");
  // one letter in the header, two in the file, as Macs write them; and the other way round
  expect_found("Z\u00E4hne.raw", "Za\u0308hne.raw", "beside the header was read");
  expect_found("Za\u0308hne.raw", "Z\u00E4hne.raw", "beside the header was read");
  expect_found("\u304C\u304F.raw", "\u304B\u3099\u304F.raw", "beside the header was read");
  expect_found("\uD55C\uAE00.raw", "\u1112\u1161\u11AB\u1100\u1173\u11AF.raw", "beside the header");
  // the header in the letters of Japan's or Germany's Windows, the file in UTF-8
  expect_found("\x83\x5C\x83\x74\x83\x67.raw", "\u30BD\u30D5\u30C8.raw", "beside the header");
  expect_found("D:\\\x95\x5C\\\x83\x5C.raw", "\u30BD.raw", "in another folder");
  expect_found("Z\xE4hne.raw", "Z\u00E4hne.raw", "beside the header was read");
}

TEST_F(ForeignNames, WhatLiesElsewhereIsNotRead) {
  std::filesystem::create_directory(path("inner"));
  write_bytes(path("secret.raw"), voxels());
  for (const char* name : {"../secret.raw", "..\\secret.raw", "/etc/passwd", "inner/../../x"}) {
    write_bytes(path("inner/a.mhd"), mhd(name));
    const auto scan = read(path("inner/a.mhd"));
    ASSERT_FALSE(scan.ok()) << name;
    EXPECT_NE(scan.error().text.find("must be in the same folder"), std::string::npos)
        << scan.error().text;
  }
  // two that differ in their letters only: neither
  write_bytes(path("inner/A.RAW"), voxels());
  write_bytes(path("inner/a.Raw"), voxels());
  write_bytes(path("inner/a.mhd"), mhd("a.raw"));
  EXPECT_FALSE(read(path("inner/a.mhd")).ok());
}

TEST_F(ForeignNames, ArchivesOfWindowsAndJapanAreRead) {
  const std::string japanese =
      "\x83\x5C\x83\x74";  // the second byte of the first letter is a backslash
  write_bytes(path("a.zip"), test::ZipWriter()
                                 .add("Scan\\" + japanese + "\\a.mhd", mhd("A.RAW"))
                                 .add("Scan\\" + japanese + "\\a.raw", voxels())
                                 .bytes());
  expect_read(read(path("a.zip")), "a.raw beside the header");
  write_bytes(path("b.zip"), test::ZipWriter()
                                 .add("Scan\\a.nhdr", nhdr("C:\\x\\a.raw"))
                                 .add("Scan\\a.raw", voxels())
                                 .bytes());
  expect_read(read(path("b.zip")), "in another folder");
  // names that lead out stay refused
  write_bytes(path("c.zip"), test::ZipWriter().add("..\\..\\a.mhd", mhd("LOCAL")).bytes());
  EXPECT_FALSE(read(path("c.zip")).ok());
}

struct Text {
  const char *characters, *stored, *utf8;
};

class DicomTexts : public test::FolderTest, public testing::WithParamInterface<Text> {};

TEST_P(DicomTexts, AreShownInUtf8) {
  const Text& text = GetParam();
  test::SegFile seg;
  seg.characters = text.characters;
  seg.segments = {{1, text.stored, "SRT", "T-11180", text.stored, ""}};
  seg.frames = {{1, 0}, {1, 1}};
  seg.at = [](int, int i, int, int) { return i > 2 ? 1 : 0; };
  seg.write(path("seg.dcm"));
  const auto scan = read(path("seg.dcm"));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->label_names.size(), 1U);
  EXPECT_EQ(scan->label_names[0].name, text.utf8);
  EXPECT_EQ(scan->label_names[0].meaning, std::string(text.utf8) + " SRT T-11180");
}

INSTANTIATE_TEST_SUITE_P(
    Io, DicomTexts,
    testing::Values(
        // H.3.1: Yamada Tarou, in Roman, Kanji and Hiragana
        Text{"\\ISO 2022 IR 87",
             "Yamada^Tarou=\x1B$B;3ED\x1B(B^\x1B$BB@O:\x1B(B=\x1B$B$d$^$@\x1B(B^"
             "\x1B$B$?$m$&\x1B(B",
             "Yamada^Tarou=\u5C71\u7530^\u592A\u90CE=\u3084\u307E\u3060^\u305F\u308D\u3046"},
        // H.3.2: half-width katakana, and the Roman letters of JIS X 0201
        Text{"ISO 2022 IR 13\\ISO 2022 IR 87",
             "\xD4\xCF\xC0\xDE^\xC0\xDB\xB3=\x1B$B;3ED\x1B(J^\x1B$BB@O:\x1B(J",
             "\uFF94\uFF8F\uFF80\uFF9E^\uFF80\uFF9B\uFF73=\u5C71\u7530^\u592A\u90CE"},
        // I.2: Hong Gildong
        Text{"\\ISO 2022 IR 149", "Hong^Gildong=\x1B$)C\xFB\xF3^\x1B$)C\xD1\xCE\xD4\xD7",
             "Hong^Gildong=\u6D2A^\u5409\u6D1E"},
        // J.3 and J.4: Wang XiaoDong
        Text{"GB18030",
             "Wang^XiaoDong=\xCD\xF5^\xD0\xA1\xB6\xAB=", "Wang^XiaoDong=\u738B^\u5C0F\u4E1C="},
        Text{"ISO_IR 192", "Wang^XiaoDong=\xE7\x8E\x8B", "Wang^XiaoDong=\u738B"},
        // K.2: Zhang XiaoDong
        Text{"\\ISO 2022 IR 58", "Zhang^XiaoDong=\x1B$)A\xD5\xC5^\x1B$)A\xD0\xA1\xB6\xAB",
             "Zhang^XiaoDong=\u5F20^\u5C0F\u4E1C"},
        Text{"ISO_IR 100", "Buc^J\xE9r\xF4me", "Buc^J\u00E9r\u00F4me"},
        Text{"ISO_IR 144", "\xBB\xEE\xDA\x63\x65\xDC\xD1\x79\x70\xD3",
             "\u041B\u044E\u043Ace\u043C\u0431yp\u0433"},
        Text{"ISO_IR 126", "\xC4\xE9\xEF\xED\xF5\xF3\xE9\xEF\xF2",
             "\u0394\u03B9\u03BF\u03BD\u03C5\u03C3\u03B9\u03BF\u03C2"},
        Text{"ISO_IR 109", "\xA6", "\u0124"}, Text{"ISO_IR 166", "\xA1", "\u0E01"},
        Text{"\\ISO 2022 IR 100\\ISO 2022 IR 126", "\x1B-A\xE9 \x1B-F\xE9", "\u00E9 \u03B9"},
        // what other programs write without a word about it
        Text{"", "Kn\xC3\xB6\x63hel", "Kn\u00F6chel"}, Text{"ISO_IR 13", "\x8D\x9C", "\u9AA8"}));

}  // namespace
}  // namespace burr::io
