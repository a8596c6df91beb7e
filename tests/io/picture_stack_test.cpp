// Stacks of pictures against the formula that they were written from, byte by byte (picture_writer.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>

#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"
#include "io/picture_writer.h"
#include "io/zip_writer.h"

namespace burr::io {
namespace {

using test::bmp_bytes;
using test::PictureForm;
using test::png_bytes;
using test::TiffWriter;
using test::write_bytes;

constexpr int kSlices = 12;

// What every stack holds; of 16 bits more than a byte can hold.
std::uint32_t value_at(int i, int j, int k, int bits) {
  const auto n = static_cast<std::uint32_t>(3 * i + 11 * j + 17 * k);
  return bits == 8 ? n % 251 : (257 * n + 40) % 65521;
}

Result<Scan> read(const std::filesystem::path& path, const ReadOptions& options = {}) {
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
bool asks(const Scan& scan, Ask ask, const std::string& words) {
  return std::any_of(scan.questions.begin(), scan.questions.end(), [&](const Question& q) {
    return q.ask == ask && q.text.find(words) != std::string::npos;
  });
}

float voxel(const Scan& scan, int i, int j, int k) {
  const std::size_t n = static_cast<std::size_t>((k * scan.size.y() + j) * scan.size.x() + i);
  return scan.values.empty() ? static_cast<float>(scan.labels[n]) : scan.values[n];
}

class PictureStack : public test::FolderTest {
 protected:
  // One file for each slice, named by its number.
  void write(const std::string& before, const std::string& ending,
             const std::function<std::string(int k)>& bytes) const {
    for (int k = 0; k < kSlices; ++k)
      write_bytes(path(before + std::to_string(k) + ending), bytes(k));
  }
  static test::PixelOf slice(int k, int bits) {
    return [k, bits](int i, int j) { return value_at(i, j, k, bits); };
  }
  static void expect_whole(const Result<Scan>& scan, int bits, int columns = 7, int rows = 5) {
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    ASSERT_EQ(scan->size, math::Ijk(columns, rows, kSlices));
    for (int k = 0; k < kSlices; ++k)
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
          ASSERT_EQ(voxel(*scan, i, j, k), static_cast<float>(value_at(i, j, k, bits)))
              << i << " " << j << " " << k;
    EXPECT_TRUE(says(*scan, "a mirror image")) << all_of(*scan);
  }
  void expect_refused(const std::filesystem::path& where, const std::string& words) const {
    const auto scan = read(where);
    ASSERT_FALSE(scan.ok()) << words;
    EXPECT_NE(scan.error().text.find(words), std::string::npos) << scan.error().text;
  }
};

TEST_F(PictureStack, OfPngIsReadInTheOrderOfItsNumbers) {
  for (const int bits : {8, 16}) {
    const PictureForm form{7, 5, bits, 1};
    write("slice", ".png", [&](int k) { return png_bytes(form, slice(k, bits)); });
    const auto scan = read(folder);
    expect_whole(scan, bits);
    EXPECT_EQ(scan->format, "PNG pictures");
    EXPECT_TRUE(asks(*scan, Ask::spacing, "do not state the size of a voxel")) << all_of(*scan);
  }
  ReadOptions options;
  options.spacing_mm = {0.1, 0.2, 0.3};
  const auto sized = read(folder, options);
  ASSERT_TRUE(sized.ok());
  EXPECT_EQ(sized->spacing_mm, math::Vec3(0.1, 0.2, 0.3));
  EXPECT_FALSE(says(*sized, "in the file")) << all_of(*sized);
}

TEST_F(PictureStack, GreyInThreeColoursIsGreyAndOpaquenessIsLeftOut) {
  write("s", ".png", [&](int k) { return png_bytes({7, 5, 8, k % 2 != 0 ? 3 : 2}, slice(k, 8)); });
  expect_whole(read(folder), 8);
}

TEST_F(PictureStack, OfBmpIsReadFromBelowAndFromAbove) {
  write("rec", ".bmp", [&](int k) {
    return bmp_bytes({7, 5, 8, k % 3 != 0 ? 3 : 1}, slice(k, 8), k % 2 != 0);
  });
  write_bytes(path("rec.log"), "Pixel Size (um)=20");
  expect_whole(read(folder), 8);
}

TEST_F(PictureStack, OfTiffIsReadWhateverItsForm) {
  using Packing = TiffWriter::Packing;
  for (const Packing packing : {Packing::none, Packing::lzw, Packing::deflate, Packing::packbits})
    for (const bool big : {false, true})
      for (const int tile : {0, 16})
        for (const int bits : {8, 16}) {
          SCOPED_TRACE(static_cast<int>(packing) * 1000 + big * 100 + tile + bits);
          TiffWriter tiff;
          tiff.form = {21, 19, bits, 1};
          tiff.big = big;
          tiff.packing = packing;
          tiff.tile = tile;
          for (int k = 0; k < kSlices; ++k) tiff.page(slice(k, bits));
          write_bytes(path("stack.tif"), tiff.bytes());
          expect_whole(read(path("stack.tif")), bits, 21, 19);
        }
  expect_whole(read(folder), 16, 21, 19);  // the only file of a folder
}

TEST_F(PictureStack, OfTiffFilesIsReadFromAFolderAndFromAZipOfWindows) {
  write("jaw 10um_", "_rec.tif", [&](int k) {
    TiffWriter tiff;
    tiff.form.bits = 16;
    return tiff.page(slice(k, 16)).bytes();
  });
  expect_whole(read(folder), 16);
  test::ZipWriter zip;
  for (int k = 0; k < kSlices; ++k)
    zip.add("Scan\\Jaw\\s" + std::to_string(k) + ".tif",
            content(path("jaw 10um_" + std::to_string(k) + "_rec.tif")));
  write_bytes(path("windows.zip"), zip.bytes());
  expect_whole(read(path("windows.zip")), 16);
}

TEST_F(PictureStack, NumbersOfOtherTypesAreRead) {
  const auto as_float = [](int i, int j, int k) {
    return std::bit_cast<std::uint32_t>(0.25F * static_cast<float>(i + 10 * j + 100 * k));
  };
  TiffWriter real;
  real.form = {9, 9, 32, 1};
  real.kind = 3;
  TiffWriter negative;
  negative.form = {9, 9, 16, 1};
  negative.kind = 2;
  TiffWriter inverted;
  inverted.form = {9, 9, 16, 1};
  inverted.photometric = 0;
  for (int k = 0; k < kSlices; ++k) {
    real.page([&](int i, int j) { return as_float(i, j, k); });
    negative.page([&](int i, int j) { return static_cast<std::uint32_t>(i + 10 * j - 100 * k); });
    inverted.page([&](int i, int j) { return 65535 - value_at(i, j, k, 16); });
  }
  write_bytes(path("real.tif"), real.bytes());
  write_bytes(path("negative.tif"), negative.bytes());
  write_bytes(path("inverted.tif"), inverted.bytes());
  const auto a = read(path("real.tif")), b = read(path("negative.tif")),
             c = read(path("inverted.tif"));
  ASSERT_TRUE(a.ok()) << a.error().text;
  ASSERT_TRUE(b.ok()) << b.error().text;
  EXPECT_EQ(voxel(*a, 3, 4, 5), 0.25F * 543);
  EXPECT_EQ(voxel(*b, 3, 4, 5), 43.0F - 500);
  expect_whole(c, 16, 9, 9);
  EXPECT_TRUE(says(*c, "turned round")) << all_of(*c);
}

TEST_F(PictureStack, WhatImageJSaysOfTheVoxelIsUsedAndSaid) {
  const auto write_stack = [&](const std::string& lines) {
    TiffWriter tiff;
    tiff.form = {7, 5, 16, 1};
    tiff.description = "ImageJ=1.53t\nimages=12\nslices=12\n" + lines;
    tiff.per_unit = 20;  // pixels in a unit
    for (int k = 0; k < kSlices; ++k) tiff.page(slice(k, 16));
    write_bytes(path("j.tif"), tiff.bytes());
    return read(path("j.tif"));
  };
  const auto mm = write_stack("unit=mm\nspacing=0.125\n");
  expect_whole(mm, 16);
  EXPECT_TRUE(mm->spacing_mm.isApprox(math::Vec3(0.05, 0.05, 0.125), 1e-6)) << mm->spacing_mm;
  EXPECT_TRUE(says(*mm, "0.05 x 0.05 x 0.125 mm, is that of the ImageJ description"))
      << all_of(*mm);
  EXPECT_TRUE(mm->questions.empty()) << all_of(*mm);
  const auto micron = write_stack("unit=\\u00B5m\nspacing=60\n");
  ASSERT_TRUE(micron.ok());
  EXPECT_TRUE(micron->spacing_mm.isApprox(math::Vec3(5e-5, 5e-5, 0.06), 1e-6))
      << micron->spacing_mm;
  EXPECT_TRUE(asks(*micron, Ask::spacing, "no scan of bone has")) << all_of(*micron);
  const auto flat = write_stack("unit=mm\n");
  ASSERT_TRUE(flat.ok());
  EXPECT_TRUE(asks(*flat, Ask::spacing, "pixels of 0.05 x 0.05 mm and no distance"))
      << all_of(*flat);
  const auto pixels = write_stack("unit=pixel\nspacing=2\n");
  ASSERT_TRUE(pixels.ok());
  EXPECT_TRUE(asks(*pixels, Ask::spacing, "do not state")) << all_of(*pixels);
  // signed numbers, as ImageJ stores them
  const auto moved = write_stack("unit=mm\nspacing=0.1\ncf=0\nc0=-32768.0\nc1=1.0\n");
  ASSERT_TRUE(moved.ok());
  EXPECT_EQ(voxel(*moved, 2, 3, 4), static_cast<float>(value_at(2, 3, 4, 16)) - 32768);
}

TEST_F(PictureStack, OfSeveralChannelsOneIsChosen) {
  TiffWriter tiff;
  tiff.form = {7, 5, 16, 1};
  tiff.description =
      "ImageJ=1.53t\nimages=24\nchannels=2\nslices=12\nhyperstack=true\nunit=mm\nspacing=0.1\n";
  tiff.per_unit = 20;
  for (int k = 0; k < kSlices; ++k)
    for (std::uint32_t channel = 0; channel < 2; ++channel)
      tiff.page([&](int i, int j) { return value_at(i, j, k, 16) + 5000 * (1 - channel); });
  write_bytes(path("h.tif"), tiff.bytes());
  const auto open = read(path("h.tif"));
  ASSERT_TRUE(open.ok()) << open.error().text;
  EXPECT_TRUE(asks(*open, Ask::volume, "holds 2 volumes")) << all_of(*open);
  ReadOptions options;
  options.series = "2";
  expect_whole(read(path("h.tif"), options), 16);
}

TEST_F(PictureStack, MissingNumbersAreAskedForAndFilled) {
  write("a", ".png", [&](int k) { return png_bytes({7, 5, 16, 1}, slice(k, 16)); });
  std::filesystem::remove(path("a4.png"));
  std::filesystem::remove(path("a5.png"));
  const auto scan = read(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), kSlices);
  EXPECT_TRUE(asks(*scan, Ask::missing, "(numbers 4, 5)")) << all_of(*scan);
  EXPECT_EQ(voxel(*scan, 1, 2, 5), static_cast<float>(value_at(1, 2, 3, 16)));
  EXPECT_EQ(voxel(*scan, 1, 2, 6), static_cast<float>(value_at(1, 2, 6, 16)));
}

TEST_F(PictureStack, NumbersInStepsOfTenMissNothing) {
  for (int k = 0; k < kSlices; ++k)
    write_bytes(path("a" + std::to_string(10 * k) + ".png"),
                png_bytes({7, 5, 16, 1}, slice(k, 16)));
  const auto scan = read(folder);
  expect_whole(scan, 16);
  EXPECT_FALSE(says(*scan, "missing")) << all_of(*scan);
}

TEST_F(PictureStack, WhatIsNoStackGetsOneClearSentence) {
  const auto png = [&](int k) { return png_bytes({7, 5, 8, 1}, slice(k, 8)); };
  write("a", ".png", png);
  write_bytes(path("a7.png"), png_bytes({7, 4, 8, 1}, slice(7, 8)));
  expect_refused(folder, "a7.png: has 7 x 4 pixels, and the pictures before it 7 x 5");
  write_bytes(path("a7.png"), png_bytes({7, 5, 16, 1}, slice(7, 16)));
  expect_refused(folder, "a7.png: has 16 bits a pixel, and the pictures before it 8");
  int n = 0;
  write_bytes(path("a7.png"), png_bytes({7, 5, 8, 3}, [&](int, int) {
                return static_cast<std::uint32_t>(n++ % 200);
              }));
  expect_refused(folder, "a7.png: is a colour picture");
  write_bytes(path("a7.png"), png(7).substr(0, 60));
  expect_refused(folder, "a7.png: is a damaged PNG picture");
  write_bytes(path("a7.png"), png(7));
  write_bytes(path("a07.png"), png(7));
  expect_refused(folder, "have the same number");
  std::filesystem::remove(path("a07.png"));
  write("b", ".png", png);
  expect_refused(folder, "names of 2 kinds (a#.png (12), b#.png (12))");
  expect_refused(path("b3.png"), "is one picture, and a volume is a stack of them");
}

TEST_F(PictureStack, APreviewBesideTheStackIsLeftOut) {
  write("rec", ".png", [&](int k) { return png_bytes({7, 5, 16, 1}, slice(k, 16)); });
  write_bytes(path("rec_spr.png"), png_bytes({3, 3, 8, 1}, slice(0, 8)));
  const auto scan = read(folder);
  expect_whole(scan, 16);
  EXPECT_TRUE(says(*scan, "1 other picture in the folder was left out")) << all_of(*scan);
}

TEST_F(PictureStack, DamagedTiffIsASentence) {
  TiffWriter tiff;
  tiff.form = {64, 64, 16, 1};
  for (int k = 0; k < kSlices; ++k) tiff.page(slice(k, 16));
  const std::string whole = tiff.bytes();
  write_bytes(path("cut.tif"), whole.substr(0, whole.size() / 2));
  expect_refused(path("cut.tif"), "damaged TIFF picture");
  // within a picture, and within each part of the last directory: never fewer pictures without a word
  for (const std::size_t end : {whole.size() / 3, whole.size() / 3 + 1000, whole.size() / 2 + 1,
                                whole.size() / 2 + 4, whole.size() - 1, whole.size() - 4,
                                whole.size() - 5, whole.size() - 100, whole.size() - 130}) {
    SCOPED_TRACE(end);
    write_bytes(path("cut.tif"), whole.substr(0, end));
    expect_refused(path("cut.tif"), "damaged TIFF picture");
  }
  // a page that claims 30 000 x 30 000 pixels
  std::string large = whole;
  const std::string width = test::number_bytes(256, 2) + test::number_bytes(3, 2);
  const std::size_t at = large.find(width);
  ASSERT_NE(at, std::string::npos);
  large.replace(at + 8, 2, test::number_bytes(30000, 2));
  write_bytes(path("large.tif"), large);
  expect_refused(path("large.tif"), "cannot hold a picture of 30000 x 64 pixels");
}

}  // namespace
}  // namespace burr::io
