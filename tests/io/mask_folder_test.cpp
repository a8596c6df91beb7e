// Masks of shapes that are known by formula, one file a structure, in NIfTI, NRRD and MetaImage: every voxel of the label
// map that they become is compared.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"

namespace burr::io {
namespace {

using math::Ijk;
using math::Vec3;
using Shape = std::function<double(int i, int j, int k)>;

const Ijk kSize = {20, 18, 16};
const Vec3 kSpacing = {0.5, 0.6, 0.8}, kOrigin = {-3, 4, 7};

bool in_ball(int i, int j, int k) {
  const int x = i - 8, y = j - 8, z = k - 8;
  return x * x + y * y + z * z <= 25;
}
bool in_box(int i, int j, int k) {
  return i >= 10 && i < 16 && j >= 6 && j < 11 && k >= 5 && k < 9;
}
double ball(int i, int j, int k) { return in_ball(i, j, k) ? 1 : 0; }
double box(int i, int j, int k) { return in_box(i, j, k) ? 1 : 0; }
double nothing(int /*i*/, int /*j*/, int /*k*/) { return 0; }
// a head in a scan: soft tissue, bone, air, never flat
double head(int i, int j, int k) {
  const int noise = (i * 7 + j * 13 + k * 29) % 11;
  return in_box(i, j, k) ? 900 + noise : in_ball(i, j, k) ? 40 + noise : -1000 + noise;
}

template <class T>
std::string raw(const Ijk& size, const Shape& shape) {
  std::string out;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        const T value = static_cast<T>(shape(i, j, k));
        out.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
  return out;
}
std::string text(const Vec3& v) {
  return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
}

class MaskFolder : public test::FolderTest {
 protected:
  void put(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << bytes;
  }
  template <class T>
  void meta(const std::string& name, const char* type, const Shape& shape, const Ijk& size = kSize,
            const Vec3& origin = kOrigin, const Vec3& spacing = kSpacing,
            const std::string& turn = "1 0 0 0 1 0 0 0 1") const {
    put(name, "ObjectType = Image\nNDims = 3\nTransformMatrix = " + turn +
                  "\nOffset = " + text(origin) + "\nElementSpacing = " + text(spacing) +
                  "\nDimSize = " + std::to_string(size.x()) + " " + std::to_string(size.y()) + " " +
                  std::to_string(size.z()) + "\nElementType = " + type +
                  "\nElementDataFile = LOCAL\n" + raw<T>(size, shape));
  }
  void mask(const std::string& name, const Shape& shape) const {
    meta<std::uint8_t>(name, "MET_UCHAR", shape);
  }
  void nrrd(const std::string& name, const Shape& shape) const {
    const auto way = [](double x, double y, double z) {
      return "(" + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + ")";
    };
    put(name,
        "NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 20 18 "
        "16\nspace directions: " +
            way(kSpacing.x(), 0, 0) + " " + way(0, kSpacing.y(), 0) + " " +
            way(0, 0, kSpacing.z()) +
            "\nspace origin: " + way(kOrigin.x(), kOrigin.y(), kOrigin.z()) +
            "\nendian: little\nencoding: raw\n\n" + raw<std::int16_t>(kSize, shape));
  }
  // in RAS, as NIfTI has it
  void nifti(const std::string& name, const Shape& shape) const {
    std::array<char, 352> head{};
    const auto at = [&](std::size_t place, auto value) {
      std::memcpy(head.data() + place, &value, sizeof value);
    };
    at(0, std::int32_t{348});
    for (std::size_t n = 0; n < 8; ++n)
      at(40 + 2 * n, std::int16_t(n == 0 ? 3 : n < 4 ? kSize[static_cast<int>(n) - 1] : 1));
    at(70, std::int16_t{16});
    at(72, std::int16_t{32});
    at(76, 1.0F);
    for (int a = 0; a < 3; ++a)
      at(80 + 4 * static_cast<std::size_t>(a), static_cast<float>(kSpacing[a]));
    at(108, 352.0F);
    at(112, 1.0F);
    head[123] = 2;
    at(254, std::int16_t{1});
    for (int a = 0; a < 3; ++a) {
      const double sign = a < 2 ? -1 : 1;
      at(280 + 20 * static_cast<std::size_t>(a), static_cast<float>(sign * kSpacing[a]));
      at(280 + 16 * static_cast<std::size_t>(a) + 12, static_cast<float>(sign * kOrigin[a]));
    }
    std::memcpy(head.data() + 344, "n+1", 4);
    put(name, std::string(head.data(), head.size()) + raw<float>(kSize, shape));
  }
  [[nodiscard]] Result<Scan> read(const std::string& series = "",
                                  const std::string& of = "") const {
    NoProgress progress;
    ReadOptions options;
    options.series = series;
    return read_scan(of.empty() ? folder.string() : path(of), options, progress);
  }
  static bool says(const Scan& scan, const std::string& words) {
    return std::any_of(scan.notices.begin(), scan.notices.end(),
                       [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }
  static std::string all_of(const Scan& scan) {
    std::string out;
    for (const std::string& n : scan.notices) out += n + "\n";
    return out;
  }
  static int number(const Scan& scan, const std::string& name) {
    for (const Label& label : scan.label_names)
      if (label.name == name) return label.value;
    return -1;
  }
  // How many voxels of the usual grid differ from what f says; the scan may hold more, which must be empty.
  static std::size_t wrong(const Scan& scan, const std::function<int(int, int, int)>& f) {
    std::size_t n = 0;
    for (int k = 0; k < scan.size.z(); ++k)
      for (int j = 0; j < scan.size.y(); ++j)
        for (int i = 0; i < scan.size.x(); ++i) {
          const Vec3 world =
              scan.origin_mm + scan.axes * scan.spacing_mm.cwiseProduct(Vec3(i, j, k));
          const Ijk at = (world - kOrigin).cwiseQuotient(kSpacing).array().round().cast<int>();
          EXPECT_LT((kOrigin + kSpacing.cwiseProduct(at.cast<double>()) - world).norm(), 1e-4);
          const bool there = (at.array() >= 0).all() && (at.array() < kSize.array()).all();
          const int wanted = there ? f(at.x(), at.y(), at.z()) : 0;
          const auto v = static_cast<std::size_t>((k * scan.size.y() + j) * scan.size.x() + i);
          n += scan.labels[v] != wanted ? 1 : 0;
        }
    return n;
  }
  static std::size_t shared() {
    std::size_t n = 0;
    for (int k = 0; k < kSize.z(); ++k)
      for (int j = 0; j < kSize.y(); ++j)
        for (int i = 0; i < kSize.x(); ++i) n += in_ball(i, j, k) && in_box(i, j, k) ? 1 : 0;
    return n;
  }
  static void expect_ball_and_box(const Scan& scan, const std::string& big,
                                  const std::string& small) {
    const int ball_number = number(scan, big), box_number = number(scan, small);
    ASSERT_GT(ball_number, 0) << all_of(scan);
    ASSERT_GT(box_number, 0) << all_of(scan);
    // the box has fewer voxels, so it stays
    EXPECT_EQ(wrong(scan,
                    [&](int i, int j, int k) {
                      return in_box(i, j, k) ? box_number : in_ball(i, j, k) ? ball_number : 0;
                    }),
              0U);
  }
};

TEST_F(MaskFolder, ThreeFormatsBecomeOneLabelMapWithTheNamesOfTheFiles) {
  nifti("femur_left.nii", ball);
  nrrd("N. facialis.nrrd", box);
  mask("liver.mha", nothing);
  const auto scan = read();
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->label_names.size(), 2U) << all_of(*scan);
  expect_ball_and_box(*scan, "femur_left", "N. facialis");
  EXPECT_TRUE(scan->values.empty());
  EXPECT_TRUE(says(*scan, "overlap in " + std::to_string(shared()) +
                              " voxels: there the smaller one stays (N. facialis over femur_left"))
      << all_of(*scan);
  EXPECT_TRUE(says(*scan, "One structure has no voxel and is left out: liver.")) << all_of(*scan);
  EXPECT_TRUE(says(*scan, "3 masks, one file a structure")) << all_of(*scan);
  EXPECT_TRUE(read("#1").ok());
  const auto second = read("#2");
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().text.find("holds one label map, and `series` names another, \"#2\""),
            std::string::npos)
      << second.error().text;
}

TEST_F(MaskFolder, CutAndTurnedMasksLieWhereTheyBelong) {
  mask("whole.mha", ball);
  // the same box, cut to a block that begins at (9, 5, 4), with i and j exchanged and k reversed
  const Ijk cut = {8, 9, 7};
  const Vec3 first = kOrigin + kSpacing.cwiseProduct(Vec3(9, 5, 10));
  meta<std::uint8_t>(
      "cut.mha", "MET_UCHAR", [](int a, int b, int c) { return box(9 + b, 5 + a, 10 - c); }, cut,
      first, Vec3(kSpacing.y(), kSpacing.x(), kSpacing.z()), "0 1 0 1 0 0 0 0 -1");
  const auto scan = read();
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  expect_ball_and_box(*scan, "whole", "cut");
  // and beyond the first mask: the label map is as large as both
  meta<std::uint8_t>(
      "beyond.mha", "MET_UCHAR", [](int, int, int) { return 1; }, {2, 2, 2},
      kOrigin - kSpacing.cwiseProduct(Vec3(4, 0, 0)));
  const auto larger = read();
  ASSERT_TRUE(larger.ok()) << larger.error().text;
  EXPECT_EQ(larger->size.x(), kSize.x() + 4);
  EXPECT_EQ(std::count(larger->labels.begin(), larger->labels.end(), number(*larger, "beyond")), 8);
}

TEST_F(MaskFolder, OtherVoxelsAreRefusedWithBothGrids) {
  mask("a.mha", ball);
  meta<std::uint8_t>("b.mha", "MET_UCHAR", box, kSize, kOrigin, {0.5, 0.6, 0.9});
  const auto scan = read();
  ASSERT_FALSE(scan.ok());
  for (const char* words : {"a.mha and b.mha have different voxels", "0.5 x 0.6 x 0.8", "0.9 mm"})
    EXPECT_NE(scan.error().text.find(words), std::string::npos) << scan.error().text;
  meta<std::uint8_t>("b.mha", "MET_UCHAR", box, kSize, kOrigin + Vec3(0.2, 0, 0));
  EXPECT_FALSE(read().ok()) << "0.4 voxel aside";
}

TEST_F(MaskFolder, HalfAndMoreOfAProbabilityIsInside) {
  meta<float>("bone.mha", "MET_FLOAT",
              [](int i, int j, int k) { return in_ball(i, j, k) ? 0.5 : 0.499 - 0.001 * (i % 7); });
  mask("nerve.mha", box);
  const auto scan = read();
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  expect_ball_and_box(*scan, "bone", "nerve");
  EXPECT_TRUE(says(*scan,
                   "bone.mha states a probability for each voxel (0 to 1): voxels of 0.5 or "
                   "more are inside"))
      << all_of(*scan);
}

TEST_F(MaskFolder, BesideItsScanItIsTheSecondOfTheList) {
  meta<std::int16_t>("ct.mha", "MET_SHORT", head);
  mask("segmentations/femur.mha", ball);
  mask("segmentations/nerve.mha", box);
  const auto scan = read();
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_FALSE(scan->values.empty());
  EXPECT_EQ(scan->series_taken, 0);
  ASSERT_EQ(scan->series.size(), 2U);
  EXPECT_TRUE(says(*scan, "ct.mha was read; femur.mha, nerve.mha lie beside it")) << all_of(*scan);
  const auto labels = read("#2");
  ASSERT_TRUE(labels.ok()) << labels.error().text;
  EXPECT_EQ(labels->series_taken, 1);
  expect_ball_and_box(*labels, "femur", "nerve");
  const auto third = read("#3");
  ASSERT_FALSE(third.ok());
  EXPECT_EQ(third.error().trouble, Trouble::usage);
  // without a word in the names that tells labels from scans
  std::filesystem::rename(path("segmentations"), path("parts"));
  const auto plain = read();
  ASSERT_TRUE(plain.ok()) << plain.error().text;
  EXPECT_FALSE(plain->values.empty());
  const auto second = read("#2");
  ASSERT_TRUE(second.ok()) << second.error().text;
  expect_ball_and_box(*second, "femur", "nerve");
  EXPECT_FALSE(says(*second, "other voxels")) << all_of(*second);
  // labels of other voxels are read, and it is said
  for (const char* name : {"parts/femur.mha", "parts/nerve.mha"})
    meta<std::uint8_t>(name, "MET_UCHAR", ball, kSize, kOrigin + Vec3(0.2, 0, 0));
  const auto aside = read("#2");
  ASSERT_TRUE(aside.ok()) << aside.error().text;
  EXPECT_TRUE(says(*aside, "have other voxels than ct.mha")) << all_of(*aside);
}

TEST_F(MaskFolder, FilesOfOneNameGetThatOfTheirFolder) {
  mask("femur/mask.mha", ball);
  mask("nerve/mask.mha", box);
  const auto scan = read();
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  expect_ball_and_box(*scan, "femur", "nerve");
}

TEST_F(MaskFolder, WhatIsNoSetOfMasksStaysAsItWas) {
  meta<std::int16_t>("a.mha", "MET_SHORT", head);
  meta<std::int16_t>("b.mha", "MET_SHORT", head);
  const auto scans = read();
  ASSERT_FALSE(scans.ok());
  EXPECT_NE(scans.error().text.find("holds 2 scans or label maps (a.mha, b.mha)"),
            std::string::npos)
      << scans.error().text;
  const auto two = [](int i, int j, int /*k*/) { return j < 4 ? 0 : i < 10 ? 1 : 2; };
  mask("a.mha", two);
  mask("b.mha", two);
  EXPECT_FALSE(read().ok()) << "two label maps of several structures";
  // one of them beside masks is left out by name
  mask("b.mha", ball);
  mask("c.mha", box);
  const auto beside = read();
  ASSERT_TRUE(beside.ok()) << beside.error().text;
  expect_ball_and_box(*beside, "b", "c");
  EXPECT_TRUE(says(*beside, "a.mha holds several structures and was left out")) << all_of(*beside);
}

TEST_F(MaskFolder, MoreThan255StructuresAreRefused) {
  for (int n = 0; n < 256; ++n)
    meta<std::uint8_t>("s" + std::to_string(n) + ".mha", "MET_UCHAR",
                       [n](int i, int j, int k) { return i + 16 * j + 256 * k == n ? 1 : 0; },
                       {16, 16, 2});
  const auto scan = read();
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("holds 256 structures, and burr reads at most 255"),
            std::string::npos)
      << scan.error().text;
  std::filesystem::remove(path("s0.mha"));
  const auto fits = read();
  ASSERT_TRUE(fits.ok()) << fits.error().text;
  EXPECT_EQ(fits->label_names.size(), 255U);
}

}  // namespace
}  // namespace burr::io
