// Label maps as other programs write them: values above 255, floats, gaps in the numbering of
// segments, layers, names in a NIfTI extension; and files that are packed twice.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>

#include "burr/io/read/label_lists.h"
#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"
#include "support/data.h"

namespace burr::io {
namespace {

Result<Scan> read_file(const std::filesystem::path& path) {
  NoProgress progress;
  return read_scan(path, {}, progress);
}

bool says(const Scan& scan, const std::string& words) {
  for (const std::string& notice : scan.notices)
    if (notice.find(words) != std::string::npos) return true;
  return false;
}

std::map<int, std::size_t> counts(const Scan& scan) {
  std::map<int, std::size_t> out;
  for (const std::uint8_t value : scan.labels) ++out[value];
  return out;
}

std::string name_of(const Scan& scan, int value) {
  for (const Label& label : scan.label_names)
    if (label.value == value) return label.name;
  return {};
}

class Labels : public test::FolderTest {
 protected:
  // A .seg.nrrd of 12^3 voxels; at(i, j, k) gives each sample of the type.
  template <class T, class F>
  std::string nrrd(const char* type, const std::string& keys, F at, const char* name = "a.seg.nrrd",
                   int layers = 1) {
    std::ofstream file(path(name), std::ios::binary);
    file << "NRRD0004\ntype: " << type << "\ndimension: " << (layers > 1 ? 4 : 3)
         << "\nspace: left-posterior-superior\nsizes: "
         << (layers > 1 ? std::to_string(layers) + " " : "")
         << "12 12 12\nspace directions: " << (layers > 1 ? "none " : "")
         << "(1,0,0) (0,1,0) (0,0,1)\nkinds: " << (layers > 1 ? "list " : "")
         << "domain domain domain\nencoding: raw\nendian: little\n"
         << "space origin: (0,0,0)\n"
         << keys << "\n";
    for (int k = 0; k < 12; ++k)
      for (int j = 0; j < 12; ++j)
        for (int i = 0; i < 12; ++i)
          for (int layer = 0; layer < layers; ++layer) {
            const T value = at(i, j, k, layer);
            file.write(reinterpret_cast<const char*>(&value), sizeof value);
          }
    return path(name);
  }
  static std::string segment(int n, const std::string& name, int value, int layer = 0,
                             const std::string& more = "") {
    const std::string prefix = "Segment" + std::to_string(n) + "_";
    return prefix + "ID:=s" + std::to_string(n) + "\n" + prefix + "Name:=" + name + "\n" + prefix +
           "LabelValue:=" + std::to_string(value) + "\n" + prefix +
           "Layer:=" + std::to_string(layer) + "\n" + more;
  }
};

TEST_F(Labels, Above255GetNumbersAndKeepTheirNames) {
  const auto scan = read_file(nrrd<std::uint16_t>(
      "ushort", segment(0, "Mandible", 1001) + segment(1, "Nerve", 2035) + segment(2, "Tooth", 7),
      [](int i, int, int, int) {
        return static_cast<std::uint16_t>(i < 4 ? 1001 : i < 6 ? 2035 : i < 7 ? 7 : 0);
      }));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(counts(*scan), (std::map<int, std::size_t>{{0, 720}, {1, 576}, {2, 288}, {7, 144}}));
  EXPECT_EQ(name_of(*scan, 1), "Mandible");
  EXPECT_EQ(name_of(*scan, 2), "Nerve");
  EXPECT_EQ(name_of(*scan, 7), "Tooth");
  EXPECT_TRUE(says(*scan, "1001 is now 1 (Mandible), 2035 is now 2 (Nerve)"));
}

TEST_F(Labels, MoreThan255AreRefusedInOneSentence) {
  const auto scan =
      read_file(nrrd<std::uint16_t>("ushort", segment(0, "Bone", 1), [](int i, int j, int k, int) {
        return static_cast<std::uint16_t>((i + 12 * j + 144 * k) % 300);
      }));
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("more than 255 different labels"), std::string::npos)
      << scan.error().text;
}

TEST_F(Labels, MoreThan255WithoutNamesAreRefusedToo) {
  const auto scan = read_file(nrrd<std::uint16_t>(
      "ushort", "",
      [](int, int j, int k, int) {
        return static_cast<std::uint16_t>(j + 12 * k == 0 ? 0 : 2 * (j + 12 * k));
      },
      "many.nrrd", 1));
  // 144 different values: they fit
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_FALSE(scan->labels.empty());
  const auto many = read_file(nrrd<std::uint16_t>(
      "ushort", "",
      [](int i, int j, int k, int) {
        return static_cast<std::uint16_t>((i == 11 ? 1 : 0) + 2 * (j + 12 * k));
      },
      "more.nrrd", 1));
  ASSERT_FALSE(many.ok());
  EXPECT_NE(many.error().text.find("more than 255"), std::string::npos) << many.error().text;
}

TEST_F(Labels, OlderFilesHaveOneLayerForEachSegment) {
  const auto scan = read_file(nrrd<std::uint8_t>(
      "uchar", "Segment0_Name:=Bone\nSegment1_Name:=Nerve\n",
      [](int i, int, int, int layer) { return static_cast<std::uint8_t>(i == 2 + layer ? 1 : 0); },
      "a.seg.nrrd", 2));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(name_of(*scan, 1), "Bone");
  EXPECT_EQ(name_of(*scan, 2), "Nerve");
}

TEST_F(Labels, OtherPackingsAreNamed) {
  std::ofstream(path("a.nii.xz"), std::ios::binary) << std::string("\xFD\x37zXZ\0\0\0\0", 9);
  const auto scan = read_file(path("a.nii.xz"));
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("packed with xz"), std::string::npos) << scan.error().text;
}

TEST_F(Labels, GreyValuesStayGrey) {
  // few values, but never flat; and flat ones without a background
  const auto noisy = read_file(nrrd<std::int16_t>(
      "short", "",
      [](int i, int j, int k, int) {
        return static_cast<std::int16_t>(300 * ((i * 7 + j * 5 + k * 3) % 5));
      },
      "noisy.nrrd"));
  ASSERT_TRUE(noisy.ok()) << noisy.error().text;
  EXPECT_TRUE(noisy->labels.empty());
  const auto offset = read_file(nrrd<std::int16_t>(
      "short", "",
      [](int i, int, int, int) { return static_cast<std::int16_t>(i < 6 ? 24 : 2224); },
      "offset.nrrd"));
  ASSERT_TRUE(offset.ok()) << offset.error().text;
  EXPECT_TRUE(offset->labels.empty());
  // whole numbers first, then one that no integer holds
  const auto huge = read_file(nrrd<float>(
      "float", "", [](int, int, int k, int) { return k < 3   ? 0.0F
                                                     : k < 6 ? 1.0F
                                                             : 1.8e19F; },
      "huge.nrrd"));
  ASSERT_TRUE(huge.ok()) << huge.error().text;
  EXPECT_TRUE(huge->labels.empty());
  EXPECT_FALSE(says(*huge, "near to whole numbers"));
}

TEST_F(Labels, FloatsNearWholeNumbersAreRounded) {
  const auto value = [](float unit) {
    return [unit](int, int, int k, int) {
      return unit * static_cast<float>(k < 3 ? 2 : k < 6 ? 1 : 0);
    };
  };
  const auto near = read_file(nrrd<float>("float", "", value(0.9996F), "near.nrrd"));
  ASSERT_TRUE(near.ok()) << near.error().text;
  const auto absent = read_file(nrrd<float>(
      "float", segment(0, "Bone", 1) + segment(1, "Absent", 1001), value(1), "absent.seg.nrrd"));
  ASSERT_TRUE(absent.ok()) << absent.error().text;
  EXPECT_EQ(absent->label_names.size(), 1U);
  EXPECT_EQ(counts(*near), (std::map<int, std::size_t>{{0, 864}, {1, 432}, {2, 432}}));
  EXPECT_TRUE(says(*near, "to within 0.001"));
  const auto off = read_file(nrrd<float>("float", "", value(0.99F), "off.nrrd"));
  ASSERT_TRUE(off.ok()) << off.error().text;
  EXPECT_TRUE(off->labels.empty());
  EXPECT_TRUE(says(*off, "near to whole numbers"));
}

TEST_F(Labels, AGapInTheNumbersOfSegmentsLosesNoName) {
  const auto scan = read_file(nrrd<std::uint8_t>(
      "uchar",
      segment(0, "Bone", 1, 0, "Segment0_Color:=255 128 0\n") +
          segment(60, "Nervus facialis", 2, 0,
                  "Segment60_Tags:=A:b|TerminologyEntry:List~SCT^123037004^Anatomical Structure~"
                  "SCT^56052001^Facial nerve~^^~Other~^^~^^|\n") +
          segment(61, "Twin", 1),
      [](int i, int, int, int) {
        return static_cast<std::uint8_t>(i < 3 ? 2 : i < 6 ? 1 : 0);
      }));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(name_of(*scan, 1), "Bone");
  EXPECT_EQ(name_of(*scan, 2), "Nervus facialis");
  EXPECT_EQ(scan->label_names[1].meaning, "Facial nerve SCT 56052001");
  EXPECT_NEAR(scan->label_names[0].colour[1], 128.0 / 255, 1e-6);
  EXPECT_TRUE(says(*scan, "go beyond 1"));
  EXPECT_TRUE(says(*scan, "Bone and Twin, have the same value 1"));
}

TEST_F(Labels, OfTwoLayersTheSmallerStructureStays) {
  const auto scan = read_file(nrrd<std::uint8_t>(
      "uchar", segment(0, "Bone", 1, 0) + segment(1, "Nerve", 1, 1),
      [](int i, int, int, int layer) {
        return static_cast<std::uint8_t>(layer == 0 ? (i < 8 ? 1 : 0) : (i == 4 || i == 9 ? 1 : 0));
      },
      "a.seg.nrrd", 2));
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(counts(*scan), (std::map<int, std::size_t>{{0, 432}, {1, 1008}, {2, 288}}));
  EXPECT_EQ(name_of(*scan, 1), "Bone");
  EXPECT_EQ(name_of(*scan, 2), "Nerve");
  EXPECT_TRUE(says(*scan, "in 144 voxels, the smaller one stays"));
}

TEST_F(Labels, BlanksAndPerCentSignsInNamesOfDataFiles) {
  const std::string name = "a%d 1 2 1";
  std::ofstream(path(name), std::ios::binary) << std::string(8, 'x');
  std::ofstream(path("a.mhd")) << "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = "
                                  "MET_UCHAR\nElementDataFile = "
                               << name << "\n";
  std::ofstream(path("a.nhdr")) << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: "
                                   "raw\ndata file: "
                                << name << "\n";
  for (const char* header : {"a.mhd", "a.nhdr"}) {
    const auto scan = read_file(path(header));
    EXPECT_TRUE(scan.ok()) << scan.error().text;
  }
}

TEST(LabelLists, AreReadInXmlJsonAndText) {
  const auto xml = labels_in_xml(
      "<LabelTable><Label Key=\"3\" Red=\"1\" Green=\"0.5\" Blue=\"0\" Alpha=\"1\"><![CDATA[a "
      "<b>]]>"
      "</Label><Label Key='4'>x &amp; y</Label><Label Key=\"-1\">no</Label></LabelTable>");
  ASSERT_EQ(xml.size(), 2U);
  EXPECT_EQ(xml[0].name, "a <b>");
  EXPECT_NEAR(xml[0].colour[1], 0.5, 1e-6);
  EXPECT_EQ(xml[1].name, "x & y");
  EXPECT_EQ(labels_in_json(R"({"labels": {"1": "bone", "2": {"name": "nerve"}}})").size(), 2U);
  EXPECT_EQ(labels_in_json(R"({"labels": {"background": 0, "bone": 1}})").at(0).name, "bone");
  EXPECT_EQ(labels_in_json(R"([{"name": "bone", "label": 5}])").at(0).value, 5);
  EXPECT_TRUE(labels_in_json("{").empty());
  EXPECT_TRUE(labels_in_json(std::string(100000, '[')).empty());
  const auto snap = labels_in_lut(
      "# ITK-SnAP Label Description File\n    0     0    0    0        0  0  0    \"Clear Label\"\n"
      "    1   255    0    0        1  1  1    \"Nervus facialis\"\n");
  ASSERT_EQ(snap.size(), 1U);
  EXPECT_EQ(snap[0].name, "Nervus facialis");
  EXPECT_EQ(snap[0].colour[0], 1.0F);
  const auto free = labels_in_lut("0 Unknown 0 0 0 0\n\n16  Brain-Stem  119 159 176 0\n");
  const auto slicer = labels_in_lut("\xEF\xBB\xBF# Color table\n3 Facial nerve 1 2 3 255\r\n");
  ASSERT_EQ(slicer.size(), 1U);
  EXPECT_EQ(slicer[0].name, "Facial nerve");
  ASSERT_EQ(free.size(), 1U);
  EXPECT_EQ(free[0].value, 16);
  EXPECT_TRUE(labels_in_lut("[[label]]\nvalue = 1\n").empty());
}

struct Row {
  const char* path;
  std::map<int, std::size_t> counts;  // empty: a CT in HU
  std::vector<const char*> names;
  friend void PrintTo(const Row& row, std::ostream* out) { *out << row.path; }
};

class LabelReports : public testing::TestWithParam<Row> {};

TEST_P(LabelReports, AreReadRight) {
  const std::string path = std::string("reports/") + GetParam().path;
  BURR_NEEDS_DATA(path);
  const auto scan = read_file(test::data_dir() / path);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  if (GetParam().counts.empty()) {
    EXPECT_TRUE(scan->labels.empty());
    EXPECT_TRUE(scan->hounsfield);
    return;
  }
  EXPECT_EQ(counts(*scan), GetParam().counts);
  for (const char* name : GetParam().names) {
    bool found = false;
    for (const Label& label : scan->label_names) found = found || label.name == name;
    EXPECT_TRUE(found) << name;
  }
}

using Counts = std::map<int, std::size_t>;
INSTANTIATE_TEST_SUITE_P(
    Io, LabelReports,
    testing::Values(
        Row{"N01_labels_over_255/labels.seg.nrrd",
            Counts{{0, 84952}, {1, 6440}, {2, 768}},
            {"Mandible", "Inferior alveolar nerve"}},
        Row{"N01_labels_over_255/labels.nii.gz", Counts{{0, 84952}, {1, 6440}, {2, 768}}, {}},
        Row{"N01_labels_over_255/labels_40_300.nii.gz",
            Counts{{0, 84952}, {1, 768}, {40, 6440}},
            {}},
        Row{"N02_float_labels/slope.nii.gz", Counts{{0, 84952}, {1, 5516}, {2, 924}, {3, 768}}, {}},
        Row{"N18_totalseg_names/seg.nii.gz",
            Counts{{0, 80624}, {1, 6440}, {2, 768}, {3, 4328}},
            {"mandible", "inferior_alveolar_nerve", "tongue"}},
        Row{"N04_mhd_names/blank.mhd", {}, {}}, Row{"N06_double_gz/twice.nii.gz", {}, {}},
        Row{"N06_double_gz/a.nrrd.gz", {}, {}}, Row{"N06_double_gz/a.nii.bz2", {}, {}},
        Row{"N06_double_gz/members.nii.gz", {}, {}}));

TEST_F(Labels, APackedDicomFileIsRefusedWithTheRemedy) {
  BURR_NEEDS_DATA("reports/N06_double_gz/a.dcm.gz");
  const auto scan = read_file(test::data_dir() / "reports/N06_double_gz/a.dcm.gz");
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("unpack it first"), std::string::npos) << scan.error().text;
}

}  // namespace
}  // namespace burr::io
