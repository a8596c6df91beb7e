// Contours (RTSTRUCT) of bodies that are known by formula, drawn on a CT: every voxel is compared. A second program draws
// and compares others in tests/io/contours_elsewhere.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "burr/io/read/read_scan.h"
#include "io/dicom_writer.h"
#include "io/folder_of_test.h"
#include "io/seg_writer.h"
#include "support/data.h"

namespace burr::io {
namespace {

using math::Mat3;
using math::Vec3;
using test::DicomSlice;
using test::SegFile;

constexpr int kColumns = 40, kRows = 36, kSlices = 30;
const Vec3 kSpacing = {0.5, 0.6, 0.8}, kOrigin = {-10, -11, 5};
const Vec3 kMiddle = {0.13, -0.21, 16.4};  // of the bodies, about that of the scan

struct Drawn {
  std::string type = "CLOSED_PLANAR";
  std::vector<Vec3> points;
};
struct Roi {
  std::string name = {}, colour = {}, interpreted = {}, frame = "1.2.5";
  std::vector<Drawn> contours = {};
};

class ContourFile {
 public:
  std::vector<Roi> rois;
  std::string data_of_first;  // not empty: Contour Data of the first contour, as it is

  [[nodiscard]] std::string bytes() const {
    std::vector<std::string> structures, contours, observations;
    for (std::size_t n = 0; n < rois.size(); ++n) {
      const Roi& roi = rois[n];
      const std::string number = std::to_string(n + 3);
      structures.push_back(SegFile::element(0x30060022, "IS", number) +
                           SegFile::element(0x30060024, "UI", roi.frame) +
                           SegFile::element(0x30060026, "LO", roi.name));
      std::vector<std::string> all;
      for (const Drawn& one : roi.contours)
        all.push_back(SegFile::element(0x30060042, "CS", one.type) +
                      SegFile::element(0x30060046, "IS", std::to_string(one.points.size())) +
                      data(n == 0 && all.empty() && !data_of_first.empty() ? data_of_first
                                                                           : text(one.points)));
      std::string item;
      if (!roi.colour.empty()) item += SegFile::element(0x3006002A, "IS", roi.colour);
      if (!all.empty()) item += SegFile::sequence(0x30060040, all);
      contours.push_back(item + SegFile::element(0x30060084, "IS", number));
      observations.push_back(SegFile::element(0x30060084, "IS", number) +
                             SegFile::element(0x300600A4, "CS", roi.interpreted));
    }
    return std::string(128, '\0') + "DICM" +
           SegFile::element(0x00020010, "UI", "1.2.840.10008.1.2.1") +
           SegFile::element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.3") +
           SegFile::element(0x00080060, "CS", "RTSTRUCT") +
           SegFile::element(0x0020000E, "UI", "1.2.9") + SegFile::sequence(0x30060020, structures) +
           SegFile::sequence(0x30060039, contours) + SegFile::sequence(0x30060080, observations);
  }
  void write(const std::string& path) const { std::ofstream(path, std::ios::binary) << bytes(); }

 private:
  // as some programs write long texts: of an unknown type, whose length has 32 bits
  static std::string data(std::string text) {
    constexpr std::size_t kLong = 60000;
    if (text.size() < kLong) return SegFile::element(0x30060050, "DS", text);
    if (text.size() % 2 != 0) text += ' ';
    return SegFile::number16(0x3006) + SegFile::number16(0x0050) + "UN" + SegFile::number16(0) +
           SegFile::number16(text.size() & 0xFFFF) + SegFile::number16(text.size() >> 16) + text;
  }
  static std::string text(const std::vector<Vec3>& points) {
    std::string out;
    for (const Vec3& p : points)
      for (int a = 0; a < 3; ++a) {
        char number[32];
        std::snprintf(number, sizeof number, "%s%.9g", out.empty() ? "" : "\\", p[a]);
        out += number;
      }
    return out;
  }
};

// A plane with its own x, y and normal, in which curves are drawn around a point.
struct Sheet {
  Mat3 turn = Mat3::Identity();
  [[nodiscard]] std::vector<Vec3> ring(const Vec3& middle, double radius, int points = 180,
                                       bool backwards = false) const {
    std::vector<Vec3> out;
    for (int n = 0; n <= points; ++n) {
      const double angle = 2 * std::numbers::pi * n / points * (backwards ? -1 : 1);
      out.emplace_back(middle +
                       radius * (std::cos(angle) * turn.col(0) + std::sin(angle) * turn.col(1)));
    }
    out.pop_back();
    return out;
  }
};

class Contours : public test::FolderTest {
 protected:
  void ct(const Mat3& turn = Mat3::Identity(), const std::string& frame = "1.2.5") {
    turn_ = turn;
    for (int k = 0; k < kSlices; ++k) {
      DicomSlice slice;
      slice.columns = kColumns;
      slice.rows = kRows;
      slice.at(k, k + 1);
      const Vec3 at = origin() + turn * Vec3(0, 0, k * kSpacing.z());
      const auto join = [](std::initializer_list<double> all) {
        std::string out;
        for (const double v : all) {
          char number[32];
          std::snprintf(number, sizeof number, "%s%.10g", out.empty() ? "" : "\\", v);
          out += number;
        }
        return out;
      };
      slice.set(0x00200032, "DS", join({at.x(), at.y(), at.z()}));
      slice.set(0x00200037, "DS",
                join({turn(0, 0), turn(1, 0), turn(2, 0), turn(0, 1), turn(1, 1), turn(2, 1)}));
      slice.set(0x00280030, "DS", "0.6\\0.5").set(0x00180050, "DS", "0.8");
      slice.set(0x00200052, "UI", frame);
      slice.write(path("ct" + std::to_string(k) + ".dcm"));
    }
  }
  // so that the middle stays in the middle
  [[nodiscard]] Vec3 origin() const { return kMiddle + turn_ * (kOrigin - kMiddle); }
  [[nodiscard]] double slice_z(int k) const { return kOrigin.z() + kSpacing.z() * k; }

  // Rings of a ball in planes across the normal of a sheet, at these distances from its middle.
  static Roi ball(const std::string& name, double radius, const Sheet& sheet,
                  const std::vector<double>& at) {
    Roi roi{.name = name, .colour = "", .interpreted = "ORGAN", .contours = {}};
    for (const double s : at)
      if (radius - std::abs(s) > 1e-6)  // a slice that only touches the ball has no ring
        roi.contours.push_back({"CLOSED_PLANAR", sheet.ring(kMiddle + s * sheet.turn.col(2),
                                                            std::sqrt(radius * radius - s * s))});
    return roi;
  }
  // where the slices lie, from the middle
  [[nodiscard]] std::vector<double> on_slices() const {
    std::vector<double> out;
    for (int k = 0; k < kSlices; ++k) out.push_back(slice_z(k) - kMiddle.z());
    return out;
  }
  static std::vector<double> every(double gap, double from = -20) {
    std::vector<double> out;
    for (double s = from; s < 20; s += gap) out.push_back(s);
    return out;
  }

  Result<Scan> read(const ContourFile& file, const std::string& series = "#2") {
    file.write(path("rs.dcm"));
    NoProgress progress;
    ReadOptions options;
    options.series = series;
    return read_scan(folder.string(), options, progress);
  }
  static bool says(const Scan& scan, const std::string& words) {
    return std::any_of(scan.notices.begin(), scan.notices.end(),
                       [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }
  static std::string all_of(const Scan& scan) {
    std::string out;
    for (const std::string& n : scan.notices) out += n + "\n";
    for (const Question& q : scan.questions) out += "? " + q.text + "\n";
    return out;
  }
  // Compares label `value` with a body: depth is the distance from its surface, above 0 inside. Voxels nearer to the
  // surface than `near` are not compared. Gives the labelled volume over that of the voxels inside.
  static double expect_body(const Scan& scan, int value, double near,
                            const std::function<double(const Vec3&)>& depth) {
    std::size_t wrong = 0, inside = 0, labelled = 0, v = 0;
    for (int k = 0; k < scan.size.z(); ++k)
      for (int j = 0; j < scan.size.y(); ++j)
        for (int i = 0; i < scan.size.x(); ++i, ++v) {
          const double d =
              depth(scan.origin_mm + scan.axes * scan.spacing_mm.cwiseProduct(Vec3(i, j, k)));
          const bool is = scan.labels[v] == value;
          inside += d > 0 ? 1 : 0;
          labelled += is ? 1 : 0;
          wrong += std::abs(d) > near && is != (d > 0) ? 1 : 0;
        }
    EXPECT_EQ(wrong, 0U) << "of " << inside << " voxels inside; " << all_of(scan);
    EXPECT_GT(inside, 100U);
    return static_cast<double>(labelled) / static_cast<double>(inside);
  }
  static std::function<double(const Vec3&)> of_ball(double radius) {
    return [radius](const Vec3& p) { return radius - (p - kMiddle).norm(); };
  }
  static Mat3 askew() {
    return (Eigen::AngleAxisd(0.5, Vec3(1, 2, -1).normalized()) *
            Eigen::AngleAxisd(-0.3, Vec3::UnitZ()))
        .toRotationMatrix();
  }

 private:
  Mat3 turn_ = Mat3::Identity();
};

constexpr double kRounded = 0.002;  // a ring of 180 points lies up to so far inside its circle [mm]

TEST_F(Contours, OnTheSlicesEveryVoxelIsThatOfTheBall) {
  ct();
  ContourFile file;
  file.rois = {ball("Mandible", 6, {}, on_slices())};
  file.rois[0].colour = "255\\128\\0";
  const auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size, math::Ijk(kColumns, kRows, kSlices));
  EXPECT_EQ(scan->format, "DICOM contours");
  ASSERT_EQ(scan->label_names.size(), 1U);
  EXPECT_EQ(scan->label_names[0].name, "Mandible");
  EXPECT_NEAR(scan->label_names[0].colour[1], 128.0 / 255, 1e-3);
  EXPECT_NEAR(expect_body(*scan, 1, kRounded, of_ball(6)), 1, 0.01);
  EXPECT_FALSE(says(*scan, "interpolated")) << all_of(*scan);
  EXPECT_TRUE(scan->questions.empty()) << all_of(*scan);
  EXPECT_EQ(scan->series_taken, 1);
  // without a choice the CT is read, and it is said what lies beside it
  const auto usual = read(file, "");
  ASSERT_TRUE(usual.ok());
  EXPECT_TRUE(usual->labels.empty());
  EXPECT_TRUE(says(*usual, "Beside the scan lies a set of contours (RTSTRUCT)")) << all_of(*usual);
}

TEST_F(Contours, AnObliqueScanWithContoursOnItsSlices) {
  ct(askew());
  ContourFile file;
  std::vector<double> at;
  for (int k = 0; k < kSlices; ++k) at.push_back(slice_z(k) - kMiddle.z());
  file.rois = {ball("a", 5, {askew()}, at)};
  const auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_NEAR(expect_body(*scan, 1, kRounded, of_ball(5)), 1, 0.01);
  EXPECT_FALSE(says(*scan, "planes across")) << all_of(*scan);
}

TEST_F(Contours, AKeyholeAndAnInnerRingAreHoles) {
  ct();
  const Sheet flat;
  Roi keyhole{.name = "keyhole", .contours = {}}, ring{.name = "two rings", .contours = {}};
  for (const double s : on_slices()) {
    if (std::abs(s) > 6) continue;
    const Vec3 middle = kMiddle + Vec3(0, 0, s);
    std::vector<Vec3> points = flat.ring(middle, 7), inner = flat.ring(middle, 3, 180, true);
    points.push_back(points.front());  // out along a line, round the hole, and back
    points.insert(points.end(), inner.begin(), inner.end());
    points.push_back(inner.front());
    keyhole.contours.push_back({"CLOSED_PLANAR", points});
    ring.contours.push_back({"CLOSED_PLANAR", flat.ring(middle, 2.5)});
    ring.contours.push_back({"CLOSED_PLANAR", flat.ring(middle, 1)});
  }
  ContourFile file;
  file.rois = {keyhole, ring};
  const auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  const auto tube = [](double in, double out) {
    return [in, out](const Vec3& p) {
      const double r = (p - kMiddle).head<2>().norm(), z = std::abs(p.z() - kMiddle.z());
      // planes at every slice within 6 mm; each stands for its own slice
      return std::min({out - r, r - in, 6 - z});
    };
  };
  expect_body(*scan, 1, kRounded, tube(3, 7));
  expect_body(*scan, 2, kRounded, tube(1, 2.5));
  EXPECT_FALSE(says(*scan, "overlap")) << all_of(*scan);
}

TEST_F(Contours, BetweenTheSlicesTheShapeIsInterpolatedAndThatIsSaid) {
  ct();
  for (const double gap :
       {2.0, 0.8, 0.37}) {  // farther apart than the slices, half a slice aside, nearer
    ContourFile file;
    file.rois = {ball("a", 6, {}, every(gap, -20 + 0.4))};
    const auto scan = read(file);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    // a ball loses at most gap^2 / 8 r between two planes, and what lies beyond the last one
    const double share = expect_body(*scan, 1, 0.5 + gap / 2, of_ball(6));
    EXPECT_NEAR(share, 1, gap > 1 ? 0.05 : 0.02) << gap;
    EXPECT_TRUE(says(*scan,
                     "The contours of a do not lie on all slices of the scan, which are 0.8 "
                     "mm apart"))
        << gap << all_of(*scan);
  }
}

TEST_F(Contours, PlanesAcrossTheVoxels) {
  ct();
  ContourFile file;
  Sheet sagittal;
  sagittal.turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // normal along x
  std::vector<double> at;
  for (int i = 0; i < kColumns; ++i) at.push_back(kOrigin.x() + 0.5 * i - kMiddle.x());
  file.rois = {ball("sagittal", 6, sagittal, at)};
  auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_NEAR(expect_body(*scan, 1, kRounded, of_ball(6)), 1, 0.01);
  EXPECT_TRUE(says(*scan, "The contours of sagittal lie in planes across")) << all_of(*scan);

  file.rois = {ball("oblique", 6, {askew()}, every(0.5))};
  scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_NEAR(expect_body(*scan, 1, 0.6, of_ball(6)), 1, 0.02);
  EXPECT_TRUE(says(*scan, "The contours of oblique lie in planes across")) << all_of(*scan);
}

TEST_F(Contours, WhatHasNoInsideIsNamedAndLeftOut) {
  ct();
  ContourFile file;
  file.rois = {
      ball("bone", 5, {}, on_slices()),
      {.name = "isocentre", .interpreted = "ISOCENTER", .contours = {{"POINT", {kMiddle}}}},
      {.name = "wire",
       .contours = {{"OPEN_PLANAR", {kMiddle, kMiddle + Vec3(1, 0, 0), kMiddle + Vec3(1, 1, 0)}}}},
      {.name = "drawn later", .contours = {}}};
  file.rois[0].contours.push_back({"CLOSED_PLANAR", {kMiddle, kMiddle + Vec3(1, 0, 0)}});
  file.rois[0].contours.push_back(file.rois[0].contours[3]);
  const auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  expect_body(*scan, 1, kRounded, of_ball(5));
  EXPECT_TRUE(
      says(*scan,
           "2 contours of isocentre, wire have no inside (OPEN_PLANAR, POINT) and were left out."))
      << all_of(*scan);
  EXPECT_TRUE(says(*scan,
                   "One contour of bone has fewer than three points, no area or no plane, and was "
                   "left out."))
      << all_of(*scan);
  EXPECT_TRUE(says(*scan, "One contour of bone is a copy of another one and counts once."))
      << all_of(*scan);
  EXPECT_TRUE(
      says(*scan, "3 structures have no voxel and are left out: isocentre, wire and drawn later."))
      << all_of(*scan);
}

TEST_F(Contours, GapsAndEnds) {
  ct();
  // two pieces of one structure: planes at slices 5..9 and 15..19
  Roi pieces{.name = "pieces", .contours = {}};
  const Sheet flat;
  for (const int k : {5, 6, 7, 8, 9, 15, 16, 17, 18, 19})
    pieces.contours.push_back(
        {"CLOSED_PLANAR", flat.ring({kMiddle.x(), kMiddle.y(), slice_z(k)}, 4)});
  // one contour alone stands for its slice
  Roi alone{.name = "alone", .contours = {{"CLOSED_PLANAR", flat.ring({0, 0, slice_z(25)}, 4)}}};
  // reaches out of the scan
  Roi skin{.name = "BODY", .interpreted = "EXTERNAL", .contours = {}};
  skin.contours.push_back({"CLOSED_PLANAR", flat.ring({0, 0, slice_z(27)}, 40)});
  ContourFile file;
  file.rois = {pieces, alone, skin};
  const auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  std::vector<int> slices(kSlices, 0);
  const std::size_t pixels = std::size_t{kColumns} * kRows;
  std::vector<std::size_t> count(static_cast<std::size_t>(kSlices) * 4, 0);
  for (std::size_t v = 0; v < scan->labels.size(); ++v) ++count[v / pixels * 4 + scan->labels[v]];
  for (std::size_t k = 0; k < kSlices; ++k) {
    EXPECT_EQ(count[4 * k + 1] > 0, (k >= 5 && k <= 9) || (k >= 15 && k <= 19)) << k;
    EXPECT_EQ(count[4 * k + 2] > 0, k == 25) << k;
    EXPECT_EQ(count[4 * k + 3], k == 27 ? pixels : 0U) << k;
  }
  EXPECT_TRUE(says(*scan, "Contours of pieces lie more than 1.5 times as far apart"))
      << all_of(*scan);
  EXPECT_TRUE(says(*scan, "Contours of BODY reach beyond the scan")) << all_of(*scan);
  EXPECT_EQ(scan->label_names[2].meaning, "Skin");
}

TEST_F(Contours, TheFrameOfReferenceIsThatOfTheScan) {
  ct();
  ContourFile file;
  file.rois = {ball("a", 5, {}, on_slices()), ball("b", 3, {}, on_slices())};
  file.rois[1].frame = "1.2.6";
  const auto one = read(file);
  ASSERT_TRUE(one.ok()) << one.error().text;
  EXPECT_TRUE(says(*one, "1 of 2 structures lie in another frame of reference")) << all_of(*one);
  EXPECT_EQ(one->label_names.size(), 1U);
  file.rois[0].frame = "1.2.6";
  const auto both = read(file);
  ASSERT_TRUE(both.ok()) << both.error().text;
  ASSERT_EQ(both->questions.size(), 1U) << all_of(*both);
  EXPECT_EQ(both->questions[0].ask, Ask::doubt);
  EXPECT_NE(both->questions[0].text.find("rs.dcm: its contours lie in another frame of reference"),
            std::string::npos);
}

TEST_F(Contours, RefusedInOneSentence) {
  ContourFile file;
  file.rois = {ball("a", 5, {}, every(1))};
  const auto alone = read(file, "");
  ASSERT_FALSE(alone.ok());
  EXPECT_NE(alone.error().text.find("rs.dcm: holds contours (RTSTRUCT) and no voxels"),
            std::string::npos)
      << alone.error().text;
  ct();
  for (const char* bad : {"1\\2\\3\\4", "1\\2\\x", "1\\2\\1e999"}) {
    file.data_of_first = bad;
    const auto scan = read(file);
    ASSERT_FALSE(scan.ok()) << bad;
    EXPECT_NE(scan.error().text.find("rs.dcm: a contour of a is damaged"), std::string::npos)
        << scan.error().text;
  }
  file.rois = {{.name = "a", .contours = {}}};
  const auto none = read(file);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().text.find("without a contour"), std::string::npos) << none.error().text;
  // cut off at any place: an error, never half of the structures
  file.data_of_first.clear();
  file.rois = {ball("a", 5, {}, on_slices())};
  const std::string whole = file.bytes();
  for (std::size_t size = 400; size < whole.size(); size += whole.size() / 23) {
    std::ofstream(path("rs.dcm"), std::ios::binary) << whole.substr(0, size);
    NoProgress progress;
    ReadOptions options;
    options.series = "#2";
    const auto cut = read_scan(folder.string(), options, progress);
    EXPECT_FALSE(cut.ok()) << size;
  }
}

TEST_F(Contours, AContourOfManyPointsIsReadWhole) {
  ct();
  ContourFile file;
  Roi roi{.name = "fine", .contours = {}};
  for (const double s : on_slices())
    if (std::abs(s) < 2)
      roi.contours.push_back({"CLOSED_PLANAR", Sheet().ring(kMiddle + Vec3(0, 0, s), 5, 9000)});
  file.rois = {roi};
  const auto scan = read(file);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  expect_body(*scan, 1, 1e-4, [](const Vec3& p) {
    return std::min(5 - (p - kMiddle).head<2>().norm(), 2 - std::abs(p.z() - kMiddle.z()));
  });
}

}  // namespace
}  // namespace burr::io
