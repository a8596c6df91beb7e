#include "burr/io/read/read_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/folder_of_test.h"
#include "support/data.h"

namespace burr::io {
namespace {

using math::Ijk;
using math::Vec3;

Result<Scan> read(const std::string& relative, const ReadOptions& options = {}) {
  NoProgress progress;
  return read_scan(test::data_dir() / relative, options, progress);
}

bool says(const Scan& scan, const char* words) {
  return std::any_of(scan.notices.begin(), scan.notices.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

float at(const Scan& scan, int i, int j, int k) {
  return scan.values[static_cast<std::size_t>(i) +
                     static_cast<std::size_t>(scan.size.x()) *
                         (static_cast<std::size_t>(j) +
                          static_cast<std::size_t>(scan.size.y()) * static_cast<std::size_t>(k))];
}

Vec3 world_mm(const Scan& scan, const Vec3& ijk) {
  return scan.origin_mm + scan.axes * ijk.cwiseProduct(scan.spacing_mm);
}

// The value at a position in the world, from the nearest voxel.
float sample(const Scan& scan, const Vec3& p_mm) {
  const Vec3 ijk = (scan.axes.transpose() * (p_mm - scan.origin_mm)).cwiseQuotient(scan.spacing_mm);
  const Ijk n(static_cast<int>(std::lround(ijk.x())), static_cast<int>(std::lround(ijk.y())),
              static_cast<int>(std::lround(ijk.z())));
  if ((n.array() < 0).any() || (n.array() >= scan.size.array()).any()) return NAN;
  return at(scan, n.x(), n.y(), n.z());
}

void expect_rotation(const Scan& scan) {
  EXPECT_NEAR(scan.axes.determinant(), 1, 1e-9);
  EXPECT_LT((scan.axes.transpose() * scan.axes - math::Mat3::Identity()).norm(), 1e-9);
}

struct Expected {
  const char* path;
  Ijk size;
  Vec3 spacing_mm;
  bool labels, hounsfield;
};

class EveryDataSet : public testing::TestWithParam<Expected> {};

TEST_P(EveryDataSet, LoadsWithItsGeometry) {
  const Expected& expected = GetParam();
  BURR_NEEDS_DATA(expected.path);
  const auto scan = read(expected.path);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size, expected.size);
  EXPECT_LT((scan->spacing_mm - expected.spacing_mm).cwiseAbs().maxCoeff(), 1e-3)
      << scan->spacing_mm.transpose();
  EXPECT_EQ(scan->values.empty(), expected.labels);
  EXPECT_EQ(scan->hounsfield, expected.hounsfield);
  EXPECT_EQ(std::max(scan->values.size(), scan->labels.size()),
            static_cast<std::size_t>(scan->size.prod()));
  expect_rotation(*scan);
}

INSTANTIATE_TEST_SUITE_P(
    Io, EveryDataSet,
    testing::Values(
        Expected{
            "skull_phantom/std_5mm_jpegll", {512, 512, 28}, {0.451172, 0.451172, 5}, false, true},
        Expected{"head_ct/ct_example.nii.gz", {256, 256, 26}, {1.25, 1.25, 4}, false, true},
        Expected{"headsq/headsq/quarter.nhdr", {64, 64, 93}, {3.2, 3.2, 1.5}, false, false},
        Expected{"headsq/headsq_hu.mha", {64, 64, 93}, {3.2, 3.2, 1.5}, false, true},
        Expected{"skull_mask/Skull.nrrd", {160, 232, 160}, {1, 0.898437, 0.898437}, true, false},
        Expected{
            "jaw_cbct/jaw_cbct_half_0.4mm.nii.gz", {300, 300, 225}, {0.4, 0.4, 0.4}, false, true},
        Expected{"tooth_microct/tooth.nhdr", {103, 94, 161}, {1, 1, 1}, false, false},
        Expected{"spine_thorax/LIDC-IDRI-0314_spine_crop.nii.gz",
                 {210, 210, 275},
                 {0.78125, 0.78125, 1},
                 false,
                 true},
        Expected{"spine_thorax/dicom_implicit_3slices",
                 {512, 512, 3},
                 {0.78125, 0.78125, 1},
                 false,
                 true},
        Expected{"spine_lumbar/example_ct.nii.gz", {122, 101, 112}, {3, 3, 3}, false, true},
        Expected{
            "spine_lumbar/example_ct_dicom", {512, 512, 20}, {0.976562, 0.976562, 2}, false, true},
        Expected{"spine_lumbar/example_seg_dicom.nii.gz",
                 {512, 512, 20},
                 {0.976562, 0.976562, 2},
                 true,
                 false},
        Expected{"mouse_skull/35_mic_23strain_mus_template_UCHAR.seg.nrrd",
                 {349, 640, 338},
                 {0.035278, 0.035278, 0.035278},
                 true,
                 false},
        Expected{"temporal_bone/LT151_256.seg.nrrd", {256, 256, 256}, {0.2, 0.2, 0.2}, true, false},
        Expected{"temporal_bone/RT143_512.seg.nrrd",
                 {512, 512, 505},
                 {0.096099, 0.096099, 0.09601},
                 true,
                 false}));

TEST(ReadScan, OfAWholeStudyTakesTheThinBoneSeriesAndSaysSo) {
  BURR_NEEDS_DATA("skull_phantom");
  const auto scan = read("skull_phantom");
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size, Ijk(512, 512, 140));
  EXPECT_NEAR(scan->spacing_mm.z(), 1, 1e-6);
  EXPECT_TRUE(says(*scan, "6 series found"));
  ASSERT_EQ(scan->series.size(), 6U);
  EXPECT_NE(scan->series[static_cast<std::size_t>(scan->series_taken)].find("140 pictures"),
            std::string::npos);
}

TEST(ReadScan, TakesTheSeriesThatIsAskedFor) {
  BURR_NEEDS_DATA("skull_phantom");
  ReadOptions options;
  options.series = "no such series";
  const auto none = read("skull_phantom", options);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().trouble, Trouble::usage);
  EXPECT_NE(none.error().text.find("#5"), std::string::npos) << "lists what there is";
  options.series = "#5";
  const auto thick = read("skull_phantom", options);
  ASSERT_TRUE(thick.ok()) << thick.error().text;
  EXPECT_EQ(thick->size.z(), 28);
}

TEST(ReadScan, UndoesAGantryTilt) {
  BURR_NEEDS_DATA("skull_phantom/tilt_minus18.5_j2k");
  const auto tilted = read("skull_phantom/tilt_minus18.5_j2k");
  ASSERT_TRUE(tilted.ok()) << tilted.error().text;
  EXPECT_TRUE(says(*tilted, "gantry tilt of 18.5 degrees"));
  expect_rotation(*tilted);
  // along the normal: the table moved by 2.5 mm
  EXPECT_NEAR(tilted->spacing_mm.z(), 2.5 * std::cos(18.5 * M_PI / 180), 2e-3);
}

// The phantom does not move between its scans, so the tilted scan and the straight one show the
// same plastic at the same place in the world.
TEST(ReadScan, ATiltedScanLiesWhereTheStraightOneDoes) {
  BURR_NEEDS_DATA("corpus/derived/dicom/series_gantry_tilt");
  const auto scan = read("corpus/derived/dicom/series_gantry_tilt");
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(says(*scan, "18.5 degrees"));
  const auto one = read("corpus/derived/dicom/series_gantry_tilt/01.dcm");
  const auto last = read("corpus/derived/dicom/series_gantry_tilt/08.dcm");
  ASSERT_TRUE(one.ok() && last.ok());
  for (const Scan* slice : {&*one, &*last}) {
    double sum = 0;
    int n = 0;
    for (int j = 4; j < 28; ++j)
      for (int i = 4; i < 28; ++i) {
        const float there = sample(*scan, world_mm(*slice, Vec3(i, j, 0)));
        ASSERT_FALSE(std::isnan(there));
        sum += std::abs(there - at(*slice, i, j, 0));
        ++n;
      }
    // nearest voxel of a resampled plane: at most half a voxel of the noise pattern
    EXPECT_LT(sum / n, 200);
  }
}

TEST(ReadScan, OrdersSlicesByPositionNotByName) {
  BURR_NEEDS_DATA("corpus/derived/dicom/series_ok_reversed_names");
  const auto scan = read("corpus/derived/dicom/series_ok_reversed_names");
  const auto first = read("corpus/derived/dicom/series_ok_reversed_names/08.dcm");
  const auto last = read("corpus/derived/dicom/series_ok_reversed_names/01.dcm");
  ASSERT_TRUE(scan.ok() && first.ok() && last.ok());
  EXPECT_EQ(scan->size, Ijk(32, 32, 8));
  EXPECT_NEAR(scan->spacing_mm.z(), 2, 1e-9);
  const bool up = first->origin_mm.z() < last->origin_mm.z();
  EXPECT_TRUE(scan->origin_mm.isApprox(up ? first->origin_mm : last->origin_mm));
  EXPECT_EQ(at(*scan, 5, 9, 0), at(up ? *first : *last, 5, 9, 0));
  EXPECT_EQ(at(*scan, 5, 9, 7), at(up ? *last : *first, 5, 9, 0));
}

TEST(ReadScan, RescalesEverySliceByItself) {
  BURR_NEEDS_DATA("corpus/derived/dicom/series_mixed_slope");
  const auto scan = read("corpus/derived/dicom/series_mixed_slope");
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  for (int n = 1; n <= 8; ++n) {
    const auto slice =
        read("corpus/derived/dicom/series_mixed_slope/0" + std::to_string(n) + ".dcm");
    ASSERT_TRUE(slice.ok());
    EXPECT_EQ(sample(*scan, world_mm(*slice, Vec3(3, 4, 0))), at(*slice, 3, 4, 0));
  }
}

TEST(ReadScan, SaysWhereSlicesAreMissing) {
  BURR_NEEDS_DATA("corpus/dicom_series/dicom2nifti/failing/sliceincrement/002");
  const auto scan = read("corpus/dicom_series/dicom2nifti/failing/sliceincrement/002");
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(says(*scan, "unevenly spaced"));
  EXPECT_NEAR(scan->spacing_mm.z(), 0.778, 0.1);
}

TEST(ReadScan, OneSliceEveryTransferSyntaxOneTruth) {
  const std::string folder = "corpus/dicom/ct1_all_syntaxes/CTImage.dcm_";
  BURR_NEEDS_DATA(folder + "LittleEndianExplicitTransferSyntax_1.2.840.10008.1.2.1.dcm");
  const auto truth = read(folder + "LittleEndianExplicitTransferSyntax_1.2.840.10008.1.2.1.dcm");
  ASSERT_TRUE(truth.ok());
  for (const char* lossless :
       {"BigEndianExplicitTransferSyntax_1.2.840.10008.1.2.2.dcm",
        "DeflatedExplicitVRLittleEndianTransferSyntax_1.2.840.10008.1.2.1.99.dcm",
        "JPEG2000LosslessOnlyTransferSyntax_1.2.840.10008.1.2.4.90.dcm",
        "JPEGLSLosslessTransferSyntax_1.2.840.10008.1.2.4.80.dcm",
        "JPEGProcess14SV1TransferSyntax_1.2.840.10008.1.2.4.70.dcm",
        "JPEGProcess14TransferSyntax_1.2.840.10008.1.2.4.57.dcm",
        "LittleEndianImplicitTransferSyntax_1.2.840.10008.1.2.dcm",
        "RLELosslessTransferSyntax_1.2.840.10008.1.2.5.dcm"}) {
    const auto scan = read(folder + lossless);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_EQ(scan->values, truth->values) << lossless;
  }
  // error of each lossy format, in its own steps; 8 bit have 256 of them
  struct Lossy {
    const char* name;
    double step, mean, most;
  };
  for (const Lossy& lossy :
       {Lossy{"JPEGLSLossyTransferSyntax_1.2.840.10008.1.2.4.81.dcm", 1, 1, 1},
        {"JPEG2000TransferSyntax_1.2.840.10008.1.2.4.91.dcm", 1, 1, 8},
        {"JPEGProcess2_4TransferSyntax_1.2.840.10008.1.2.4.51.dcm", 2, 2, 20},
        {"JPEGProcess6_8TransferSyntax_1.2.840.10008.1.2.4.53.dcm", 2, 2, 20},
        {"JPEGProcess10_12TransferSyntax_1.2.840.10008.1.2.4.55.dcm", 2, 2, 20},
        {"JPEGProcess1TransferSyntax_1.2.840.10008.1.2.4.50.dcm", 32.2, 0.5, 2}}) {
    const auto scan = read(folder + lossy.name);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    ASSERT_EQ(scan->values.size(), truth->values.size());
    EXPECT_TRUE(scan->hounsfield);
    double sum = 0, most = 0;
    for (std::size_t v = 0; v < scan->values.size(); ++v) {
      const double off = std::abs(scan->values[v] - truth->values[v]);
      sum += off;
      most = std::max(most, off);
    }
    EXPECT_LE(sum / static_cast<double>(scan->values.size()), lossy.mean * lossy.step)
        << lossy.name;
    EXPECT_LE(most, lossy.most * lossy.step) << lossy.name;
  }
  EXPECT_EQ(*std::min_element(truth->values.begin(), truth->values.end()), -1024)
      << "-3024 around the circle is air";
  EXPECT_TRUE(says(*truth, "-1024 HU"));
}

TEST(ReadScan, TurnsObliqueNiftiIntoARotation) {
  BURR_NEEDS_DATA("corpus/derived/nifti/sform_oblique30.nii");
  const auto straight = read("corpus/derived/nifti/ok.nii");
  const auto oblique = read("corpus/derived/nifti/sform_oblique30.nii");
  ASSERT_TRUE(straight.ok() && oblique.ok());
  expect_rotation(*oblique);
  // the first axis is the axis of rotation; the others are at 30 degrees to the world's
  EXPECT_NEAR(std::abs(oblique->axes(0, 0)), 1, 1e-6);
  EXPECT_NEAR(std::abs(oblique->axes(2, 1)), 0.5, 1e-6);
  EXPECT_NEAR(std::abs(oblique->axes(1, 1)), std::sqrt(0.75), 1e-6);
  EXPECT_EQ(oblique->values, straight->values) << "the voxels are not touched";
}

TEST(ReadScan, ByteOrderPackingAndWrappingChangeNothing) {
  BURR_NEEDS_DATA("corpus/derived/nifti/ok.nii");
  for (const auto& [one, other] : std::vector<std::pair<std::string, std::string>>{
           {"nifti/ok.nii", "nifti/ok_bigendian.nii"},
           {"nifti/ok.nii", "nifti/nifti2_ok.nii"},
           {"nrrd/ok.nrrd", "nrrd/ok_gzip.nrrd"},
           {"nrrd/ok.nrrd", "nrrd/ok_big_endian.nrrd"},
           {"nrrd/ok.nrrd", "nrrd/ok_crlf.nrrd"},
           {"metaimage/ok.mha", "metaimage/ok_zlib.mha"},
           {"metaimage/ok.mha", "metaimage/ok_msb.mha"},
           {"metaimage/ok.mha", "nrrd/ok.nrrd"}}) {
    const auto a = read("corpus/derived/" + one), b = read("corpus/derived/" + other);
    ASSERT_TRUE(a.ok() && b.ok()) << one << " " << other;
    EXPECT_EQ(a->values, b->values) << other;
    if (one.substr(0, 3) == other.substr(0, 3) && other != "nifti/nifti2_ok.nii") {  // has no sform
      EXPECT_LT((world_mm(*a, Vec3(3, 4, 5)) - world_mm(*b, Vec3(3, 4, 5))).norm(), 1e-4) << other;
    }
  }
}

TEST(ReadScan, RasIsTurnedIntoLps) {
  BURR_NEEDS_DATA("corpus/derived/nrrd/ok_RAS.nrrd");
  const auto lps = read("corpus/derived/nrrd/ok.nrrd"),
             ras = read("corpus/derived/nrrd/ok_RAS.nrrd");
  ASSERT_TRUE(lps.ok() && ras.ok());
  const Vec3 p = world_mm(*lps, Vec3(2, 3, 4));
  EXPECT_EQ(sample(*lps, p), sample(*ras, Vec3(-p.x(), -p.y(), p.z())));
}

// The .nhdr calls its space left-handed, the .mha rotates the same voxels the other way: so they
// show the head mirrored left to right, and each must be kept as its header says.
TEST(ReadScan, ALeftHandedGridIsMirroredNotTurned) {
  BURR_NEEDS_DATA("headsq/headsq/quarter.nhdr");
  const auto nrrd = read("headsq/headsq/quarter.nhdr");
  const auto meta = read("headsq/headsq_hu.mha");
  ASSERT_TRUE(nrrd.ok() && meta.ok());
  EXPECT_TRUE(says(*nrrd, "left-handed"));
  expect_rotation(*nrrd);
  expect_rotation(*meta);
  for (const Vec3& ijk : {Vec3(10, 20, 30), Vec3(40, 33, 70), Vec3(5, 60, 92)}) {
    const Vec3 p = world_mm(*meta, ijk);
    const float hu =
        at(*meta, static_cast<int>(ijk.x()), static_cast<int>(ijk.y()), static_cast<int>(ijk.z()));
    EXPECT_EQ(sample(*nrrd, Vec3(-p.x(), p.y(), p.z())) - 1024, hu);
  }
}

TEST(ReadScan, SegmentsKeepTheirNamesAndColours) {
  BURR_NEEDS_DATA("temporal_bone/LT151_256.seg.nrrd");
  const auto scan = read("temporal_bone/LT151_256.seg.nrrd");
  ASSERT_TRUE(scan.ok());
  ASSERT_EQ(scan->label_names.size(), 16U);
  EXPECT_EQ(scan->label_names[0].name, "Bone");
  EXPECT_EQ(scan->label_names[9].name, "Facial_Nerve");
  EXPECT_NEAR(scan->label_names[1].colour[2], 1.0, 1e-6);
}

TEST(ReadScan, NotANumberIsAir) {
  BURR_NEEDS_DATA("corpus/derived/nifti/datatype_float64_nan.nii");
  const auto scan = read("corpus/derived/nifti/datatype_float64_nan.nii");
  ASSERT_TRUE(scan.ok());
  EXPECT_TRUE(says(*scan, "no finite number"));
  for (const float v : scan->values) ASSERT_TRUE(std::isfinite(v));
}

TEST(ReadScan, ASpacingThatLiesIsOverridden) {
  BURR_NEEDS_DATA("tooth_microct/tooth.nhdr");
  ReadOptions options;
  options.spacing_mm = {0.1, 0.1, 0.1};
  const auto scan = read("tooth_microct/tooth.nhdr", options);
  ASSERT_TRUE(scan.ok());
  EXPECT_EQ(scan->spacing_mm, Vec3(0.1, 0.1, 0.1));
  EXPECT_TRUE(says(*scan, "as given"));
}

// dcm2niix decodes and sorts by itself; its output must show the same numbers at the same places in
// the world.
using ReadScanAgainst = test::FolderTest;

TEST_F(ReadScanAgainst, AnotherReaderOfDicomVoxelByVoxel) {
  BURR_NEEDS_DATA("skull_phantom/std_5mm_jpegll");
  if (output_of("dcm2niix -h").find("dcm2niix") == std::string::npos)
    GTEST_SKIP() << "needs the program dcm2niix";
  for (const char* series : {"skull_phantom/std_5mm_jpegll", "spine_lumbar/example_ct_dicom"}) {
    const auto source = test::data_dir() / series;
    output_of("dcm2niix -z n -b n -f other -w 1 -o '" + folder.string() + "' '" + source.string() +
              "'");
    NoProgress progress;
    const auto other = read_scan(path("other.nii"), {}, progress);
    ASSERT_TRUE(other.ok()) << series << ": " << other.error().text;
    const auto own = read(series);
    ASSERT_TRUE(own.ok());
    ASSERT_EQ(own->size, other->size) << series;
    std::size_t different = 0;
    for (int k = 0; k < own->size.z(); ++k)
      for (int j = 0; j < own->size.y(); ++j)
        for (int i = 0; i < own->size.x(); ++i)
          different += sample(*other, world_mm(*own, Vec3(i, j, k))) != at(*own, i, j, k) ? 1 : 0;
    EXPECT_EQ(different, 0U) << series;
  }
}

TEST(ReadScan, AFolderOfOneFileIsThatFile) {
  BURR_NEEDS_DATA("head_ct/ct_example.nii.gz");
  const auto folder = read("head_ct"), file = read("head_ct/ct_example.nii.gz");
  ASSERT_TRUE(folder) << folder.error().text;
  ASSERT_TRUE(file);
  EXPECT_EQ(folder->format, "NIfTI");
  EXPECT_TRUE(folder->values == file->values);
}

TEST(ReadScan, AHeaderNamesNoFileOutsideItsFolder) {
  BURR_NEEDS_DATA("corpus/derived/nrrd/detached_traversal.nhdr");
  for (const char* bad :
       {"corpus/derived/nrrd/detached_traversal.nhdr", "corpus/derived/metaimage/traversal.mhd"}) {
    const auto scan = read(bad);
    ASSERT_FALSE(scan.ok()) << bad;
    EXPECT_NE(scan.error().text.find("same folder"), std::string::npos) << scan.error().text;
  }
}

TEST(ReadScan, WhatIsNotThereIsASentenceWithTheNameAlone) {
  NoProgress progress;
  const auto scan = read_scan("/nowhere/Mrs_Smith/scan.nrrd", {}, progress);
  ASSERT_FALSE(scan.ok());
  EXPECT_EQ(scan.error().trouble, Trouble::io);
  EXPECT_EQ(scan.error().text.find("Smith"), std::string::npos);
}

}  // namespace
}  // namespace burr::io
