// DICOM segmentations that burr writes: read again by burr, every voxel is compared. Programs of others read them in
// tests/io/segments_elsewhere.py.
#include "burr/io/write/write_dicom_seg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "burr/io/export_part.h"
#include "burr/io/read/dicom_seg.h"
#include "burr/io/read/read_scan.h"
#include "io/dicom_writer.h"
#include "io/folder_of_test.h"
#include "support/data.h"
#include "surface/surface_bones.h"

namespace burr::io {
namespace {

using math::Vec3;

class WriteDicomSeg : public test::FolderTest {
 protected:
  // Three labels with gaps between their numbers, on a grid askew with three spacings; no label in slices 0, 1, 6 and
  // 11, and label 200 alone in slice 10.
  static Scan labels_askew() {
    Scan scan;
    scan.size = {19, 14, 12};
    scan.spacing_mm = {0.4, 0.55, 1.0 / 3};
    scan.axes = test::askew({1, 1, 1}).frame.q.toRotationMatrix();
    scan.origin_mm = {-31.25, 120.0 + 1.0 / 7, 47};
    for (int k = 0; k < 12; ++k)
      for (int j = 0; j < 14; ++j)
        for (int i = 0; i < 19; ++i)
          scan.labels.push_back(static_cast<std::uint8_t>(label(i, j, k)));
    scan.label_names = {{.value = 2, .name = "Mandible", .colour = {1, 0.85F, 0}},
                        {.value = 5, .name = "H\xC3\xB6rnerv", .colour = {0.2F, 0.5F, 0.9F}},
                        {.value = 7, .name = "Stapes"}};
    return scan;
  }
  static int label(int i, int j, int k) {
    if (k < 2 || k == 6 || k == 11) return 0;
    if (k == 10) return i == 18 && j == 13 ? 200 : 0;
    return (i * i + 3 * j + 5 * k) % 7 == 0 ? 5 : i > 4 && i < 15 && j > 2 ? 2 : 0;
  }
  Result<Scan> read(const std::string& name, bool study = false) const {
    NoProgress progress;
    ReadOptions options;
    options.study = study;
    return read_scan(path(name), options, progress);
  }
  Result<SegWritten> write(const Scan& scan, const SegOptions& options = {},
                           const std::string& name = "a.dcm") const {
    NoProgress progress;
    return write_dicom_seg(scan, path(name), options, progress);
  }
  static bool says(const std::vector<std::string>& notices, const std::string& words) {
    return std::any_of(notices.begin(), notices.end(),
                       [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }
  // What is read back is what was written, voxel by voxel, in its place. Slices at the ends without a label are not in
  // the file.
  static void expect_same(const Scan& wrote, const SegWritten& written, const Scan& got) {
    ASSERT_EQ(got.size.head<2>(), wrote.size.head<2>());
    EXPECT_LT((got.spacing_mm - wrote.spacing_mm).norm(), 1e-6);
    EXPECT_LT((got.axes - wrote.axes).norm(), 1e-9);
    const Vec3 shift = wrote.axes.transpose() * (got.origin_mm - wrote.origin_mm);
    const int from = static_cast<int>(std::lround(shift.z() / wrote.spacing_mm.z()));
    EXPECT_LT((shift - Vec3(0, 0, from * wrote.spacing_mm.z())).norm(), 1e-6);
    const std::size_t slice = wrote.labels.size() / static_cast<std::size_t>(wrote.size.z());
    std::array<int, 256> number{};  // in the file, by label
    for (const SegSegment& one : written.segments)
      number[static_cast<std::size_t>(one.label)] = one.number;
    std::size_t wrong = 0;
    for (int k = 0; k < wrote.size.z(); ++k)
      for (std::size_t n = 0; n < slice; ++n) {
        const int label = wrote.labels[static_cast<std::size_t>(k) * slice + n];
        const bool there = k >= from && k < from + got.size.z();
        const int back = there ? got.labels[static_cast<std::size_t>(k - from) * slice + n] : 0;
        wrong += back != number[static_cast<std::size_t>(label)] ? 1 : 0;
        wrong += label != 0 && number[static_cast<std::size_t>(label)] == 0 ? 1 : 0;
      }
    EXPECT_EQ(wrong, 0U);
    EXPECT_FALSE(says(got.notices, "overlap"));
    ASSERT_EQ(got.label_names.size(), written.segments.size());
    for (std::size_t n = 0; n < written.segments.size(); ++n) {
      EXPECT_EQ(got.label_names[n].value, written.segments[n].number);
      EXPECT_EQ(got.label_names[n].name, written.segments[n].name);
    }
  }
};

TEST_F(WriteDicomSeg, ComesBackToTheBit) {
  const Scan scan = labels_askew();
  const auto written = write(scan);
  ASSERT_TRUE(written.ok()) << written.error().text;
  ASSERT_EQ(written->segments.size(), 3U);
  EXPECT_EQ(written->segments[0].name, "Mandible");
  EXPECT_EQ(written->segments[2].name, "label 200");
  EXPECT_EQ(written->segments[2].number, 3);
  EXPECT_EQ(written->segments[2].label, 200);
  EXPECT_EQ(written->segments[2].voxels, 1U);
  // seven slices of each of the two, and one: no empty frame
  EXPECT_EQ(written->frames, 15U);
  EXPECT_TRUE(says(written->notices, "no voxel has these labels: Stapes"));
  EXPECT_TRUE(says(written->notices, "no table says what they are: Mandible, H\xC3\xB6rnerv"));
  EXPECT_TRUE(says(written->notices, "names no patient"));
  EXPECT_EQ(files(), 1);
  const auto got = read("a.dcm");
  ASSERT_TRUE(got.ok()) << got.error().text;
  EXPECT_EQ(got->format, "DICOM segmentation");
  EXPECT_EQ(got->size.z(), 9) << "slices 2 to 10";
  EXPECT_TRUE(says(got->notices, "no frame for 1 of 9 slices"));
  expect_same(scan, *written, *got);
  EXPECT_EQ(got->label_names[0].meaning, "") << "the general code says nothing";
  for (std::size_t n = 0; n < 2; ++n)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(got->label_names[n].colour[c], scan.label_names[n].colour[c], 0.01);
}

TEST_F(WriteDicomSeg, ALabelMapKeepsItsNumbersAndHasABackground) {
  const Scan scan = labels_askew();
  SegOptions options;
  options.kind = SegKind::label_map;
  options.codes[2].type = DicomCode{"91609006", "SCT", "Mandible"};
  const auto written = write(scan, options);
  ASSERT_TRUE(written.ok()) << written.error().text;
  ASSERT_EQ(written->segments.size(), 3U);
  for (const SegSegment& one : written->segments) EXPECT_EQ(one.number, one.label);
  EXPECT_EQ(written->frames, 9U) << "slices 2 to 10, also the empty one between them";
  const auto got = read("a.dcm");
  ASSERT_TRUE(got.ok()) << got.error().text;
  expect_same(scan, *written, *got);
  EXPECT_FALSE(says(got->notices, "no frame")) << "each slice has its frame";
  EXPECT_EQ(got->label_names[0].meaning, "Mandible SCT 91609006");
  for (std::size_t n = 0; n < 2; ++n)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(got->label_names[n].colour[c], scan.label_names[n].colour[c], 0.01);
  const std::string file = content(path("a.dcm"));
  for (const char* words : {"1.2.840.10008.5.1.4.1.1.66.7", "LABELMAP", "Background", "125040"})
    EXPECT_NE(file.find(words), std::string::npos) << words;
  // as a binary segmentation it is another file with the same voxels
  ASSERT_TRUE(write(scan, {}, "b.dcm").ok());
  const auto bits = read("b.dcm");
  ASSERT_TRUE(bits.ok());
  ASSERT_EQ(bits->labels.size(), got->labels.size());
  std::size_t different = 0;
  for (std::size_t v = 0; v < got->labels.size(); ++v)
    different += (bits->labels[v] != 0) != (got->labels[v] != 0) ? 1 : 0;
  EXPECT_EQ(different, 0U);
}

TEST_F(WriteDicomSeg, ColoursThereAndBack) {
  for (const std::array<float, 3> rgb : {std::array<float, 3>{0, 0, 0},
                                         {1, 1, 1},
                                         {1, 0, 0},
                                         {0, 1, 0},
                                         {0, 0, 1},
                                         {0.02F, 0.5F, 0.93F}}) {
    const auto back = srgb_of_dicom_lab(dicom_lab_of_srgb(rgb));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], rgb[c], 0.01) << rgb[0] << rgb[1];
  }
}

// The bone of formulas, on its grid: what .seg.nrrd holds, .dcm holds too.
TEST_F(WriteDicomSeg, BoneAndItsRemovedPart) {
  volume::TissueTable tissues;
  tissues.tissues.resize(4);
  tissues.tissues[1] = {.name = "Bone", .colour = {1, 0.85F, 0}, .label = 12};
  tissues.tissues[2] = {.name = "Malleus", .label = 7};
  tissues.tissues[3] = {.name = "Nerve", .kind = volume::TissueKind::soft, .label = 2};
  const auto bone_with = [&](double hole) {
    std::vector<volume::Field> field;
    std::vector<volume::TissueId> tissue;
    for (int k = 0; k < 21; ++k)
      for (int j = 0; j < 30; ++j)
        for (int i = 0; i < 27; ++i) {
          const Vec3 p(i, j, k);
          const double depth =
              std::min(10.2 - (p - Vec3(13, 14, 10)).norm(), (p - Vec3(13, 14, 19)).norm() - hole);
          const bool nerve = i == 13 && j == 14 && k < 8;
          field.push_back(nerve ? volume::Field{0} : volume::field_from_depth(depth));
          tissue.push_back(nerve ? 3 : i < 9 ? 2 : 1);
        }
    return volume::bone_from_arrays(test::askew({27, 30, 21}), tissues, field, tissue, {}, 0);
  };
  const auto before = bone_with(0), now = bone_with(6);
  NoProgress progress;
  for (const Part part : {Part::bone, Part::removed}) {
    ExportOptions options;
    options.part = part;
    const auto dicom = export_part(*before, *now, path("a.dcm"), options, progress);
    const auto nrrd = export_part(*before, *now, path("a.seg.nrrd"), options, progress);
    ASSERT_TRUE(dicom.ok()) << dicom.error().text;
    ASSERT_TRUE(nrrd.ok());
    const auto got = read("a.dcm"), truth = read("a.seg.nrrd");
    ASSERT_TRUE(got.ok()) << got.error().text;
    ASSERT_TRUE(truth.ok());
    ASSERT_GE(dicom->segments.size(), 2U);
    SegWritten written;
    written.segments = dicom->segments;
    expect_same(*truth, written, *got);
  }
}

TEST_F(WriteDicomSeg, PatientAndStudyOfTheScan) {
  test::DicomSlice slice;
  slice.set(0x00080005, "CS", "ISO_IR 100")
      .set(0x00080020, "DA", "20190307")
      .set(0x00080050, "SH", "A-17")
      .set(0x00100010, "PN", "M\xFCller^Anna")
      .set(0x00100020, "LO", "4711")
      .set(0x00100030, "DA", "19700102")
      .set(0x00100040, "CS", "F")
      .set(0x0020000D, "UI", "1.2.826.77.1")
      .set(0x00200052, "UI", "1.2.826.77.2")
      .set(0x00200010, "SH", "S1");
  std::filesystem::create_directory(path("ct"));
  for (int k = 0; k < 4; ++k) slice.at(k, k + 1).write(path("ct/" + std::to_string(k) + ".dcm"));
  const auto silent = read("ct");
  ASSERT_TRUE(silent.ok()) << silent.error().text;
  EXPECT_FALSE(silent->study.has_value()) << "read without being asked for";
  const auto ct = read("ct", true);
  ASSERT_TRUE(ct.ok()) << ct.error().text;
  ASSERT_TRUE(ct->study.has_value());
  EXPECT_EQ(ct->study->values.at(0x00100010), "M\xFCller^Anna");
  SegOptions options;
  options.study = ct->study;
  const auto written = write(labels_askew(), options);
  ASSERT_TRUE(written.ok()) << written.error().text;
  EXPECT_FALSE(says(written->notices, "names no patient"));
  const auto got = read("a.dcm", true);
  ASSERT_TRUE(got.ok()) << got.error().text;
  ASSERT_TRUE(got->study.has_value());
  EXPECT_EQ(got->study->characters, "ISO_IR 192");
  auto expected = ct->study->values;
  expected[0x00100010] = "M\xC3\xBCller^Anna";
  for (const auto& [tag, text] : expected) {
    ASSERT_EQ(got->study->values.count(tag), 1U) << std::hex << tag;
    EXPECT_EQ(got->study->values.at(tag), text) << std::hex << tag;
  }
  // a scan that states no frame of reference: a new one, and a word about it
  options.study->values.erase(kFrameOfReference);
  const auto lost = write(labels_askew(), options, "b.dcm");
  ASSERT_TRUE(lost.ok()) << lost.error().text;
  EXPECT_TRUE(says(lost->notices, "no Frame of Reference UID"));
  // without a scan nothing of a patient
  ASSERT_TRUE(write(labels_askew(), {}, "c.dcm").ok());
  const auto nobody = read("c.dcm", true);
  ASSERT_TRUE(nobody.ok());
  EXPECT_EQ(nobody->study->values.at(0x00100010), "");
  EXPECT_EQ(nobody->study->values.at(0x00100020), "");
  EXPECT_EQ(content(path("c.dcm")).find("ller^Anna"), std::string::npos);
}

TEST_F(WriteDicomSeg, UidsAndCodes) {
  std::set<std::string> seen;
  for (int n = 0; n < 100; ++n) {
    const auto uid = new_uid("");
    ASSERT_TRUE(uid.ok());
    EXPECT_TRUE(uid->starts_with("2.25.")) << *uid;
    EXPECT_LE(uid->size(), 64U);
    EXPECT_NE((*uid)[5], '0');
    EXPECT_EQ(uid->find_first_not_of("0123456789."), std::string::npos);
    seen.insert(*uid);
  }
  EXPECT_EQ(seen.size(), 100U);
  for (const char* root : {"1.2.826.0.1.3680043.9.1234", "1.0.2"}) {
    const auto uid = new_uid(root);
    ASSERT_TRUE(uid.ok()) << root;
    EXPECT_TRUE(uid->starts_with(std::string(root) + "."));
    EXPECT_LE(uid->size(), 64U);
  }
  for (const char* root : {"x", "1", "1.2.", ".1.2", "1..2", "1.02.3", "1.2 3",
                           "1.2.3.4.5.6.7.8.9.10.11.12.13.14.15.16.17"}) {
    const auto uid = new_uid(root);
    ASSERT_FALSE(uid.ok()) << root;
    EXPECT_NE(uid.error().text.find("is no root of UIDs"), std::string::npos);
  }
  SegOptions options;
  options.uid_root = "1.2.826.0.1.3680043.9.1234";
  options.codes[2] = {{}, DicomCode{"91609006", "SCT", "Mandible"}};
  options.by = SegmentedBy::manual;
  const auto written = write(labels_askew(), options);
  ASSERT_TRUE(written.ok()) << written.error().text;
  EXPECT_TRUE(says(written->notices, "no table says what they are: H\xC3\xB6rnerv, label 200"));
  const auto got = read("a.dcm", true);
  ASSERT_TRUE(got.ok()) << got.error().text;
  EXPECT_EQ(got->label_names[0].meaning, "Mandible SCT 91609006");
  EXPECT_EQ(got->label_names[1].meaning, "");
  EXPECT_TRUE(got->study->values.at(kStudyUid).starts_with("1.2.826.0.1.3680043.9.1234."));
}

TEST_F(WriteDicomSeg, RefusedInOneSentence) {
  const auto refused = [&](const Result<SegWritten>& result, const char* words) {
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().text.find(words), std::string::npos) << result.error().text;
    EXPECT_EQ(files(), 0) << "a file was left behind";
  };
  Scan grey = labels_askew();
  grey.values.assign(grey.labels.size(), 0.0F);
  grey.labels.clear();
  refused(write(grey), "grey values only");
  Scan empty = labels_askew();
  std::fill(empty.labels.begin(), empty.labels.end(), std::uint8_t{0});
  refused(write(empty), "no voxel has a label");
  Scan wide = labels_askew();
  wide.size = {70000, 1, 1};
  wide.labels.assign(70000, 1);
  refused(write(wide), "at most 65535 pixels");
  SegOptions root;
  root.uid_root = "mine";
  refused(write(labels_askew(), root), "`uid_root`: mine is no root");
  SegOptions letters;
  letters.study = DicomStudy{"ISO_IR 9999", {{0x00100010, "A^B"}}};
  refused(write(labels_askew(), letters), "leave the patient out, by `io::SegOptions::study`");
  SegOptions frame;
  frame.study = DicomStudy{"", {{kFrameOfReference, "no UID at all"}}};
  refused(write(labels_askew(), frame), "frame of reference");
  class Impatient final : public Progress {
   public:
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  } impatient;
  const auto stopped = write_dicom_seg(labels_askew(), path("a.dcm"), {}, impatient);
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().trouble, Trouble::interrupted);
  EXPECT_EQ(files(), 0);
  ::setenv("BURR_SEG", path("none").c_str(), 1);
  refused(write(labels_askew()), "burr-seg");
  ::unsetenv("BURR_SEG");
}

// Maps of labels that people drew and programs found.
class RealLabels : public WriteDicomSeg, public testing::WithParamInterface<const char*> {};

TEST_P(RealLabels, ComeBackToTheBit) {
  BURR_NEEDS_DATA(GetParam());
  NoProgress progress;
  const auto scan = read_scan(test::data_dir() / GetParam(), {}, progress);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_FALSE(scan->labels.empty());
  const auto written = write(*scan);
  ASSERT_TRUE(written.ok()) << written.error().text;
  const auto got = read("a.dcm");
  ASSERT_TRUE(got.ok()) << got.error().text;
  expect_same(*scan, *written, *got);
}
INSTANTIATE_TEST_SUITE_P(Maps, RealLabels,
                         testing::Values("temporal_bone/LT151_256.seg.nrrd",
                                         "temporal_bone/RT147_256.seg.nrrd",
                                         "skull_mask/Skull.nrrd",
                                         "spine_lumbar/example_seg_dicom.nii.gz",
                                         "spine_lumbar/example_seg_fast_force_split.nii.gz"));

}  // namespace
}  // namespace burr::io
