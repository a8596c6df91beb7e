// Files of several volumes, and files that state no spacing: NRRD, NIfTI and MetaImage written byte by byte from
// one formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"
#include "io/picture_writer.h"

namespace burr::io {
namespace {

using test::number_bytes;
using test::write_bytes;

constexpr int kX = 5, kY = 4, kZ = 3, kT = 6;

int value_at(int i, int j, int k, int t) { return i + 10 * j + 100 * k + 1000 * t - 1000; }

Result<Scan> read(const std::string& path, const std::string& series = "",
                  const math::Vec3& spacing_mm = {0, 0, 0}) {
  ReadOptions options;
  options.series = series;
  options.spacing_mm = spacing_mm;
  NoProgress progress;
  return read_scan(path, options, progress);
}
bool asks(const Scan& scan, Ask ask, const std::string& words) {
  return std::any_of(scan.questions.begin(), scan.questions.end(), [&](const Question& q) {
    return q.ask == ask && q.text.find(words) != std::string::npos;
  });
}

// The numbers of all volumes; the axis of the volumes stands before that many axes of space.
std::string numbers(int axis_of_volumes) {
  std::string out;
  const int sizes[] = {kX, kY, kZ};
  int all[4], n = 0;
  for (int a = 0; a < 4; ++a) all[a] = a == axis_of_volumes ? kT : sizes[n++];
  for (int d = 0; d < all[3]; ++d)
    for (int c = 0; c < all[2]; ++c)
      for (int b = 0; b < all[1]; ++b)
        for (int a = 0; a < all[0]; ++a) {
          const int at[] = {a, b, c, d};
          int space[3], s = 0;
          for (int x = 0; x < 4; ++x)
            if (x != axis_of_volumes) space[s++] = at[x];
          out += number_bytes(static_cast<std::uint64_t>(
                                  value_at(space[0], space[1], space[2], at[axis_of_volumes])),
                              2);
        }
  return out;
}

std::string nrrd(int axis, const std::string& directions, const std::string& kinds) {
  std::string sizes;
  const char* space[] = {"5", "4", "3"};
  for (int a = 0, n = 0; a < 4; ++a) sizes += a == axis ? " 6" : std::string(" ") + space[n++];
  return "NRRD0004\ntype: int16\ndimension: 4\nspace: left-posterior-superior\nsizes:" + sizes +
         "\n" + directions + kinds + "endian: little\nencoding: raw\nspace origin: (0,0,0)\n\n";
}

// A NIfTI header; pixdim: of the first three axes.
std::string nifti(int volumes, float pixdim, bool sform) {
  std::string h(352, '\0');
  const auto put = [&](std::size_t at, const std::string& bytes) {
    h.replace(at, bytes.size(), bytes);
  };
  const auto real = [](float value) {
    std::string out(4, '\0');
    std::memcpy(out.data(), &value, 4);
    return out;
  };
  put(0, number_bytes(348, 4));
  const int dim[] = {volumes > 1 ? 4 : 3, kX, kY, kZ, volumes, 1, 1, 1};
  for (std::size_t n = 0; n < 8; ++n)
    put(40 + 2 * n, number_bytes(static_cast<std::uint64_t>(dim[n]), 2));
  put(70, number_bytes(4, 2));
  put(72, number_bytes(16, 2));
  for (std::size_t n = 1; n < 4; ++n) put(76 + 4 * n, real(pixdim));
  put(108, real(352));
  h[123] = 2;
  if (sform) {
    put(254, number_bytes(1, 2));
    for (std::size_t a = 0; a < 3; ++a) put(280 + 20 * a, real(0.5F));
  }
  put(344, "n+1");
  return h;
}

std::string meta(const std::string& more) {
  return "ObjectType = Image\nNDims = 4\nBinaryData = True\n" + more +
         "DimSize = 5 4 3 6\nElementType = MET_SHORT\nElementDataFile = LOCAL\n";
}

class SeveralVolumes : public test::FolderTest {
 protected:
  void expect_each(const std::string& name) const {
    SCOPED_TRACE(name);
    for (int t = 0; t < kT; ++t) {
      const std::string number = std::to_string(t + 1);
      const auto scan = read(path(name), t % 2 != 0 ? "#" + number : number);
      ASSERT_TRUE(scan.ok()) << scan.error().text;
      ASSERT_EQ(scan->size, math::Ijk(kX, kY, kZ));
      EXPECT_TRUE(scan->spacing_mm.isApprox(math::Vec3(0.5, 0.5, 0.5), 1e-6));
      EXPECT_EQ(scan->series_taken, t);
      for (int k = 0; k < kZ; ++k)
        for (int j = 0; j < kY; ++j)
          for (int i = 0; i < kX; ++i)
            ASSERT_EQ(scan->values[static_cast<std::size_t>((k * kY + j) * kX + i)],
                      static_cast<float>(value_at(i, j, k, t)));
    }
    const auto open = read(path(name));
    ASSERT_TRUE(open.ok()) << open.error().text;
    EXPECT_TRUE(asks(*open, Ask::volume, name + ": holds 6 volumes, and burr reads one"));
    EXPECT_EQ(open->series.size(), std::size_t{kT});
    for (const char* wrong : {"7", "0", "#x", "1.2.840"}) {
      const auto none = read(path(name), wrong);
      ASSERT_FALSE(none.ok()) << wrong;
      EXPECT_NE(none.error().text.find("give a number from 1 to 6"), std::string::npos);
    }
  }
};

TEST_F(SeveralVolumes, OfNrrdAreReadByTheirNumberWhereverTheirAxisIs) {
  const std::string d = "(0.5,0,0)", e = "(0,0.5,0)", f = "(0,0,0.5)";
  write_bytes(path("last.nrrd"), nrrd(3, "space directions: " + d + e + f + " none\n",
                                      "kinds: domain domain domain list\n") +
                                     numbers(3));
  expect_each("last.nrrd");
  write_bytes(path("first.nrrd"), nrrd(0, "space directions: none " + d + " " + e + " " + f + "\n",
                                       "kinds: list domain domain domain\n") +
                                      numbers(0));
  expect_each("first.nrrd");
  write_bytes(path("middle.nrrd"),
              nrrd(1, "space directions: " + d + " none " + e + " " + f + "\n", "") + numbers(1));
  expect_each("middle.nrrd");
  write_bytes(path("bare.nrrd"), nrrd(3, "spacings: 0.5 0.5 0.5 1\n", "") + numbers(3));
  expect_each("bare.nrrd");
  // as text
  std::string text = nrrd(0, "spacings: 1 0.5 0.5 0.5\n", "kinds: time space space space\n"), words;
  text.replace(text.find("raw"), 3, "ascii");
  const std::string all = numbers(0);
  for (std::size_t n = 0; n + 1 < all.size(); n += 2)
    words += std::to_string(static_cast<std::int16_t>(static_cast<std::uint8_t>(all[n]) |
                                                      static_cast<std::uint8_t>(all[n + 1]) << 8)) +
             " ";
  write_bytes(path("text.nrrd"), text + words);
  expect_each("text.nrrd");
}

TEST_F(SeveralVolumes, OfNiftiAndMetaImageAreReadByTheirNumber) {
  write_bytes(path("t.nii"), nifti(kT, 0.5F, true) + numbers(3));
  expect_each("t.nii");
  write_bytes(path("t.mha"),
              meta("ElementSpacing = 0.5 0.5 0.5 2\nOffset = 0 0 0 0\nTransformMatrix = 1 "
                   "0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n") +
                  numbers(3));
  expect_each("t.mha");
  const auto cut = nifti(kT, 0.5F, true) + numbers(3).substr(0, 500);
  write_bytes(path("cut.nii"), cut);
  EXPECT_FALSE(read(path("cut.nii"), "1").ok());
}

TEST_F(SeveralVolumes, AFileOfOneTakesNoOther) {
  write_bytes(path("one.nii"), nifti(1, 0.5F, true) + numbers(3));
  EXPECT_TRUE(read(path("one.nii"), "#1").ok());
  const auto other = read(path("one.nii"), "#2");
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().text.find("holds one volume"), std::string::npos) << other.error().text;
}

TEST_F(SeveralVolumes, ColoursAreNoVolumes) {
  std::string header = nrrd(0, "space directions: none (1,0,0) (0,1,0) (0,0,1)\n",
                            "kinds: RGB-color domain domain domain\n");
  header.replace(header.find("sizes: 6"), 8, "sizes: 3");
  write_bytes(path("rgb.nrrd"), header + numbers(0));
  const auto scan = read(path("rgb.nrrd"));
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("burr reads one value per voxel"), std::string::npos);
}

TEST_F(SeveralVolumes, AMissingSpacingIsAskedForAndTheAnswerIsSaidTruly) {
  write_bytes(path("a.nii"), nifti(1, 0, false) + numbers(3));
  write_bytes(path("a.nrrd"),
              "NRRD0004\ntype: int16\ndimension: 3\nsizes: 5 4 3\nendian: little\n"
              "encoding: raw\n\n" +
                  numbers(3).substr(0, 120));
  write_bytes(path("half.nrrd"),
              "NRRD0004\ntype: int16\ndimension: 3\nsizes: 5 4 3\nendian: little\n"
              "spacings: 0.5 0.5 nan\nencoding: raw\n\n" +
                  numbers(3).substr(0, 120));
  write_bytes(path("a.mha"),
              "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementType = MET_SHORT\n"
              "ElementDataFile = LOCAL\n" +
                  numbers(3).substr(0, 120));
  for (const char* name : {"a.nii", "a.nrrd", "half.nrrd", "a.mha"}) {
    const auto open = read(path(name));
    ASSERT_TRUE(open.ok()) << open.error().text;
    EXPECT_TRUE(asks(*open, Ask::spacing, "voxel spacing")) << name;
    const auto given = read(path(name), "", {0.3, 0.4, 0.5});
    ASSERT_TRUE(given.ok()) << given.error().text;
    EXPECT_EQ(given->spacing_mm, math::Vec3(0.3, 0.4, 0.5));
    for (const std::string& notice : given->notices)
      EXPECT_EQ(notice.find("in the file"), std::string::npos) << notice;
  }
}

}  // namespace
}  // namespace burr::io
