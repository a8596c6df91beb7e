// False headers: each was found by a fuzzer (docs/develop/fuzzing.md) or while a fuzzer was
// written, and is made by hand here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"

namespace burr::io {
namespace {

class OddHeader : public test::FolderTest {
 protected:
  std::string file(const std::string& name, const std::string& bytes) {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  static Result<Scan> read(const std::string& path) {
    NoProgress progress;
    return read_scan(path, {}, progress);
  }
  // the sentence with which it is refused
  static std::string refusal(const std::string& path) {
    const auto scan = read(path);
    EXPECT_FALSE(scan.ok());
    if (scan.ok()) return "";
    EXPECT_EQ(scan.error().trouble, Trouble::data);
    return scan.error().text;
  }
};

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

std::string nrrd(const std::string& more, const std::string& data = std::string(8, '\1')) {
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n" + more + "\n" + data;
}

// A complete slice of 2 x 2 pixels with these facts, explicit little endian.
struct Slice {
  std::string position = "0\\0\\0", slope = "1", intercept = "0", modality = "CT";

  static void element(std::string& out, unsigned tag, const char* vr, std::string value) {
    if (value.size() % 2 != 0) value += ' ';
    for (const unsigned n : {tag >> 16, tag & 0xFFFFU}) {
      out += static_cast<char>(n & 0xFF);
      out += static_cast<char>(n >> 8);
    }
    out += vr;
    if (std::string(vr) == "OW") out += std::string(2, '\0');
    out += static_cast<char>(value.size() & 0xFF);
    out += static_cast<char>(value.size() >> 8);
    if (std::string(vr) == "OW") out += std::string(2, '\0');
    out += value;
  }
  [[nodiscard]] std::string bytes() const {
    const auto number = [](int n) { return std::string{static_cast<char>(n), '\0'}; };
    std::string out = std::string(128, '\0') + "DICM";
    element(out, 0x00020010, "UI", std::string("1.2.840.10008.1.2.1\0", 20));
    element(out, 0x00080060, "CS", modality);
    element(out, 0x0020000E, "UI", "1.2.3.4 ");
    element(out, 0x00200032, "DS", position);
    element(out, 0x00200037, "DS", "1\\0\\0\\0\\1\\0");
    element(out, 0x00280010, "US", number(2));
    element(out, 0x00280011, "US", number(2));
    element(out, 0x00280030, "DS", "0.5\\0.5");
    element(out, 0x00280100, "US", number(16));
    element(out, 0x00280101, "US", number(16));
    element(out, 0x00280102, "US", number(15));
    element(out, 0x00280103, "US", number(0));
    element(out, 0x00281052, "DS", intercept);
    element(out, 0x00281053, "DS", slope);
    element(out, 0x7FE00010, "OW", std::string(8, '\1'));
    return out;
  }
};

TEST_F(OddHeader, AFileOfNumbersAloneIsRefusedAndItsHeaderAskedFor) {
  EXPECT_TRUE(has(refusal(file("a.raw", std::string(4000, '\7'))), "give its header"));
  EXPECT_TRUE(
      has(refusal(file("a.txt", std::string(4000, '\7'))), "is not a file that burr reads"));
}

TEST_F(OddHeader, ARangeOfAllNumbersIsNoListOfFiles) {
  // the difference of these two does not fit into 64 bits; it was once taken as one file
  const std::string all = "data file: a%d 9223372036854775807 -9223372036854775808 ";
  for (const char* step : {"1", "-1", "-9223372036854775808"})
    EXPECT_TRUE(has(refusal(file("a.nhdr", nrrd(all + step + "\n"))), "the range of numbers"));
}

TEST_F(OddHeader, AColourThatIsNoNumberIsLeftOut) {
  const auto scan = read(file("a.seg.nrrd", nrrd("Segment0_Name:=bone\nSegment0_LabelValue:=1\n"
                                                 "Segment0_Color:=nan 2 -1\n")));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->label_names.size(), 1U);
  EXPECT_FLOAT_EQ(scan->label_names[0].colour[0], Label{}.colour[0]);
  EXPECT_FLOAT_EQ(scan->label_names[0].colour[1], 1);
  EXPECT_FLOAT_EQ(scan->label_names[0].colour[2], 0);
}

TEST_F(OddHeader, AColourInATableOfTissuesMustBeNumbers) {
  std::string voxels(16 * 16 * 16, '\0');
  std::fill(voxels.begin(), voxels.begin() + 2048, '\1');
  const auto scan =
      read(file("a.nrrd",
                "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 16 16 16\nspacings: 1 1 1\n"
                "encoding: raw\n\n" +
                    voxels));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  scenario::BoneRecipe options;
  options.labels = file("t.toml", "[[label]]\nvalue = 1\ncolour = [nan, 0, inf]\n");
  const auto plan = importing::plan_import(*scan, options);
  ASSERT_FALSE(plan.ok());
  EXPECT_TRUE(has(plan.error().text, "t.toml: label 1: colour must be three numbers"));
}

TEST_F(OddHeader, WhatAFileSaysStandsInASentenceAsOneShortLine) {
  const std::string nasty = std::string("\x1B[2Jx\rx") + std::string(100'000, 'y');
  const std::vector<std::string> fields = {"type: " + nasty,          "encoding: " + nasty,
                                           "sizes: 2 2 " + nasty,     "byte skip: " + nasty,
                                           "data file: x\x1B[2Jx\rx", "data file: " + nasty};
  for (const std::string& field : fields) {
    const auto scan = read(file("a.nrrd", nrrd(field + "\n")));
    ASSERT_FALSE(scan.ok()) << field.substr(0, 20);
    EXPECT_LT(scan.error().text.size(), 500U) << field.substr(0, 20);
    for (const char c : scan.error().text) EXPECT_TRUE(c >= ' ' || c < 0) << field.substr(0, 20);
  }
}

TEST_F(OddHeader, APlaceWhereNoPatientLiesIsRefused) {
  for (const char* place : {"(1e300,0,0)", "(0,-1e7,0)"})
    EXPECT_TRUE(has(refusal(file("a.nrrd", nrrd(std::string("space origin: ") + place + "\n"))),
                    "are not valid"));
}

TEST_F(OddHeader, SlicesShiftedOutOfSightAreNoVolume) {
  for (const char* shift : {"1e15", "-1e300"}) {
    std::filesystem::create_directory(path("s"));
    for (int n = 0; n < 3; ++n) {
      Slice slice;
      slice.position = std::string(n == 1 ? shift : "0") + "\\0\\" + std::to_string(n);
      file("s/" + std::to_string(n), slice.bytes());
    }
    EXPECT_TRUE(has(refusal(path("s")), "too far apart")) << shift;
  }
}

TEST_F(OddHeader, ARescaleThatMakesNoNumberIsRefused) {
  Slice slice;
  slice.slope = "1e300";
  EXPECT_TRUE(has(refusal(file("a.dcm", slice.bytes())), "Rescale Slope of 1e+300"));
  slice.slope = "2";
  slice.intercept = "-1e39";
  EXPECT_TRUE(has(refusal(file("a.dcm", slice.bytes())), "Intercept of -1e+39"));
  slice.intercept = "-1024";
  EXPECT_TRUE(read(file("a.dcm", slice.bytes())).ok());
}

// Straightening shifted slices adds weighted values: near the largest float the sum overflowed.
TEST_F(OddHeader, ValuesNoScannerMakesAreAirAndStayFinite) {
  const std::vector<float> values = {3e38F, -3e38F, 3e38F, -3e38F, 7, -3e38F, 3e38F, 5};
  const std::string data(reinterpret_cast<const char*>(values.data()),
                         values.size() * sizeof(float));
  const auto scan = read(file("far.nrrd",
                              "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                              "endian: little\nspace: left-posterior-superior\n"
                              "space directions: (1,0,0) (0,1,0) (0,0.5,1)\n\n" +
                                  data));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  for (const float v : scan->values) {
    ASSERT_TRUE(std::isfinite(v));
    EXPECT_LE(std::abs(v), 10);
  }
  EXPECT_TRUE(std::any_of(scan->notices.begin(), scan->notices.end(), [](const std::string& n) {
    return has(n, "6 voxels hold no finite number");
  }));
}

}  // namespace
}  // namespace burr::io
