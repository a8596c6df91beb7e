// Scans that contradict what should be there, or themselves: absent files, two places, inverted
// values, other kinds of picture. Each kind is made here, and read from ../shared/data/reports3.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

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
std::filesystem::path report(const std::string& name) {
  return test::data_dir() / "reports3" / name;
}
std::string all_of(const Scan& scan) {
  std::string text;
  for (const std::string& n : scan.notices) text += n + "\n";
  for (const Question& q : scan.questions) text += "? " + q.text + "\n";
  return text;
}
bool says(const Scan& scan, const std::string& words) {
  return std::any_of(scan.notices.begin(), scan.notices.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}
void expect_asks(const Result<Scan>& scan, Ask ask, const std::string& words) {
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  const bool asks = std::any_of(
      scan->questions.begin(), scan->questions.end(),
      [&](const Question& q) { return q.ask == ask && q.text.find(words) != std::string::npos; });
  EXPECT_TRUE(asks) << words << "\n" << all_of(*scan);
}
void expect_silent(const Result<Scan>& scan) {
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(scan->questions.empty()) << all_of(*scan);
}

// ---- absent files

TEST(Doubts, FilesThatSomethingSaysShouldBeThereAreAskedFor) {
  BURR_NEEDS_DATA("reports3/X3_absent");
  const char* index = "DICOMDIR lists 56 pictures of this series, and 22 of them are not here";
  expect_asks(read_path(report("X3_absent/dicomdir")), Ask::absent, index);
  expect_asks(read_path(report("X3_absent/dicomdir/DICOMDIR")), Ask::absent, index);
  expect_asks(read_path(report("X3_absent/images_in_acquisition.zip")), Ask::absent,
              "its acquisition has 56 pictures (Images in Acquisition), and 34 are here");
  expect_asks(read_path(report("X3_absent/concatenation_without_first.zip")), Ask::absent,
              "1 of 3 parts of this scan is not here (part 1)");
  ReadOptions old;
  old.check_scan = false;
  expect_silent(read_path(report("X3_absent/dicomdir"), old));
}

class AbsentFiles : public test::FolderTest {
 protected:
  // slices from..to of one series
  void slices(int from, int to, const std::function<void(DicomSlice&, int)>& change) {
    for (int n = from; n <= to; ++n) {
      DicomSlice slice;
      slice.at(n, n);
      slice.set(0x00080018, "UI", "1.2.840." + std::to_string(n));
      change(slice, n);
      std::filesystem::create_directories(folder / "images");
      slice.write(path("images/im" + std::to_string(n)));
    }
  }
  static void put(std::string& out, unsigned value, int bytes) {
    for (int n = 0; n < bytes; ++n) out += static_cast<char>(value >> 8 * n & 0xFF);
  }
  static void element(std::string& out, unsigned tag, const std::string& vr, std::string value) {
    if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
    put(out, tag >> 16, 2);
    put(out, tag & 0xFFFF, 2);
    out += vr;
    if (vr == "SQ") put(out, 0, 2);
    put(out, static_cast<unsigned>(value.size()), vr == "SQ" ? 4 : 2);
    out += value;
  }
  static std::string number(unsigned value) {
    std::string out;
    put(out, value, 4);
    return out;
  }
  struct Record {
    std::string type, file, instance;
    int next = -1, lower = -1;  // other records
  };
  // A DICOMDIR of these records, of which the first is the root.
  void index(const std::vector<Record>& records) {
    std::vector<std::string> items;
    std::string head(128, '\0');
    head += "DICM";
    element(head, 0x00020002, "UI", "1.2.840.10008.1.3.10");
    element(head, 0x00020010, "UI", "1.2.840.10008.1.2.1");
    const auto begin = static_cast<unsigned>(head.size()) + 12 + 12;  // behind the first offset
    std::vector<unsigned> offsets;
    for (int round = 0; round < 2; ++round) {
      items.clear();
      unsigned at = begin;
      std::vector<unsigned> places;
      for (const Record& record : records) {
        const auto place = [&](int n) {
          return number(n < 0 || offsets.empty() ? 0 : offsets[static_cast<std::size_t>(n)]);
        };
        std::string body;
        element(body, 0x00041400, "UL", place(record.next));
        element(body, 0x00041420, "UL", place(record.lower));
        element(body, 0x00041430, "CS", record.type);
        if (!record.file.empty()) element(body, 0x00041500, "CS", record.file);
        if (!record.instance.empty()) element(body, 0x00041511, "UI", record.instance);
        if (record.type == "SERIES") element(body, 0x0020000E, "UI", "1.2.3");
        std::string item;
        put(item, 0xFFFE, 2);
        put(item, 0xE000, 2);
        put(item, static_cast<unsigned>(body.size()), 4);
        items.push_back(item + body);
        places.push_back(at);
        at += static_cast<unsigned>(items.back().size());
      }
      offsets = places;
    }
    element(head, 0x00041200, "UL", number(offsets.front()));
    std::string all;
    for (const std::string& item : items) all += item;
    element(head, 0x00041220, "SQ", all);
    std::ofstream(path("DICOMDIR"), std::ios::binary) << head;
  }
  // One series of `count` pictures, IMAGES\IM1 and so on.
  static std::vector<Record> series_of(int count, const std::string& instance) {
    std::vector<Record> records = {{"SERIES", "", "", -1, count > 0 ? 1 : -1}};
    for (int n = 1; n <= count; ++n)
      records.push_back({"IMAGE", "IMAGES\\IM" + std::to_string(n),
                         instance.empty() ? "" : instance + std::to_string(n),
                         n < count ? n + 1 : -1, -1});
    return records;
  }
};

TEST_F(AbsentFiles, AnIndexIsComparedByNamesInAnyLettersAndByUids) {
  slices(1, 6, [](DicomSlice&, int) {});
  index(series_of(6, "1.2.840."));
  expect_silent(read_path(folder));
  index(series_of(6, ""));  // by their names alone, in large letters
  expect_silent(read_path(folder));
  index(series_of(9, ""));
  expect_asks(read_path(folder), Ask::absent, "lists 9 pictures of this series, and 3 of them");
  index(series_of(9, "1.2.840."));
  for (int n = 1; n <= 6; ++n)  // the files have other names now
    std::filesystem::rename(path("images/im" + std::to_string(n)),
                            path("images/other" + std::to_string(n)));
  expect_asks(read_path(folder), Ask::absent, "lists 9 pictures of this series, and 3 of them");
}

TEST_F(AbsentFiles, AnotherSeriesOfTheIndexIsNobodysLoss) {
  slices(1, 6, [](DicomSlice&, int) {});
  auto records = series_of(6, "1.2.840.");
  records.front().next = static_cast<int>(records.size());
  records.push_back({"SERIES", "", "", -1, static_cast<int>(records.size()) + 1});
  records.push_back({"IMAGE", "IMAGES\\ELSE", "1.2.900", -1, -1});
  index(records);
  // both are called 1.2.3 by this writer; the second becomes another one
  std::string bytes = content(path("DICOMDIR"));
  const std::size_t second = bytes.rfind("1.2.3");
  bytes.replace(second, 5, "1.2.4");
  std::ofstream(path("DICOMDIR"), std::ios::binary) << bytes;
  expect_silent(read_path(folder));
}

TEST_F(AbsentFiles, AnIndexWithoutAnyOfItsPicturesSaysSo) {
  index(series_of(4, "1.2.840."));
  for (const auto& given : {folder, folder / "DICOMDIR"}) {
    const auto scan = read_path(given);
    ASSERT_FALSE(scan.ok());
    EXPECT_NE(scan.error().text.find("lists 4 pictures, and none of them is here"),
              std::string::npos)
        << scan.error().text;
  }
}

TEST_F(AbsentFiles, AnIndexThatLeadsInACircleOrOutOfTheFolderDoesNoHarm) {
  slices(1, 6, [](DicomSlice&, int) {});
  auto records = series_of(6, "1.2.840.");
  records.back().next = 1;
  records.back().lower = 0;
  records[3].file = "..\\..\\ETC\\PASSWD";
  index(records);
  expect_silent(read_path(folder));
  // cut off at every place, and with every byte changed in turn
  const std::string whole = content(path("DICOMDIR"));
  for (std::size_t n = 0; n < whole.size(); n += 37) {
    std::ofstream(path("DICOMDIR"), std::ios::binary) << whole.substr(0, n);
    EXPECT_TRUE(read_path(folder).ok()) << n;
  }
  for (std::size_t n = 132; n < whole.size(); n += 41) {
    std::string changed = whole;
    changed[n] = '\xFF';
    std::ofstream(path("DICOMDIR"), std::ios::binary) << changed;
    EXPECT_TRUE(read_path(folder).ok()) << n;
  }
}

TEST_F(AbsentFiles, ThePicturesOfAnAcquisitionMayBeInSeveralSeries) {
  const auto ten = [](DicomSlice& slice, int) {
    slice.set(0x00200012, "IS", "3").set(0x00201002, "IS", "10");
  };
  slices(1, 6, ten);
  expect_asks(read_path(folder), Ask::absent, "has 10 pictures (Images in Acquisition), and 6");
  slices(11, 14, [&](DicomSlice& slice, int n) {
    ten(slice, n);
    slice.set(0x0020000E, "UI", "1.2.77");
  });
  expect_silent(read_path(folder));
}

TEST_F(AbsentFiles, WhereEverySliceHasAnAcquisitionOfItsOwnTheNumberIsOfTheSeries) {
  for (const int stated : {6, 1, 9}) {
    slices(1, 6, [&](DicomSlice& slice, int n) {
      slice.set(0x00200012, "IS", std::to_string(n));
      slice.set(0x00201002, "IS", std::to_string(stated));
    });
    const auto scan = read_path(folder);
    if (stated <= 6)
      expect_silent(scan);
    else
      expect_asks(scan, Ask::absent, "has 9 pictures");
  }
}

TEST_F(AbsentFiles, TheNumberOfTheSeriesCountsEveryKindOfFile) {
  const auto seven = [](DicomSlice& slice, int) { slice.set(0x00201209, "IS", "7"); };
  slices(1, 6, seven);
  expect_asks(read_path(folder), Ask::absent, "its series has 7 files");
  // a colour picture of the series is there, though it is no slice
  slices(7, 7, [&](DicomSlice& slice, int n) {
    seven(slice, n);
    slice.set(0x00280004, "CS", "PALETTE COLOR");
  });
  expect_silent(read_path(folder));
}

TEST_F(AbsentFiles, PartsOfAConcatenationAreCountedWithAndWithoutTheirTotal) {
  const auto part = [&](int number, int total) {
    DicomSlice slice;
    slice.frames = 3;
    slice.at(10 * number, number);
    slice.set(0x00180088, "DS", "1").set(0x00200052, "UI", "1.9");
    slice.set(0x00209161, "UI", "1.2.3.99");
    const auto us = [](int v) { return std::string{static_cast<char>(v), '\0'}; };
    slice.set(0x00209162, "US", us(number));
    if (total > 0) slice.set(0x00209163, "US", us(total));
    slice.set(0x00182005, "DS",
              std::to_string(3 * number) + "\\" + std::to_string(3 * number + 1) + "\\" +
                  std::to_string(3 * number + 2));
    slice.set(0x00200032, "DS", "0\\0\\" + std::to_string(3 * number));
    slice.write(path("part" + std::to_string(number)));
  };
  part(1, 3);
  part(2, 3);
  expect_asks(read_path(folder), Ask::absent, "1 of 3 parts of this scan is not here (part 3)");
  part(3, 3);
  expect_silent(read_path(folder));
  std::filesystem::remove(path("part1"));
  part(2, 0);
  part(3, 0);
  expect_asks(read_path(folder), Ask::absent, "1 of 3 parts of this scan is not here (part 1)");
}

TEST_F(AbsentFiles, FramesBeyondTheStatedNumberAreMissed) {
  DicomSlice slice;
  slice.frames = 6;
  slice.at(0, 1).set(0x00180088, "DS", "1");
  std::string bytes = slice.bytes();
  std::ofstream(path("all"), std::ios::binary) << bytes;
  expect_silent(read_path(path("all")));
  const std::string before = std::string("\x28\0\x08\0IS\x02\0", 8);
  const std::size_t at = bytes.find(before);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at + 8, 2, "4 ");
  std::ofstream(path("all"), std::ios::binary) << bytes;
  expect_asks(read_path(path("all")), Ask::absent, "states 4 frames, but its pixels hold 6");
}

TEST_F(AbsentFiles, AHoleBetweenSlicesIsCounted) {
  slices(1, 40, [](DicomSlice&, int) {});
  expect_silent(read_path(folder));
  for (int n = 15; n <= 35; ++n) std::filesystem::remove(path("images/im" + std::to_string(n)));
  const auto scan = read_path(folder);
  expect_asks(scan, Ask::absent,
              "21 slices are missing between others (21 between slices 14 and 15 (22 mm); 1 mm is "
              "usual)");
  ASSERT_TRUE(scan.ok());
  EXPECT_EQ(scan->size.z(), 40);
}

TEST_F(AbsentFiles, AnotherDistanceFromSomePlaceOnIsNoHole) {
  slices(1, 40, [](DicomSlice&, int) {});
  for (int n = 22; n <= 40; n += 2) std::filesystem::remove(path("images/im" + std::to_string(n)));
  const auto scan = read_path(folder);
  expect_silent(scan);
  ASSERT_TRUE(scan.ok());
  EXPECT_TRUE(says(*scan, "unevenly spaced")) << all_of(*scan);
}

TEST_F(AbsentFiles, EverySecondSliceIsMissedWhereTheFilesSayHowFarTheyLie) {
  const auto half = [&](const std::function<void(DicomSlice&, int)>& change) {
    slices(1, 20, change);
    for (int n = 2; n <= 20; n += 2) std::filesystem::remove(path("images/im" + std::to_string(n)));
    return read_path(folder);
  };
  expect_asks(half([](DicomSlice& s, int) { s.set(0x00180088, "DS", "1"); }), Ask::absent,
              "2 mm apart, 2 times as far as the files say");
  // thin slices whose numbers leave out as many
  expect_asks(half([](DicomSlice&, int) {}), Ask::absent, "only one of 2 slices may be here");
  // thin slices far apart, numbered in a row: so they were made
  expect_silent(half([](DicomSlice& s, int n) { s.set(0x00200013, "IS", std::to_string(n / 2)); }));
}

// ---- two statements about one place

// A NIfTI-1 file of 8 x 8 x 8 voxels whose qform states axes of RAS, 0.5 mm and this origin.
class TwoFrames : public test::FolderTest {
 protected:
  std::array<float, 3> spacing = {0.5F, 0.5F, 0.5F};
  std::array<float, 12> rows = {0.5F, 0, 0, 3, 0, 0.5F, 0, 4, 0, 0, 0.5F, 5};
  std::array<float, 3> quaternion = {0, 0, 0}, offset = {3, 4, 5};
  std::int16_t qform = 1, sform = 1;
  std::string description;

  Result<Scan> read(const ReadOptions& options = {}) {
    std::string bytes(352, '\0');
    const auto put = [&](std::size_t at, auto value) {
      std::memcpy(bytes.data() + at, &value, sizeof value);
    };
    put(0, std::int32_t{348});
    for (std::size_t n = 0; n < 4; ++n) put(40 + 2 * n, std::int16_t(n == 0 ? 3 : 8));
    put(70, std::int16_t{4});
    put(72, std::int16_t{16});
    put(76, 1.0F);
    for (std::size_t n = 0; n < 3; ++n) {
      put(80 + 4 * n, spacing[n]);
      put(256 + 4 * n, quaternion[n]);
      put(268 + 4 * n, offset[n]);
    }
    put(108, 352.0F);
    std::memcpy(bytes.data() + 148, description.data(), description.size());
    put(252, qform);
    put(254, sform);
    for (std::size_t n = 0; n < 12; ++n) put(280 + 4 * n, rows[n]);
    std::memcpy(bytes.data() + 344, "n+1", 3);
    for (int n = 0; n < 512; ++n) {
      const auto value = static_cast<std::int16_t>(10 * (n % 50) - n % 7);
      bytes.append(reinterpret_cast<const char*>(&value), 2);
    }
    std::ofstream(path("a.nii"), std::ios::binary) << bytes;
    return read_path(path("a.nii"), options);
  }
};

TEST(Doubts, QformAndSformOfTheReports) {
  BURR_NEEDS_DATA("reports3/X4_qform_sform");
  const auto file = [](const char* name) {
    return read_path(report(std::string("X4_qform_sform/") + name + ".nii.gz"));
  };
  expect_asks(file("sform_mirrored"), Ask::doubt, "sform and its qform are mirror images");
  expect_asks(file("sform_twice_as_large"), Ask::doubt, "8 times the volume");
  const auto moved = file("sform_moved");
  expect_silent(moved);
  // by (30, 30, 30) mm
  EXPECT_TRUE(moved.ok() && says(*moved, "by its sform and by its qform: its middle lies 52 mm"))
      << all_of(*moved);
  const auto same = file("same");
  expect_silent(same);
  EXPECT_TRUE(same.ok() && same->notices.size() < 2) << all_of(*same);
}

TEST_F(TwoFrames, AgreeWithinRounding) {
  const auto silent = [&] {
    const auto scan = read();
    expect_silent(scan);
    return scan.ok() && !says(*scan, "in two ways");
  };
  EXPECT_TRUE(silent());
  rows[0] = 0.5004F;
  rows[3] = 3.05F;
  EXPECT_TRUE(silent());
  qform = 0;  // is no statement, whatever stands there
  quaternion = {0.7F, 0.2F, 0.1F};
  offset = {100, 200, 300};
  EXPECT_TRUE(silent());
  spacing = {1, 1, 1};  // was never set
  EXPECT_TRUE(silent());
}

TEST_F(TwoFrames, AnotherPlaceIsNotedAndAnotherSizeOrSideIsAsked) {
  offset = {3, 4, 15};
  auto scan = read();
  expect_silent(scan);
  EXPECT_TRUE(says(*scan, "its middle lies 10 mm apart")) << all_of(*scan);
  offset = {3, 4, 5};
  quaternion = {0, 0, static_cast<float>(std::sin(0.5 * 0.25))};
  scan = read();
  expect_silent(scan);
  EXPECT_TRUE(says(*scan, "it is turned by 14.3 degrees")) << all_of(*scan);
  quaternion = {0, 0, 0};
  rows[10] = 0.7F;
  expect_asks(read(), Ask::doubt,
              "0.5 x 0.5 x 0.7 mm by its sform, 0.5 x 0.5 x 0.5 mm by its qform");
  qform = 0;
  expect_asks(read(), Ask::doubt, "0.5 x 0.5 x 0.5 mm by its pixdim");
  qform = 1;
  rows[10] = -0.5F;
  expect_asks(read(), Ask::doubt, "mirror images");
  ReadOptions old;
  old.check_scan = false;
  expect_silent(read(old));
}

TEST_F(TwoFrames, TheDescriptionOfAnMrIsRead) {
  description = "TE=8.4;Time=101010.000";
  const auto scan = read();
  expect_asks(scan, Ask::doubt, "bone is dark");
  EXPECT_EQ(scan->modality, "MR");
  description = "Time=101010.000";
  expect_silent(read());
}

TEST_F(TwoFrames, OfNrrdDirectionsAndSpacings) {
  const auto read = [&](const std::string& spacings) {
    std::ofstream(path("a.nrrd"), std::ios::binary)
        << "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 3 3\nencoding: raw\nspace: "
           "left-posterior-superior\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\n"
        << spacings << "\n"
        << std::string(27, 'a');
    return read_path(path("a.nrrd"));
  };
  expect_silent(read(""));
  expect_silent(read("spacings: 0.5 0.5 0.5\n"));
  expect_silent(read("spacings: nan nan nan\n"));
  expect_asks(read("spacings: 1 1 1\n"), Ask::doubt,
              "by its space directions, 1 x 1 x 1 mm by its "
              "spacings");
}

TEST_F(TwoFrames, OfMetaImageTheModality) {
  const auto read = [&](const std::string& modality) {
    std::ofstream(path("a.mha"), std::ios::binary)
        << "ObjectType = Image\nNDims = 3\nDimSize = 3 3 3\nElementSpacing = 1 1 1\n"
        << modality << "ElementType = MET_CHAR\nElementDataFile = LOCAL\n"
        << "aB\x90"
           "aC\x91"
           "aD\x92"
           "aE\x93"
           "aF\x94"
           "aG\x95"
           "aH\x96"
           "aI\x97"
           "aJ\x98";
    return read_path(path("a.mha"));
  };
  expect_silent(read(""));
  expect_silent(read("Modality = MET_MOD_CT\n"));
  expect_silent(read("Modality = MET_MOD_UNKNOWN\n"));
  expect_asks(read("Modality = MET_MOD_MR\n"), Ask::doubt, "bone is dark");
}

// ---- other kinds of picture

TEST(Doubts, WhatIsNoCtIsNamed) {
  BURR_NEEDS_DATA("reports3/X6_not_ct");
  const auto mr = read_path(report("X6_not_ct/mr_t1.zip"));
  expect_asks(mr, Ask::doubt, "magnetic resonance (MR): bone is dark in it");
  EXPECT_EQ(mr->modality, "MR");
  const auto dose = read_path(report("X6_not_ct/rtdose.zip"));
  expect_asks(dose, Ask::doubt, "modality RTDOSE and shows a dose of radiation");
  EXPECT_EQ(dose->modality, "RTDOSE");
}

TEST_F(AbsentFiles, TheKindOfPictureIsThatOfModalityOrSopClass) {
  struct Kind {
    const char *modality, *sop_class, *asked;  // asked: none if nullptr
  };
  for (const Kind& one : {Kind{"CT", "1.2.840.10008.5.1.4.1.1.2", nullptr},
                          {"", "1.2.840.10008.5.1.4.1.1.2.1", nullptr},
                          {"OT", "1.2.840.10008.5.1.4.1.1.7", nullptr},
                          {"PT", "1.2.840.10008.5.1.4.1.1.128", "modality PT"},
                          {"NM", "1.2.840.10008.5.1.4.1.1.20", "modality NM"},
                          {"US", "1.2.840.10008.5.1.4.1.1.3.1", "ultrasound"},
                          {"", "1.2.840.10008.5.1.4.1.1.4", "bone is dark"},
                          {"OPT", "1.2.840.10008.5.1.4.1.1.77.1.5.4", "modality OPT"},
                          {"CT", "1.2.840.10008.5.1.4.1.1.4", "CT by its Modality, but MR"}}) {
    slices(1, 5, [&](DicomSlice& slice, int) {
      slice.set(0x00080060, "CS", one.modality).set(0x00080016, "UI", one.sop_class);
    });
    const auto scan = read_path(folder);
    if (one.asked == nullptr)
      expect_silent(scan);
    else
      expect_asks(scan, Ask::doubt, one.asked);
  }
}

// ---- dark is dense

double mm3_above(const Scan& scan, float level) {
  const auto count =
      std::count_if(scan.values.begin(), scan.values.end(), [&](float v) { return v >= level; });
  return static_cast<double>(count) * scan.spacing_mm.prod();
}

TEST(Doubts, InvertedValuesAreTurned) {
  BURR_NEEDS_DATA("reports3/X2_mono1");
  const auto control = read_path(report("X2_mono1/hu_control.zip"));
  const auto scan = read_path(report("X2_mono1/inverted.zip"));
  expect_silent(control);
  expect_silent(scan);
  EXPECT_TRUE(control->hounsfield && !says(*control, "turned round")) << all_of(*control);
  EXPECT_TRUE(!scan->hounsfield && says(*scan, "turned round")) << all_of(*scan);
  // 560 HU is the brightest thing again, and air the darkest
  const auto range = std::minmax_element(scan->values.begin(), scan->values.end());
  EXPECT_LT(scan->values.front(), *range.first + 0.1 * (*range.second - *range.first));
  const double middle = 0.5 * (double{*range.first} + double{*range.second});
  EXPECT_GT(mm3_above(*scan, static_cast<float>(middle)), 0);
  ReadOptions old;  // as recordings of that time were made
  old.check_scan = false;
  const auto before = read_path(report("X2_mono1/inverted.zip"), old);
  ASSERT_TRUE(before.ok());
  EXPECT_TRUE(says(*before, "dark is dense here")) << all_of(*before);
  for (std::size_t v = 0; v < scan->values.size(); v += 977)
    EXPECT_EQ(scan->values[v] + before->values[v], *range.first + *range.second);
}

// A bright or dark cube in the middle of 12^3 voxels.
class Inverted : public test::FolderTest {
 protected:
  Result<Scan> read(int air, int body, const std::function<void(DicomSlice&)>& change) {
    for (int k = 0; k < 12; ++k) {
      DicomSlice slice;
      slice.rows = slice.columns = 12;
      slice.at(k, k + 1);
      slice.elements.erase(0x00281052);
      slice.elements.erase(0x00281053);
      change(slice);
      std::string bytes = slice.bytes();
      for (int j = 0; j < 12; ++j)
        for (int i = 0; i < 12; ++i) {
          const bool inside = std::min({i, j, k}) > 3 && std::max({i, j, k}) < 8;
          const int value = (inside ? body : air) + (i * 7 + j * 5 + k * 3) % 11;
          const std::size_t at = bytes.size() - 288 + 2 * static_cast<std::size_t>(12 * j + i);
          bytes[at] = static_cast<char>(value & 0xFF);
          bytes[at + 1] = static_cast<char>(value >> 8);
        }
      std::ofstream(path(std::to_string(k) + ".dcm"), std::ios::binary) << bytes;
    }
    return read_path(folder);
  }
  // The body is brighter than the air around it.
  static bool bright(const Scan& scan) {
    const auto at = [&](std::size_t n) { return scan.values[n + 12 * (n + 12 * n)]; };
    return at(6) > at(0) + 100;
  }
};

TEST_F(Inverted, ByMonochrome1AndByTheShapeOfThePresentationLut) {
  const auto mono1 = [](DicomSlice& s) { s.set(0x00280004, "CS", "MONOCHROME1"); };
  const auto shape = [](DicomSlice& s) { s.set(0x20500020, "CS", "INVERSE"); };
  for (const auto& say : {std::function<void(DicomSlice&)>(mono1), {shape}}) {
    const auto scan = read(3000, 400, say);
    expect_silent(scan);
    EXPECT_TRUE(bright(*scan) && says(*scan, "turned round")) << all_of(*scan);
  }
  // the header is wrong: the air around is dark already
  const auto wrong = read(400, 3000, mono1);
  expect_asks(wrong, Ask::doubt, "its corners, where air lies around a body, are dark");
  EXPECT_TRUE(bright(*wrong));
  const auto plain = read(400, 3000, [](DicomSlice& s) { s.set(0x20500020, "CS", "IDENTITY"); });
  expect_silent(plain);
  EXPECT_TRUE(bright(*plain));
}

TEST_F(Inverted, HounsfieldUnitsStayAsTheyAre) {
  const auto scan = read(24, 1584, [](DicomSlice& s) {
    s.set(0x00280004, "CS", "MONOCHROME1");
    s.set(0x00281052, "DS", "-1024").set(0x00281053, "DS", "1").set(0x00281054, "LO", "HU");
  });
  expect_silent(scan);
  EXPECT_TRUE(scan->hounsfield && bright(*scan)) << all_of(*scan);
}

// ---- real scans give no cause for a question

TEST(Doubts, RealScansAreNotQuestioned) {
  for (const char* name : {"head_ct", "headsq", "jaw_cbct", "spine_lumbar", "spine_thorax",
                           "mouse_skull", "skull_phantom", "temporal_bone"}) {
    BURR_NEEDS_DATA(name);
    for (const auto& entry : std::filesystem::directory_iterator(test::data_dir() / name)) {
      const std::string ending = entry.path().extension().string();
      if (!entry.is_directory() && ending != ".nrrd" && ending != ".gz" && ending != ".mha" &&
          ending != ".mhd")
        continue;
      SCOPED_TRACE(entry.path().string());
      const auto scan = read_path(entry.path());
      if (scan.ok()) expect_silent(scan);  // notes beside a scan are no scan
    }
  }
}

}  // namespace
}  // namespace burr::io
