#include "burr/io/write/write_volume.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "io/folder_of_test.h"
#include "surface/surface_bones.h"

namespace burr::io {
namespace {

using math::Vec3;
using volume::Field;

// A reader of the test's own, only for these files.
struct Nrrd {
  std::map<std::string, std::string> field, key;
  std::string data;
};
Nrrd read_nrrd(const std::string& bytes) {
  Nrrd nrrd;
  const std::size_t end = bytes.find("\n\n");
  std::istringstream header(bytes.substr(0, end));
  std::string line;
  std::getline(header, line);
  EXPECT_EQ(line, "NRRD0004");
  while (std::getline(header, line)) {
    if (line[0] == '#') continue;
    const std::size_t colon = line.find(':');
    if (line.substr(colon, 2) == ":=")
      nrrd.key[line.substr(0, colon)] = line.substr(colon + 2);
    else
      nrrd.field[line.substr(0, colon)] = line.substr(colon + 2);
  }
  z_stream z{};
  EXPECT_EQ(inflateInit2(&z, 15 + 16), Z_OK);
  std::vector<char> out(1 << 16);
  std::string packed = bytes.substr(end + 2);
  z.next_in = reinterpret_cast<Bytef*>(packed.data());
  z.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  while (state == Z_OK) {
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    state = inflate(&z, Z_NO_FLUSH);
    nrrd.data.append(out.data(), out.size() - z.avail_out);
  }
  EXPECT_EQ(state, Z_STREAM_END);
  inflateEnd(&z);
  return nrrd;
}

class WriteVolume : public test::FolderTest {
 protected:
  static constexpr int kX = 21, kY = 18, kZ = 13;
  WriteVolume() {
    grid = test::askew({kX, kY, kZ}, 0.25e-3);
    for (int k = 0; k < kZ; ++k)
      for (int j = 0; j < kY; ++j)
        for (int i = 0; i < kX; ++i) {
          const Vec3 p(i, j, k);
          const double depth = 5.2 - (p - Vec3(10, 9, 6)).norm();
          const bool nerve = i == 18;
          field.push_back(nerve ? Field{0} : volume::field_from_depth(depth));
          tissue.push_back(nerve ? 3 : field.back() == 0 ? 0 : j < 9 ? 1 : 2);
          values.push_back(static_cast<std::int16_t>(100 * depth));
        }
    tissues.tissues.resize(4);
    tissues.tissues[1] = {.name = "Bone", .colour = {1, 0.85F, 0}, .label = 12};
    tissues.tissues[2] = {.name = "Malleus", .colour = {0.25F, 0.5F, 0.75F}, .label = 7};
    tissues.tissues[3] = {
        .name = "Facial\nnerve", .kind = volume::TissueKind::soft, .colour = {1, 1, 0}, .label = 2};
    bone = volume::bone_from_arrays(grid, tissues, field, tissue, values, 0);
  }
  volume::Grid grid;
  std::vector<Field> field;
  std::vector<volume::TissueId> tissue;
  std::vector<std::int16_t> values;
  volume::TissueTable tissues;
  std::unique_ptr<volume::Bone> bone;
  NoProgress progress;
};

TEST_F(WriteVolume, LabelsKeepTheirNamesColoursValuesAndPlace) {
  ASSERT_TRUE(write_labels(*bone, path("a.seg.nrrd"), progress).ok());
  const Nrrd nrrd = read_nrrd(content(path("a.seg.nrrd")));
  EXPECT_EQ(nrrd.field.at("type"), "unsigned char");
  EXPECT_EQ(nrrd.field.at("space"), "left-posterior-superior");
  EXPECT_EQ(nrrd.field.at("sizes"), "21 18 13");
  EXPECT_EQ(nrrd.field.at("kinds"), "domain domain domain");
  EXPECT_EQ(nrrd.field.count("endian"), 0U);
  EXPECT_EQ(nrrd.key.at("Segmentation_MasterRepresentation"), "Binary labelmap");
  EXPECT_EQ(nrrd.key.at("Segment0_ID"), "Segment_1");
  EXPECT_EQ(nrrd.key.at("Segment0_Name"), "Bone");
  EXPECT_EQ(nrrd.key.at("Segment0_Color"), "1 0.85 0");
  EXPECT_EQ(nrrd.key.at("Segment0_LabelValue"), "12");
  EXPECT_EQ(nrrd.key.at("Segment0_Layer"), "0");
  EXPECT_EQ(nrrd.key.at("Segment0_Extent"), "0 20 0 17 0 12");
  EXPECT_EQ(nrrd.key.at("Segment1_Name"), "Malleus");
  EXPECT_EQ(nrrd.key.at("Segment1_Color"), "0.25 0.5 0.75");
  EXPECT_EQ(nrrd.key.at("Segment1_LabelValue"), "7");
  EXPECT_EQ(nrrd.key.at("Segment2_Name"), "Facial nerve") << "one line, whatever the name holds";
  EXPECT_EQ(nrrd.key.at("Segment2_LabelValue"), "2");
  EXPECT_EQ(nrrd.key.count("Segment3_ID"), 0U);

  double x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(nrrd.field.at("space origin").c_str(), "(%lf,%lf,%lf)", &x, &y, &z), 3);
  EXPECT_NEAR((Vec3(x, y, z) - 1e3 * grid.frame.p).norm(), 0, 1e-9);
  double d[9];
  ASSERT_EQ(std::sscanf(nrrd.field.at("space directions").c_str(),
                        "(%lf,%lf,%lf) (%lf,%lf,%lf) (%lf,%lf,%lf)", d, d + 1, d + 2, d + 3, d + 4,
                        d + 5, d + 6, d + 7, d + 8),
            9);
  const Vec3 along_j = grid.world_from_grid({0, 1, 0}) - grid.world_from_grid({0, 0, 0});
  EXPECT_NEAR((Vec3(d[3], d[4], d[5]) - 1e3 * along_j).norm(), 0, 1e-9);

  ASSERT_EQ(nrrd.data.size(), field.size());
  const int own[] = {0, 12, 7, 2};
  for (std::size_t v = 0; v < field.size(); ++v) {
    const bool there = tissue[v] == 3 || field[v] >= volume::kIso;
    ASSERT_EQ(nrrd.data[v], there ? own[tissue[v]] : 0) << "voxel " << v;
  }
}

TEST_F(WriteVolume, LabelsThatClashBecomeNumbersInOrder) {
  tissues.tissues[2].label = 12;
  EXPECT_EQ(label_values(tissues), (std::vector<int>{0, 1, 2, 3}));
  tissues.tissues[2].label = 0;
  EXPECT_EQ(label_values(tissues), (std::vector<int>{0, 1, 2, 3}));
  tissues.tissues[2].label = 9;
  EXPECT_EQ(label_values(tissues), (std::vector<int>{0, 12, 9, 2}));
}

TEST_F(WriteVolume, TheFieldComesBackVoxelByVoxel) {
  ASSERT_TRUE(write_field(*bone, path("a.nrrd"), progress).ok());
  const Nrrd nrrd = read_nrrd(content(path("a.nrrd")));
  EXPECT_EQ(nrrd.field.at("type"), "unsigned short");
  EXPECT_EQ(nrrd.field.at("endian"), "little");
  EXPECT_EQ(nrrd.key.at("burr_surface"), "32768");
  ASSERT_EQ(nrrd.data.size(), 2 * field.size());
  EXPECT_EQ(std::memcmp(nrrd.data.data(), field.data(), nrrd.data.size()), 0);
}

TEST_F(WriteVolume, TheScanKeepsItsValuesWhereNothingWasCut) {
  auto cut = field;
  for (std::size_t v = 0; v < cut.size(); ++v)
    if (v % 3 == 0) cut[v] /= 2;
  const auto now = volume::bone_from_arrays(grid, tissues, cut, tissue, values, 0);
  ASSERT_TRUE(write_scan(*bone, *now, path("a.nrrd"), progress).ok());
  const Nrrd nrrd = read_nrrd(content(path("a.nrrd")));
  EXPECT_EQ(nrrd.field.at("type"), "short");
  ASSERT_EQ(nrrd.data.size(), 2 * field.size());
  for (std::size_t v = 0; v < field.size(); ++v) {
    std::int16_t value = 0;
    std::memcpy(&value, &nrrd.data[2 * v], 2);
    const auto i = static_cast<int>(v % kX), j = static_cast<int>(v / kX % kY),
               k = static_cast<int>(v / kX / kY);
    const double left = 1.0 * cut[v] / std::max(field[v], Field{1});
    const bool brick = bone->brick_field(bone->brick_at(i / 8, j / 8, k / 8)) != nullptr;
    const double expected = !brick               ? -1000
                            : cut[v] == field[v] ? values[v]
                                                 : -1000 + (values[v] + 1000) * left;
    ASSERT_NEAR(value, expected, 0.51) << "voxel " << v;
  }
  const auto without = volume::bone_from_arrays(grid, tissues, field, tissue, {}, 0);
  EXPECT_FALSE(write_scan(*without, *now, path("b.nrrd"), progress).ok());
}

TEST_F(WriteVolume, StopsWithoutAFile) {
  struct Impatient final : Progress {
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  } impatient;
  const Status status = write_labels(*bone, path("a.seg.nrrd"), impatient);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().trouble, Trouble::interrupted);
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace burr::io
