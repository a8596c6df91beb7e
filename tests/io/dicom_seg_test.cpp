// DICOM segmentations of shapes that are known by formula: every voxel is compared. What is missing
// or contradicts itself is refused in one sentence.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>

#include "burr/io/read/dicom_seg.h"
#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"
#include "io/seg_writer.h"
#include "support/data.h"

namespace burr::io {
namespace {

using test::SegFile;

constexpr int kSlices = 10;

// Segment 1 a box of 6 x 5 x 4, segment 2 a ball that overlaps it, in slices 1 to 8.
bool in_box(int i, int j, int k) { return i >= 2 && i < 8 && j >= 3 && j < 8 && k >= 1 && k < 5; }
bool in_ball(int i, int j, int k) {
  const int x = i - 8, y = j - 6, z = k - 5;
  return x * x + y * y + z * z <= 9;
}
int box_and_ball(int segment, int i, int j, int k) {
  return (segment == 1 ? in_box(i, j, k) : in_ball(i, j, k)) ? 1 : 0;
}

class DicomSeg : public test::FolderTest {
 protected:
  static SegFile two() {
    SegFile seg;
    seg.at = box_and_ball;
    seg.segments = {{1, "Segment_1", "SCT", "91609006", "Mandible", ""},
                    {2, "Nerv", "SRT", "T-A8040", "Facial nerve", ""}};
    // not in the order of the slices, and only where the segment is
    for (const int k : {4, 2, 3, 1}) seg.frames.push_back({1, k});
    for (int k = 8; k >= 2; --k) seg.frames.push_back({2, k});
    return seg;
  }
  Result<Scan> read(const SegFile& seg, const ReadOptions& options = {}) {
    seg.write(path("a.dcm"));
    return read_path(path("a.dcm"), options);
  }
  static Result<Scan> read_path(const std::string& path, const ReadOptions& options = {}) {
    NoProgress progress;
    return read_scan(path, options, progress);
  }
  static bool says(const Scan& scan, const std::string& words) {
    return std::any_of(scan.notices.begin(), scan.notices.end(),
                       [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }
  static int label(const Scan& scan, int i, int j, int k) {
    return scan.labels[static_cast<std::size_t>((k * scan.size.y() + j) * scan.size.x() + i)];
  }
  // How many voxels differ from what f says.
  static int wrong(const Scan& scan, const std::function<int(int, int, int)>& f) {
    int n = 0;
    for (int k = 0; k < scan.size.z(); ++k)
      for (int j = 0; j < scan.size.y(); ++j)
        for (int i = 0; i < scan.size.x(); ++i) n += label(scan, i, j, k) != f(i, j, k) ? 1 : 0;
    return n;
  }
};

TEST_F(DicomSeg, BitsRunOnOverTheFrames) {
  const auto scan = read(two());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->format, "DICOM segmentation");
  // slices 1 to 8 of the formula
  ASSERT_EQ(scan->size, math::Ijk(13, 11, 8));
  EXPECT_TRUE(scan->spacing_mm.isApprox(math::Vec3(0.4, 0.5, 0.6), 1e-9));
  EXPECT_TRUE(scan->origin_mm.isApprox(math::Vec3(1, 2, 3.6), 1e-9));
  EXPECT_TRUE(scan->axes.isApprox(math::Mat3::Identity(), 1e-9));
  int box = 0, ball = 0, both = 0;
  for (int k = 0; k < kSlices; ++k)
    for (int j = 0; j < 11; ++j)
      for (int i = 0; i < 13; ++i) {
        box += in_box(i, j, k) ? 1 : 0;
        ball += in_ball(i, j, k) ? 1 : 0;
        both += in_box(i, j, k) && in_ball(i, j, k) ? 1 : 0;
      }
  ASSERT_EQ(box, 6 * 5 * 4);
  ASSERT_EQ(ball, 123);  // lattice points in a ball of radius 3 (OEIS A000605)
  ASSERT_GT(both, 0);
  // the box has fewer voxels, so it stays where both are
  EXPECT_EQ(wrong(*scan,
                  [](int i, int j, int k) {
                    return in_box(i, j, k + 1) ? 1 : in_ball(i, j, k + 1) ? 2 : 0;
                  }),
            0);
  EXPECT_TRUE(says(*scan, "overlap in " + std::to_string(both) + " voxels"));
}

TEST_F(DicomSeg, NamesColoursAndCodes) {
  SegFile seg = two();
  seg.segments[0].lab = "8AFBD19EC6AA";  // red: L 54.29, a 80.80, b 69.89
  seg.segments[1].label = "H\xF6rnerv";
  seg.characters = "ISO_IR 100";
  const auto scan = read(seg);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->label_names.size(), 2U);
  EXPECT_EQ(scan->label_names[0].name, "Segment_1");
  EXPECT_EQ(scan->label_names[0].meaning, "Mandible SCT 91609006");
  EXPECT_EQ(scan->label_names[1].name, "H\xC3\xB6rnerv");
  EXPECT_EQ(scan->label_names[1].meaning, "Facial nerve SRT T-A8040");
  EXPECT_NEAR(scan->label_names[0].colour[0], 1, 0.01);
  EXPECT_NEAR(scan->label_names[0].colour[1], 0, 0.03);
  EXPECT_NEAR(scan->label_names[0].colour[2], 0, 0.03);
}

// Published values of the corners of sRGB in CIELab of D50 (Lindbloom).
TEST_F(DicomSeg, ColoursOfCielab) {
  struct Row {
    double l, a, b;
    std::array<float, 3> rgb;
  };
  for (const Row& row :
       {Row{100, 0, 0, {1, 1, 1}}, Row{0, 0, 0, {0, 0, 0}}, Row{54.29, 80.80, 69.89, {1, 0, 0}},
        Row{87.82, -79.27, 80.99, {0, 1, 0}}, Row{29.57, 68.30, -112.03, {0, 0, 1}},
        Row{53.39, 0, 0, {0.5F, 0.5F, 0.5F}}}) {
    const auto stored = [](double v, double low, double span) {
      return static_cast<int>(std::lround((v - low) / span * 65535));
    };
    const auto rgb = srgb_of_dicom_lab(
        {stored(row.l, 0, 100), stored(row.a, -128, 255), stored(row.b, -128, 255)});
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(rgb[c], row.rgb[c], 0.02) << row.l << " part " << c;
  }
}

TEST_F(DicomSeg, MissingFramesAreEmptySlices) {
  SegFile seg = two();
  std::erase_if(seg.frames, [](const SegFile::Frame& f) { return f.segment == 2; });
  seg.frames.push_back({2, 8});
  const auto scan = read(seg);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->size.z(), 8);
  EXPECT_TRUE(says(*scan, "no frame for 3 of 8 slices"));
  EXPECT_EQ(wrong(*scan,
                  [](int i, int j, int k) {
                    return in_box(i, j, k + 1) ? 1 : k == 7 && in_ball(i, j, 8) ? 2 : 0;
                  }),
            0);
  // without Spacing Between Slices the smallest distance counts: here that of slices 1 to 4
  seg.between = "";
  seg.thickness = "";
  const auto bare = read(seg);
  ASSERT_TRUE(bare.ok()) << bare.error().text;
  EXPECT_EQ(bare->size.z(), 8);
  // two frames alone: the thickness tells how many slices lie between them
  seg.frames = {{1, 2}, {2, 7}};
  seg.thickness = "0.6";
  const auto far = read(seg);
  ASSERT_TRUE(far.ok()) << far.error().text;
  EXPECT_EQ(far->size.z(), 6);
  EXPECT_TRUE(says(*far, "as thick as the file states"));
}

TEST_F(DicomSeg, HalfAndMoreOfAFractionIsInside) {
  SegFile seg = two();
  seg.type = "FRACTIONAL";
  seg.bits = 8;
  seg.most_fractional = 201;
  seg.segments.resize(1);
  seg.frames.clear();
  for (int k = 0; k < 4; ++k) seg.frames.push_back({1, k});
  seg.at = [](int, int i, int, int) { return 95 + i; };  // 101 at column 6
  const auto scan = read(seg);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(wrong(*scan, [](int i, int, int) { return 2 * (95 + i) >= 201 ? 1 : 0; }), 0);
  EXPECT_TRUE(says(*scan, "101 of 201"));
}

TEST_F(DicomSeg, LabelMapOf16Bit) {
  SegFile seg = two();
  seg.sop_class = "1.2.840.10008.5.1.4.1.1.66.7";
  seg.type = "LABELMAP";
  seg.bits = 16;
  seg.segments[1].number = 700;
  seg.frames.clear();
  for (const int k : {8, 1, 2, 3, 4, 5, 6, 7}) seg.frames.push_back({0, k});
  seg.at = [](int, int i, int j, int k) {
    return in_box(i, j, k) ? 1 : in_ball(i, j, k) ? 700 : 0;
  };
  const auto scan = read(seg);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(wrong(*scan,
                  [](int i, int j, int k) {
                    return in_box(i, j, k + 1) ? 1 : in_ball(i, j, k + 1) ? 2 : 0;
                  }),
            0);
  ASSERT_EQ(scan->label_names.size(), 2U);
  EXPECT_EQ(scan->label_names[1].name, "Nerv");
  EXPECT_EQ(scan->label_names[1].value, 2);
  EXPECT_EQ(scan->label_names[1].in_file, 700);
  SegFile full = seg;  // nothing but one label above 255
  full.at = [](int, int, int, int) { return 700; };
  const auto one = read(full);
  ASSERT_TRUE(one.ok()) << one.error().text;
  EXPECT_EQ(wrong(*one, [](int, int, int) { return 1; }), 0);
  seg.frames.push_back({0, 3});
  const auto twice = read(seg);
  ASSERT_FALSE(twice.ok());
  EXPECT_NE(twice.error().text.find("two of its frames lie at the same place"), std::string::npos);
}

// Each frame as literal runs of PS3.5 annex G.
std::string rle(const std::string& frame) {
  std::string out = std::string("\1\0\0\0\x40\0\0\0", 8) + std::string(56, '\0');
  for (std::size_t at = 0; at < frame.size(); at += 128) {
    const std::string run = frame.substr(at, 128);
    out += static_cast<char>(run.size() - 1);
    out += run;
  }
  if (out.size() % 2 != 0) out += '\0';
  return out;
}

std::string even(std::string text) {
  if (text.size() % 2 != 0) text += '\0';
  return text;
}

std::string deflated(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(bytes.size() + 100, '\0');
  std::vector<Bytef> in(bytes.begin(), bytes.end());
  stream.next_in = in.data();
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST_F(DicomSeg, PackedFiles) {
  SegFile seg = two();
  seg.sop_class = "1.2.840.10008.5.1.4.1.1.66.7";
  seg.type = "LABELMAP";
  seg.bits = 8;
  seg.frames.clear();
  for (int k = 0; k < kSlices; ++k) seg.frames.push_back({0, k});
  seg.at = [](int, int i, int j, int k) { return in_box(i, j, k) ? 1 : in_ball(i, j, k) ? 2 : 0; };
  const auto right = [](int i, int j, int k) {
    return in_box(i, j, k) ? 1 : in_ball(i, j, k) ? 2 : 0;
  };

  SegFile runs = seg;
  const std::string plain = seg.pixels();
  const auto item = [](const std::string& bytes) {
    return SegFile::number16(0xFFFE) + SegFile::number16(0xE000) +
           SegFile::number16(bytes.size() & 0xFFFF) + SegFile::number16(bytes.size() >> 16) + bytes;
  };
  runs.pixels_cut = item("");
  for (std::size_t k = 0; k < kSlices; ++k)
    runs.pixels_cut += item(rle(plain.substr(k * 143, 143)));
  runs.pixels_cut += std::string("\xFE\xFF\xDD\xE0\0\0\0\0", 8);
  runs.encapsulated = true;
  runs.syntax = "1.2.840.10008.1.2.5";
  const auto unpacked = read(runs);
  ASSERT_TRUE(unpacked.ok()) << unpacked.error().text;
  EXPECT_EQ(wrong(*unpacked, right), 0);

  // the whole data set deflated, with single bits inside
  const auto truth_bits = [](int i, int j, int k) {
    return in_box(i, j, k + 1) ? 1 : in_ball(i, j, k + 1) ? 2 : 0;
  };
  SegFile bits = two();
  bits.syntax = "1.2.840.10008.1.2.1.99";
  const std::string packed = deflated(bits.data_set());
  std::ofstream(path("deflated.dcm"), std::ios::binary) << bits.meta() << packed;
  const auto inflated = read_path(path("deflated.dcm"));
  ASSERT_TRUE(inflated.ok()) << inflated.error().text;
  EXPECT_EQ(wrong(*inflated, truth_bits), 0);

  // each frame deflated; 143 bits are padded to 18 bytes
  SegFile frames = two();
  frames.pixels_cut = item("");
  for (const SegFile::Frame& frame : frames.frames) {
    SegFile one = frames;
    one.frames = {frame};
    frames.pixels_cut += item(even(deflated(one.pixels())));
  }
  frames.pixels_cut += std::string("\xFE\xFF\xDD\xE0\0\0\0\0", 8);
  frames.encapsulated = true;
  frames.syntax = "1.2.840.10008.1.2.8.1";
  const auto each = read(frames);
  ASSERT_TRUE(each.ok()) << each.error().text;
  EXPECT_EQ(wrong(*each, truth_bits), 0);
}

TEST_F(DicomSeg, ObliqueAndLeaningStacks) {
  // coronal: rows to the left, columns downwards; slices go to the back
  SegFile seg = two();
  seg.orientation = "1\\0\\0\\0\\0\\-1";
  seg.position = [](int k) { return "1\\" + test::DicomSlice::number(2 + 0.6 * k) + "\\9"; };
  const auto coronal = read(seg);
  ASSERT_TRUE(coronal.ok()) << coronal.error().text;
  math::Mat3 axes;
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  EXPECT_TRUE(coronal->axes.isApprox(axes, 1e-9)) << coronal->axes;
  EXPECT_TRUE(coronal->origin_mm.isApprox(math::Vec3(1, 2.6, 9), 1e-6)) << coronal->origin_mm;
  EXPECT_EQ(label(*coronal, 3, 4, 0), 1);

  // one pixel (0.4 mm) to the left a slice: upright again, every voxel moves with its slice
  seg = two();
  seg.position = [](int k) {
    return test::DicomSlice::number(1 + 0.4 * k) + "\\2\\" + test::DicomSlice::number(3 + 0.6 * k);
  };
  const auto leaning = read(seg);
  ASSERT_TRUE(leaning.ok()) << leaning.error().text;
  ASSERT_EQ(leaning->size, math::Ijk(13 + 7, 11, 8));
  EXPECT_TRUE(says(*leaning, "leans"));
  EXPECT_EQ(wrong(*leaning,
                  [](int i, int j, int k) {
                    const int from = i - k;
                    return from < 0 || from >= 13    ? 0
                           : in_box(from, j, k + 1)  ? 1
                           : in_ball(from, j, k + 1) ? 2
                                                     : 0;
                  }),
            0);
}

TEST_F(DicomSeg, SegmentsAndFramesThatDoNotMatch) {
  SegFile seg = two();
  seg.segments.push_back({3, "Stapes", "", "", "", ""});
  seg.segments.erase(seg.segments.begin());
  const auto scan = read(seg);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(says(*scan, "No frame shows these segments, so they are empty: 3 (Stapes)"));
  EXPECT_TRUE(says(*scan, "segments that it does not describe; they have no name: 1"));
}

TEST_F(DicomSeg, RefusedInOneSentence) {
  struct Row {
    const char* words;
    std::function<void(SegFile&)> change;
  };
  const std::vector<Row> rows = {
      {"do not say which of them they show",
       [](SegFile& s) {
         for (auto& f : s.frames) f.segment = 0;
         s.at = [](int, int, int, int) { return 1; };
       }},
      {"1 of its 11 frames do not say which segment", [](SegFile& s) { s.frames[3].segment = 0; }},
      {"two frames of reference",
       [](SegFile& s) { s.in_frames = SegFile::element(0x00200052, "UI", "1.2.6"); }},
      {"states no position", [](SegFile& s) { s.position = [](int) { return ""; }; }},
      {"state no orientation", [](SegFile& s) { s.orientation = ""; }},
      {"Pixel Data has 100 bytes, but 11 frames of 13 x 11 pixels need 197",
       [](SegFile& s) { s.pixels_cut = std::string(100, 'x'); }},
      {"not evenly spaced",
       [](SegFile& s) {
         s.between = s.thickness = "";
         s.position = [](int k) {
           return "1\\2\\" + test::DicomSlice::number(0.6 * k + (k == 5 ? 0.25 : 0));
         };
       }},
      {"shifted against each other",
       [](SegFile& s) {
         s.position = [](int k) {
           return std::to_string(k % 2) + "\\2\\" + test::DicomSlice::number(0.6 * k);
         };
       }},
      {"8 bits a pixel",
       [](SegFile& s) {
         s.bits = 8;
         s.type = "LABELMAP";
         s.bits = 32;
         s.at = [](int, int, int, int) { return 0; };
       }},
      {"of the type \"PROBABILITY\"", [](SegFile& s) { s.type = "PROBABILITY"; }},
      {"its frames show 300 segments",
       [](SegFile& s) {
         s.frames.clear();
         for (int n = 1; n <= 300; ++n) s.frames.push_back({n, n % 5});
       }},
  };
  for (const Row& row : rows) {
    SegFile seg = two();
    row.change(seg);
    const auto scan = read(seg);
    const bool other_bits = seg.bits == 32;
    ASSERT_FALSE(scan.ok()) << row.words;
    EXPECT_NE(scan.error().text.find(other_bits ? "32 bits a pixel" : row.words), std::string::npos)
        << scan.error().text;
    EXPECT_EQ(scan.error().text.rfind("a.dcm: ", 0), 0U) << scan.error().text;
  }
}

TEST_F(DicomSeg, BesideItsScan) {
  for (int k = 0; k < 5; ++k) {
    test::DicomSlice slice;
    slice.at(k, k + 1);
    slice.write(path("ct" + std::to_string(k) + ".dcm"));
  }
  two().write(path("seg.dcm"));
  const auto scan = read_path(folder.string());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_TRUE(scan->labels.empty());
  EXPECT_EQ(scan->series_taken, 0);
  ASSERT_EQ(scan->series.size(), 2U);
  EXPECT_NE(scan->series[1].find("#2: segmentation (SEG), 11 frames 13 x 11, 2 segments"),
            std::string::npos)
      << scan->series[1];
  EXPECT_TRUE(says(*scan, "Beside the scan lies a DICOM segmentation"));
  for (const char* wanted : {"#2", "1.2.7", "1.2.7#1"}) {
    ReadOptions options;
    options.series = wanted;
    const auto labels = read_path(folder.string(), options);
    ASSERT_TRUE(labels.ok()) << wanted << ": " << labels.error().text;
    EXPECT_EQ(labels->size, math::Ijk(13, 11, 8)) << wanted;
    EXPECT_EQ(labels->series_taken, 1);
  }
  ReadOptions options;
  options.series = "#1";
  EXPECT_TRUE(read_path(folder.string(), options)->labels.empty());
  options.series = "#3";
  const auto none = read_path(folder.string(), options);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().trouble, Trouble::usage);
}

// One object for each structure, with frames only where it is, becomes the label map of both.
TEST_F(DicomSeg, SeveralObjectsBecomeOneLabelMap) {
  SegFile box = two(), ball = two();
  box.segments = {{1, "Mandible", "", "", "", ""}};
  box.frames = {{1, 1}, {1, 2}, {1, 3}, {1, 4}};
  box.series = "1.2.71";
  ball.segments = {{1, "Nerve", "", "", "", ""}};
  ball.frames.clear();
  for (int k = 2; k <= 8; ++k) ball.frames.push_back({1, k});
  ball.at = [](int, int i, int j, int k) { return in_ball(i, j, k) ? 1 : 0; };
  ball.series = "1.2.72";
  const auto write = [&] {
    box.write(path("a.dcm"));
    ball.write(path("b.dcm"));
  };
  write();
  const auto scan = read_path(folder.string());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 8) << "slices 1 to 8";
  ASSERT_EQ(scan->label_names.size(), 2U);
  EXPECT_EQ(scan->label_names[0].name, "Mandible");
  EXPECT_EQ(scan->label_names[1].name, "Nerve");
  int boxes = 0, balls = 0, shared = 0;
  for (int k = 0; k < kSlices; ++k)
    for (int j = 0; j < 11; ++j)
      for (int i = 0; i < 13; ++i) {
        boxes += in_box(i, j, k) ? 1 : 0;
        balls += in_ball(i, j, k) ? 1 : 0;
        shared += in_box(i, j, k) && in_ball(i, j, k) ? 1 : 0;
      }
  ASSERT_NE(boxes, balls);
  EXPECT_EQ(wrong(*scan,
                  [&](int i, int j, int k) {
                    const bool in_a = in_box(i, j, k + 1), in_b = in_ball(i, j, k + 1);
                    if (in_a && in_b) return boxes < balls ? 1 : 2;
                    return in_a ? 1 : in_b ? 2 : 0;
                  }),
            0);
  EXPECT_TRUE(says(*scan, "Structures overlap in " + std::to_string(shared) + " voxels"));
  EXPECT_TRUE(says(*scan, "2 segmentations became one label map, numbered 1 to 2"));
  ASSERT_EQ(scan->series.size(), 3U);
  EXPECT_EQ(scan->series[2], "#3: all 2 segmentations as one label map");
  EXPECT_EQ(scan->series_taken, 2);
  ReadOptions options;
  options.series = "#2";
  const auto second = read_path(folder.string(), options);
  ASSERT_TRUE(second.ok()) << second.error().text;
  EXPECT_EQ(second->label_names[0].name, "Nerve");
  // two of one name get the names of their files
  ball.segments[0].label = "Mandible";
  write();
  const auto twins = read_path(folder.string());
  ASSERT_TRUE(twins.ok());
  EXPECT_EQ(twins->label_names[1].name, "Mandible (b.dcm)");
  // on other voxels they cannot be one map: the first is read, and it is said why
  ball.spacing = "0.5\\0.5";
  write();
  const auto first = read_path(folder.string());
  ASSERT_TRUE(first.ok()) << first.error().text;
  EXPECT_EQ(first->label_names.size(), 1U);
  EXPECT_EQ(first->series_taken, 0);
  EXPECT_TRUE(says(*first, "a.dcm and b.dcm have different voxels"));
  EXPECT_TRUE(says(*first, "#1 is used"));
  options.series = "#3";
  EXPECT_FALSE(read_path(folder.string(), options).ok());
}

// A liver that dcmqi wrote, and the same cut to 510 x 510 pixels, whose frames begin within a byte,
// and with deflated frames.
TEST_F(DicomSeg, OneLiverThreeTimes) {
  BURR_NEEDS_DATA("corpus/dicom/pydicom_data/liver.dcm");
  for (const char* name : {"liver", "liver_nonbyte_aligned", "liver_deflate"}) {
    const auto scan = read_path(
        (test::data_dir() / "corpus/dicom/pydicom_data" / (std::string(name) + ".dcm")).string());
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    EXPECT_EQ(std::count(scan->labels.begin(), scan->labels.end(), 1), 107098) << name;
    ASSERT_EQ(scan->label_names.size(), 1U);
    EXPECT_EQ(scan->label_names[0].meaning, "Liver SRT T-62000");
  }
}

// The same bone as a CT and as three kinds of segmentation.
TEST_F(DicomSeg, ReportedFiles) {
  BURR_NEEDS_DATA("reports/D24_seg_rtstruct");
  const std::string place = (test::data_dir() / "reports/D24_seg_rtstruct").string();
  const auto ct = read_path(place + "/all");
  ASSERT_TRUE(ct.ok()) << ct.error().text;
  for (const char* name :
       {"seg_alone", "seg_alone/SEG.dcm", "labelmap_alone", "fractional_alone"}) {
    const auto seg = read_path(place + "/" + name);
    ASSERT_TRUE(seg.ok()) << name << ": " << seg.error().text;
    ASSERT_EQ(seg->size, ct->size);
    EXPECT_TRUE(seg->origin_mm.isApprox(ct->origin_mm, 1e-6));
    std::size_t bone = 0, different = 0;
    for (std::size_t v = 0; v < seg->labels.size(); ++v) {
      bone += seg->labels[v] != 0 ? 1 : 0;
      different += (seg->labels[v] != 0) != (ct->values[v] > 300) ? 1 : 0;
    }
    EXPECT_EQ(different, 0U) << name;
    // 1045.8 mm3 of the surface at 300 HU, within the steps of voxels
    EXPECT_NEAR(static_cast<double>(bone) * 0.125, 1045.8, 30) << name;
  }
  const auto contours = read_path(place + "/rtstruct_alone");
  ASSERT_FALSE(contours.ok());
  EXPECT_NE(contours.error().text.find("contours (RTSTRUCT)"), std::string::npos);
}

}  // namespace
}  // namespace burr::io
