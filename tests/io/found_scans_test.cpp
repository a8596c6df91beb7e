// DICOM as people find it: what other programs mixed, dropped or took for something else. Each
// trouble is made here, and read from the small files of ../shared/data/reports where they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "burr/io/read/read_scan.h"
#include "io/dicom_writer.h"
#include "io/folder_of_test.h"
#include "support/data.h"

namespace burr::io {
namespace {

using test::DicomSlice;

Result<Scan> read_path(const std::filesystem::path& path, const ReadOptions& options = {}) {
  NoProgress progress;
  return read_scan(path, options, progress);
}
Result<Scan> report(const std::string& name, const ReadOptions& options = {}) {
  return read_path(test::data_dir() / "reports" / name, options);
}
ReadOptions series(const std::string& wanted) {
  ReadOptions options;
  options.series = wanted;
  return options;
}

bool says(const Scan& scan, const char* words) {
  return std::any_of(scan.notices.begin(), scan.notices.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}
bool asks(const Scan& scan, Ask ask, const char* words) {
  return std::any_of(scan.questions.begin(), scan.questions.end(), [&](const Question& q) {
    return q.ask == ask && q.text.find(words) != std::string::npos;
  });
}
std::string all_of(const Scan& scan) {
  std::string text;
  for (const std::string& n : scan.notices) text += n + "\n";
  for (const Question& q : scan.questions) text += "? " + q.text + "\n";
  return text;
}

// The volume at or above 300, in whole voxels. All clean copies give the same within 1 %.
double bone_mm3(const Scan& scan) {
  const auto count =
      std::count_if(scan.values.begin(), scan.values.end(), [](float v) { return v >= 300; });
  return static_cast<double>(count) * scan.spacing_mm.prod();
}
double control_mm3() {
  static const double volume = [] {
    const auto scan = report("C00_control/dcm");
    return scan ? bone_mm3(*scan) : -1.0;
  }();
  return volume;
}
void expect_as_control(const Result<Scan>& scan, double share = 0.01) {
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_NEAR(bone_mm3(*scan), control_mm3(), share * control_mm3()) << all_of(*scan);
  EXPECT_TRUE(scan->hounsfield);
}

class FoundScans : public test::FolderTest {
 protected:
  // `count` slices that all have this value, from z on
  void phase(const std::string& name, int count, double z, double gap, std::uint16_t value,
             const std::function<void(DicomSlice&, int)>& change, int instance = 1) {
    for (int k = 0; k < count; ++k) {
      DicomSlice slice;
      slice.at(z + gap * k, instance + k);
      slice.value = value;
      change(slice, k);
      slice.write(path(name + std::to_string(k) + ".dcm"));
    }
  }
  // Whether a volume holds one value alone: its slices were not mixed.
  static bool pure(const Scan& scan, float value) {
    return std::all_of(scan.values.begin(), scan.values.end(), [&](float v) { return v == value; });
  }
  void expect_two_pure_volumes(int slices) {
    const auto first = read_path(folder, series("#1")), second = read_path(folder, series("#2"));
    ASSERT_TRUE(first.ok()) << first.error().text;
    ASSERT_TRUE(second.ok()) << second.error().text;
    ASSERT_EQ(first->series.size(), 2U) << all_of(*first);
    EXPECT_TRUE(pure(*first, 100)) << all_of(*first);
    EXPECT_TRUE(pure(*second, 200)) << all_of(*second);
    EXPECT_EQ(first->size.z(), slices);
    EXPECT_EQ(second->size.z(), slices);
    const auto best = read_path(folder);
    ASSERT_TRUE(best.ok());
    EXPECT_TRUE(says(*best, "2 volumes found in 1 series")) << all_of(*best);
  }
};

// ---- many studies

TEST_F(FoundScans, OfSeveralSeriesTheDateOfTheStudyIsKnownAndNothingElseOfThePatient) {
  const std::pair<const char*, const char*> dates[] = {{"20190307", "2019-03-07"},
                                                       {"2020.11.02", "2020-11-02"},
                                                       {"", ""},
                                                       {"2021030", ""},
                                                       {"2021O301", ""}};
  int n = 0;
  for (const auto& date : dates) {
    const std::string number = std::to_string(++n);
    const char* const stated = date.first;
    phase("s" + number + "_", 5, 0, 1, 1100, [&](DicomSlice& s, int) {
      s.set(0x0020000E, "UI", "1.2.3." + number).set(0x0020000D, "UI", "1.2.4." + number);
      s.set(0x00200011, "IS", number);
      if (*stated != 0) s.set(0x00080020, "DA", stated);
      s.set(0x00100010, "PN", "Svensson^Karin").set(0x00100030, "DA", "19561224");
    });
  }
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->series.size(), std::size(dates)) << all_of(*scan);
  ASSERT_EQ(scan->series_dates.size(), std::size(dates));
  std::multiset<std::string> wanted, found(scan->series_dates.begin(), scan->series_dates.end());
  for (const auto& [stated, seen] : dates) wanted.insert(seen);
  EXPECT_EQ(found, wanted);
  std::string all = all_of(*scan);
  for (const std::string& line : scan->series) all += line + "\n";
  for (const char* personal : {"Svensson", "Karin", "1956", "2019", "2020"})
    EXPECT_EQ(all.find(personal), std::string::npos) << personal << " is in\n" << all;
}

// ---- phases

struct Sign {
  const char* name;
  std::uint32_t tag;
  const char* vr;
  const char* first;
  const char* second;
};

TEST_F(FoundScans, PhasesAreToldApartByWhatTheFilesState) {
  for (const Sign& sign : {Sign{"acquisition", 0x00200012, "IS", "3", "4"},
                           {"temporal position", 0x00200100, "IS", "1", "2"},
                           {"trigger", 0x00181060, "DS", "100", "450,5"},
                           {"content time", 0x00080033, "TM", "101500", "101530.5"},
                           {"kernel", 0x00181210, "SH", "B30f", "B70f"},
                           {"tube", 0x00180060, "DS", "80", "140"}}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      std::filesystem::remove(entry);
    phase("b", 9, 0, 1, 1200, [&](DicomSlice& s, int) { s.set(sign.tag, sign.vr, sign.second); });
    phase("a", 9, 0, 1, 1100, [&](DicomSlice& s, int) { s.set(sign.tag, sign.vr, sign.first); });
    SCOPED_TRACE(sign.name);
    expect_two_pure_volumes(9);
  }
}

TEST_F(FoundScans, PhasesWithATimeOfEachSliceOrOnlyNumbersAreToldApart) {
  const auto clock = [](int seconds) {
    return [seconds](DicomSlice& s, int k) {
      s.set(0x00080032, "TM", "1200" + std::to_string(10 + seconds + k) + ".25");
    };
  };
  phase("a", 9, 0, 1, 1100, clock(0));
  phase("b", 9, 0, 1, 1200, clock(30));
  expect_two_pure_volumes(9);
  // slice by slice, by the instance number alone
  for (int k = 0; k < 9; ++k)
    for (int p = 0; p < 2; ++p) {
      DicomSlice slice;
      slice.at(k, 1 + 2 * k + p).value = static_cast<std::uint16_t>(1100 + 100 * p);
      slice.write(path((p == 0 ? "a" : "b") + std::to_string(k) + ".dcm"));
    }
  expect_two_pure_volumes(9);
}

TEST_F(FoundScans, PhasesWithTheTableMovedHalfASliceAreNotInterleaved) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int) { s.set(0x00200012, "IS", "1"); });
  phase("b", 9, 0.5, 1, 1200, [](DicomSlice& s, int) { s.set(0x00200012, "IS", "2"); });
  expect_two_pure_volumes(9);
}

TEST_F(FoundScans, TwoPassesThatFillEachOtherAreOneVolume) {
  phase("a", 9, 0, 2, 1100, [](DicomSlice& s, int) { s.set(0x00200012, "IS", "1"); });
  phase("b", 9, 1, 2, 1100, [](DicomSlice& s, int) { s.set(0x00200012, "IS", "2"); });
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 18);
  EXPECT_TRUE(scan->series.empty());
}

TEST_F(FoundScans, PartsOfALongScanThatMeetAreOneVolume) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int) { s.set(0x00200012, "IS", "1"); });
  phase("b", 9, 8, 1, 1100, [](DicomSlice& s, int) { s.set(0x00200012, "IS", "2"); });
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 17) << all_of(*scan);
  EXPECT_TRUE(says(*scan, "1 pictures are at the position of another one")) << all_of(*scan);
}

TEST_F(FoundScans, PhasesThatNothingTellsApartAreRefused) {
  const auto plain = [](DicomSlice& s, int) { (void)s; };
  phase("a", 9, 0, 1, 1100, plain);
  phase("b", 9, 0, 1, 1200, plain);
  const auto scan = read_path(folder);
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("nothing in the files tells the two volumes apart"),
            std::string::npos)
      << scan.error().text;
}

TEST_F(FoundScans, CopiesOfFilesAreLeftOut) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int) { (void)s; });
  for (int k = 0; k < 9; ++k)
    std::filesystem::copy_file(path("a" + std::to_string(k) + ".dcm"),
                               path("copy of a" + std::to_string(k) + ".dcm"));
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 9);
  EXPECT_TRUE(says(*scan, "9 files are copies")) << all_of(*scan);
}

TEST_F(FoundScans, BlocksFarFromEachOtherAreTwoVolumes) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int) { (void)s; });
  phase(
      "b", 9, 150, 1, 1200, [](DicomSlice& s, int) { (void)s; }, 10);
  expect_two_pure_volumes(9);
  const auto by_uid = read_path(folder, series("1.2.3#2"));
  ASSERT_TRUE(by_uid.ok()) << by_uid.error().text;
  EXPECT_TRUE(pure(*by_uid, 200));
  EXPECT_FALSE(read_path(folder, series("1.2.3#3")).ok());
  EXPECT_FALSE(read_path(folder, series("#0")).ok());
}

TEST_F(FoundScans, OfTheReportsEachPhaseIsPure) {
  BURR_NEEDS_DATA("reports/D03_two_phases");
  for (const char* name : {"D03_two_phases/dcm", "D03_two_phases/unique_instance"}) {
    SCOPED_TRACE(name);
    expect_as_control(report(name));
    expect_as_control(report(name, series("#2")));
    const auto scan = report(name);
    ASSERT_TRUE(scan.ok() && scan->series.size() == 2);
    EXPECT_NE(scan->series[0].find("acquisition"), std::string::npos);
  }
  const auto major = report("D20_enhanced_phases/phase_major"),
             minor = report("D20_enhanced_phases/slice_major");
  ASSERT_TRUE(major.ok() && minor.ok());
  EXPECT_EQ(major->values, minor->values) << all_of(*minor);
  EXPECT_EQ(minor->series.size(), 2U);
}

TEST_F(FoundScans, OfTheReportsTheLargerGroupAndTheBoneKernelAreTaken) {
  BURR_NEEDS_DATA("reports/D28_mixed_recon");
  const auto kernels = report("D28_mixed_recon/kernels");
  expect_as_control(kernels, 0.1);
  ASSERT_TRUE(kernels.ok() && kernels->series.size() == 2);
  EXPECT_NE(kernels->series[static_cast<std::size_t>(kernels->series_taken)].find("bone kernel"),
            std::string::npos)
      << all_of(*kernels);
  const auto mpr = report("D28_mixed_recon/mpr");
  expect_as_control(mpr);
  ASSERT_TRUE(mpr.ok() && mpr->series.size() == 2);
  EXPECT_EQ(mpr->size.z(), 40);
  EXPECT_TRUE(report("D28_mixed_recon/mpr", series("#1")).ok());
  EXPECT_TRUE(report("D28_mixed_recon/mpr", series("#2")).ok());
  const auto blocks = report("D17_two_blocks/dcm");
  ASSERT_TRUE(blocks.ok()) << blocks.error().text;
  EXPECT_EQ(blocks->series.size(), 2U);
  EXPECT_EQ(blocks->size.z(), 40);
}

// ---- what is missing

TEST_F(FoundScans, FilesThatCannotBeReadAreCountedAndNamed) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int) { (void)s; });
  for (const int bad : {6, 7, 8}) {
    const std::string file = path("a" + std::to_string(bad) + ".dcm");
    std::filesystem::resize_file(file, bad == 6   ? std::filesystem::file_size(file) - 9
                                       : bad == 7 ? 0
                                                  : 300);
  }
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 6);
  EXPECT_TRUE(asks(*scan, Ask::missing, "3 of 9 files could not be read")) << all_of(*scan);
  EXPECT_TRUE(asks(*scan, Ask::missing, "a6.dcm: cut off, a7.dcm: empty, a8.dcm: cut off"))
      << all_of(*scan);
}

TEST_F(FoundScans, WhatIsNoSliceIsNotCountedAsLost) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int) { (void)s; });
  std::ofstream(path("README.txt")) << "hello";
  std::ofstream(path(".DS_Store")) << std::string(200, '\0');
  std::ofstream(path("empty.log"));
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(scan->questions.empty()) << all_of(*scan);
}

TEST_F(FoundScans, OfTheReportsAnEndThatIsMissingIsAsked) {
  BURR_NEEDS_DATA("reports/D26_truncated_end_files");
  for (const char* name : {"cut", "empty", "cut_middle"}) {
    const auto scan = report(std::string("D26_truncated_end_files/") + name);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_TRUE(asks(*scan, Ask::missing, "of 40 files could not be read")) << all_of(*scan);
  }
}

// ---- numbers

TEST_F(FoundScans, DecimalCommasAreDecimalPoints) {
  phase("a", 9, 0, 1, 1100, [](DicomSlice& s, int k) {
    s.set(0x00280030, "DS", "0,25\\0,75").set(0x00281053, "DS", "0,5");
    s.set(0x00281052, "DS", "-10,5").set(0x00180050, "DS", "1,5");
    s.set(0x00200037, "DS", "1,0\\0,0\\0,0\\0,0\\1,0\\0,0");
    s.set(0x00200032, "DS", "1,5\\-2,5\\" + std::to_string(k) + ",5");
  });
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(scan->spacing_mm.isApprox(math::Vec3(0.75, 0.25, 1))) << scan->spacing_mm.transpose();
  EXPECT_TRUE(scan->origin_mm.isApprox(math::Vec3(1.5, -2.5, 0.5)));
  EXPECT_TRUE(pure(*scan, 1100 * 0.5F - 10.5F)) << scan->values.front();
  EXPECT_TRUE(says(*scan, "decimal comma"));
}

TEST_F(FoundScans, ASlopeThatIsNoNumberIsNotTakenForOne) {
  phase("a", 3, 0, 1, 1100, [](DicomSlice& s, int) { s.set(0x00281053, "DS", "1.024,5"); });
  const auto scan = read_path(folder);
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("Rescale Slope \"1.024,5\" is no number"), std::string::npos)
      << scan.error().text;
}

TEST_F(FoundScans, OfTheReportsCommasChangeNothing) {
  BURR_NEEDS_DATA("reports/D04_decimal_comma");
  for (const char* name : {"all", "position", "slope", "spacing"}) {
    SCOPED_TRACE(name);
    expect_as_control(report(std::string("D04_decimal_comma/") + name));
  }
  const auto slope = report("D04_decimal_comma/slope15");
  expect_as_control(slope);
}

TEST_F(FoundScans, BitsBeyondBitsStoredAreSaid) {
  phase("a", 3, 0, 1, 0x1234, [](DicomSlice& s, int) { s.bits_stored = 12; });
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(says(*scan, "48 pixels have bits beyond the 12")) << all_of(*scan);
}

// ---- where the slices lie

TEST_F(FoundScans, SeriesOfOnePictureEachAreJoined) {
  for (const bool even : {true, false}) {
    phase("a", 9, 0, 1, 1100, [&](DicomSlice& s, int k) {
      s.set(0x0020000E, "UI", "1.2.3." + std::to_string(90 - k));
      if (!even && k > 4) s.set(0x00200032, "DS", "0\\0\\" + std::to_string(k * k));
    });
    const auto scan = read_path(folder);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_EQ(scan->size.z(), even ? 9 : 1) << all_of(*scan);
    EXPECT_EQ(says(*scan, "9 series of one picture each were joined"), even) << all_of(*scan);
  }
}

TEST_F(FoundScans, SliceLocationStandsInForPositionsThatAreAllEqual) {
  phase("a", 9, 0, 1, 1100, [&](DicomSlice& s, int k) {
    s.set(0x00200032, "DS", "5\\6\\7").set(0x00201041, "DS", DicomSlice::number(0.5 * k));
  });
  const auto scan = read_path(folder);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 9);
  EXPECT_NEAR(scan->spacing_mm.z(), 0.5, 1e-9);
  EXPECT_TRUE(says(*scan, "Slice Location")) << all_of(*scan);
}

TEST_F(FoundScans, FramesWithOnePositionLieInTheirOrder) {
  DicomSlice slice;
  slice.at(3, 1);
  slice.frames = 7;
  slice.set(0x00180050, "DS", "0.4").write(path("a.dcm"));
  auto scan = read_path(path("a.dcm"));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 7);
  EXPECT_NEAR(scan->spacing_mm.z(), 0.4, 1e-9);
  EXPECT_NEAR(scan->origin_mm.z(), 3, 1e-9);
  // without any thickness the distance is asked
  slice.elements.erase(0x00180050);
  slice.write(path("a.dcm"));
  scan = read_path(path("a.dcm"));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(asks(*scan, Ask::spacing, "distance is not known")) << all_of(*scan);
}

TEST_F(FoundScans, OfTheReportsEachGeometryIsRight) {
  BURR_NEEDS_DATA("reports/D01_enhanced_implicit");
  for (const char* name :
       {"D01_enhanced_implicit/implicit", "D01_enhanced_implicit/explicit", "D18_private_syntax/ge",
        "D05_series_uid_per_slice/dcm", "D09_same_position_slicelocation/dcm",
        "D21_classic_multiframe/thick", "D21_classic_multiframe/between", "D25_dicomdir/cd",
        "D25_dicomdir/cd/DICOMDIR"}) {
    SCOPED_TRACE(name);
    expect_as_control(report(name), 0.02);
  }
  const auto enhanced = report("D01_enhanced_implicit/implicit");
  ASSERT_TRUE(enhanced.ok()) << enhanced.error().text;
  EXPECT_TRUE(enhanced->spacing_mm.isApprox(math::Vec3(0.4, 0.4, 0.6), 1e-6));
  const auto thin = report("D30_craniofacial/sc_nothickness");
  ASSERT_TRUE(thin.ok()) << thin.error().text;
  EXPECT_TRUE(asks(*thin, Ask::spacing, "thickness")) << all_of(*thin);
  const auto philips = report("D18_private_syntax/philips");
  ASSERT_FALSE(philips.ok());
  EXPECT_NE(philips.error().text.find("1.3.46.670589.33.1.4.1, private to Philips"),
            std::string::npos)
      << philips.error().text;
}

// ---- folders

TEST_F(FoundScans, OfTheReportsFoldersAreUnderstood) {
  BURR_NEEDS_DATA("reports/P01_folders/x");
  const std::string x = "P01_folders/x/";
  for (const char* name : {"mac", "mac2", "mhdpair", "cd", "noext", "two"}) {
    const auto scan = report(x + name);
    EXPECT_TRUE(scan.ok()) << name << ": " << scan.error().text;
  }
  const auto two = report(x + "two");
  ASSERT_TRUE(two.ok());
  EXPECT_FALSE(two->values.empty()) << "the scan, not the label map";
  EXPECT_TRUE(says(*two, "seg.nii.gz lies beside it")) << all_of(*two);
  struct Refused {
    const char *name, *words;
  };
  for (const Refused& refused :
       {Refused{"stl", "an STL mesh"}, {"jpgs", "slice_0001.tif: is a damaged TIFF picture"}}) {
    const auto scan = report(x + refused.name);
    ASSERT_FALSE(scan.ok()) << refused.name;
    EXPECT_NE(scan.error().text.find(refused.words), std::string::npos) << scan.error().text;
    EXPECT_EQ(scan.error().text.find("is no file burr reads"), std::string::npos)
        << scan.error().text;
  }
}

TEST_F(FoundScans, AZipArchiveIsReadAsItsFolder) {
  BURR_NEEDS_DATA("reports/P01_folders/x/ct.zip");
  const auto archive = test::data_dir() / "reports/P01_folders/x/ct.zip";
  expect_as_control(read_path(archive));
  expect_as_control(report("P01_folders/x/withzip"));
  // bytes that changed are noticed by their checksum, and a cut archive by its missing table
  std::string bytes = content(archive.string());
  std::ofstream(path("cut.zip"), std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  const auto cut = read_path(path("cut.zip"));
  ASSERT_FALSE(cut.ok());
  EXPECT_NE(cut.error().text.find("cut off or damaged; copy it again"), std::string::npos)
      << cut.error().text;
  for (std::size_t at = bytes.size() / 3; at < bytes.size() / 3 + 40; ++at) bytes[at] ^= 0x55;
  std::ofstream(path("changed.zip"), std::ios::binary) << bytes;
  const auto changed = read_path(path("changed.zip"));
  if (changed) {
    EXPECT_TRUE(asks(*changed, Ask::missing, "could not be read")) << all_of(*changed);
  }
}

TEST_F(FoundScans, DecimalCommasOfTextHeadersAreRead) {
  const std::string voxels("\1\2\3\4\5\6\7\10\1\2\3\4\5\6\7\1");
  std::ofstream(path("a.mha"), std::ios::binary)
      << "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = 0,5 0,5 0,75\n"
      << "Offset = 1,5 -2,5 3\nElementToIntensityFunctionSlope = 0,5\n"
      << "ElementType = MET_SHORT\nElementDataFile = LOCAL\n"
      << voxels;
  const auto meta = read_path(path("a.mha"));
  ASSERT_TRUE(meta.ok()) << meta.error().text;
  EXPECT_TRUE(meta->spacing_mm.isApprox(math::Vec3(0.5, 0.5, 0.75)));
  EXPECT_TRUE(meta->origin_mm.isApprox(math::Vec3(1.5, -2.5, 3)));
  EXPECT_EQ(meta->values.front(), 0.5F * 0x201);
  EXPECT_TRUE(says(*meta, "decimal comma")) << all_of(*meta);
  const std::string head = "NRRD0004\ntype: int16\ndimension: 3\nsizes: 2 2 2\nendian: little\n";
  std::ofstream(path("a.nrrd"), std::ios::binary)
      << head << "spacings: 0,5 0,5 0,75\nencoding: raw\n\n"
      << voxels;
  const auto nrrd = read_path(path("a.nrrd"));
  ASSERT_TRUE(nrrd.ok()) << nrrd.error().text;
  EXPECT_TRUE(nrrd->spacing_mm.isApprox(math::Vec3(0.5, 0.5, 0.75)));
  std::ofstream(path("b.nrrd"), std::ios::binary)
      << head << "space: left-posterior-superior\n"
      << "space directions: (0,5,0,0) (0,0,5,0) (0,0,0,5)\nencoding: raw\n\n"
      << voxels;
  const auto unclear = read_path(path("b.nrrd"));
  ASSERT_TRUE(unclear.ok()) << unclear.error().text;
  EXPECT_TRUE(asks(*unclear, Ask::spacing, "cannot be read as numbers")) << all_of(*unclear);
}

TEST_F(FoundScans, ASpacingThatNoScanHasIsAsked) {
  struct Spacing {
    const char *text, *words;
  };
  for (const Spacing& one : {Spacing{"2e-5 2e-5 2e-5", "metres, they are 0.02"},
                             {"20 20 20", "micrometres, they are 0.02"},
                             {"0.4 0.4 20", "micrometres"},
                             {"0.4 0.4 10", nullptr},
                             {"5 5 5", nullptr},
                             {"0.01 0.01 0.01", nullptr}}) {
    std::ofstream(path("x.mha"), std::ios::binary)
        << "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = " << one.text
        << "\nElementType = MET_SHORT\nElementDataFile = LOCAL\n"
        << std::string("\1\2\3\4\5\6\7\10\1\2\3\4\5\6\7\1");
    const auto scan = read_path(path("x.mha"));
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_EQ(scan->questions.empty(), one.words == nullptr) << one.text;
    if (one.words != nullptr) {
      EXPECT_TRUE(asks(*scan, Ask::spacing, one.words)) << all_of(*scan);
    }
    ReadOptions given;
    given.spacing_mm = {0.02, 0.02, 0.02};
    const auto answered = read_path(path("x.mha"), given);
    EXPECT_TRUE(answered.ok() && answered->questions.empty());
  }
}

}  // namespace
}  // namespace burr::io
