// Volumes of AMBF (FIVRS): PNG pictures written here from a formula, and the one in the shared data.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "burr/importing/import.h"
#include "burr/io/read/adf_folder.h"
#include "burr/io/read/read_scan.h"
#include "burr/io/read/yaml.h"
#include "io/folder_of_test.h"
#include "support/data.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;
using Colour = std::array<std::uint8_t, 4>;

// ---- PNG written by hand: IHDR, IDAT, IEND

std::string big32(std::uint32_t v) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(v >> shift & 0xFF);
  return out;
}
std::string chunk(const std::string& name, const std::string& data) {
  const std::string body = name + data;
  return big32(static_cast<std::uint32_t>(data.size())) + body +
         big32(static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                                                  static_cast<uInt>(body.size()))));
}
// kind 6: RGBA, 2: RGB, 0: grey; depth in bits
std::string png(int width, int height, int kind, int depth,
                const std::function<Colour(int column, int row)>& at) {
  std::string raw;
  for (int row = 0; row < height; ++row) {
    raw += '\0';
    for (int column = 0; column < width; ++column) {
      const Colour c = at(column, row);
      const int parts = kind == 6 ? 4 : kind == 2 ? 3 : 1;
      for (int n = 0; n < parts; ++n) {
        raw += static_cast<char>(c[static_cast<std::size_t>(n)]);
        if (depth == 16) raw += '\0';
      }
    }
  }
  uLongf size = compressBound(raw.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(raw.data()), raw.size(), 6);
  packed.resize(size);
  const std::string head = big32(static_cast<std::uint32_t>(width)) +
                           big32(static_cast<std::uint32_t>(height)) + static_cast<char>(depth) +
                           static_cast<char>(kind) + std::string(3, '\0');
  return "\x89PNG\r\n\x1A\n" + chunk("IHDR", head) + chunk("IDAT", packed) + chunk("IEND", "");
}

constexpr Colour kAir = {0, 0, 0, 0}, kBone = {255, 249, 219, 255}, kNerve = {244, 214, 49, 255};
constexpr int kX = 12, kY = 9, kZ = 13;

// A bone that fills x < 7, y >= 3, z < 12 and in it a nerve of 2 x 3 x 4 voxels.
bool in_nerve(int x, int y, int z) { return x >= 1 && x < 3 && y >= 4 && y < 7 && z >= 2 && z < 6; }
bool in_bone(int x, int y, int z) { return x < 7 && y >= 3 && z < 12; }

class AdfFile : public test::FolderTest {
 protected:
  // What stands in the description; "" leaves the line out.
  std::map<std::string, std::string> lines = {
      {"dimensions", "{x: 0.0024, y: 0.0018, z: 0.0039}"},  // 0.2 x 0.2 x 0.3 mm
      {"path", "../resources/volumes/RT/"},
      {"prefix", "plane00"},
      {"format", "png"},
      {"count", "13"}};
  std::string more;

  AdfFile() {
    fs::create_directories(folder / "ADF");
    fs::create_directories(folder / "resources/volumes/RT");
  }
  std::string adf(const std::string& name = "ADF/volume.yaml") {
    std::string text =
        "# AMBF Version: (0.1)\nbodies: []\nvolumes: [VOLUME anatomy]\nnamespace: /ambf/env/\n\n"
        "VOLUME anatomy:\n  name: anatomy\n  location:\n    position: {x: -6.04, y: 0.0, z: 0.0}\n"
        "    orientation: {r: 1.57, p: 1.4, y: 0}\n";
    if (!lines["dimensions"].empty()) text += "  dimensions: " + lines["dimensions"] + "\n";
    text += more + "  images:\n";
    for (const char* key : {"path", "prefix", "format", "count"})
      if (!lines[key].empty()) text += "    " + std::string(key) + ": " + lines[key] + "\n";
    text += "  shaders:\n    path: ./shaders/volume/\n";
    std::ofstream(path(name)) << text;
    return path(name);
  }
  std::string picture(int number) const {
    return path("resources/volumes/RT/plane00" + std::to_string(number) + ".png");
  }
  static void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  // The pictures' last row is the first of the volume.
  void pictures(int kind = 6, const std::function<Colour(int, int, int)>& at = colour_at) {
    for (int z = 0; z < kZ; ++z)
      write(picture(z),
            png(kX, kY, kind, 8, [&](int column, int row) { return at(column, kY - 1 - row, z); }));
  }
  static Colour colour_at(int x, int y, int z) {
    return in_nerve(x, y, z) ? kNerve : in_bone(x, y, z) ? kBone : kAir;
  }
  static Result<Scan> read(const std::string& path, const ReadOptions& options = {}) {
    NoProgress progress;
    return read_scan(path, options, progress);
  }
  static bool says(const Scan& scan, const std::string& words) {
    return std::any_of(scan.notices.begin(), scan.notices.end(),
                       [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }
  static int wrong(const Scan& scan, const std::function<int(int, int, int)>& f) {
    int n = 0;
    std::size_t at = 0;
    for (int z = 0; z < scan.size.z(); ++z)
      for (int y = 0; y < scan.size.y(); ++y)
        for (int x = 0; x < scan.size.x(); ++x) n += scan.labels[at++] != f(x, y, z) ? 1 : 0;
    return n;
  }
  // by colour: the nerve's red is smaller
  static int truth(int x, int y, int z) { return in_nerve(x, y, z) ? 1 : in_bone(x, y, z) ? 2 : 0; }
};

TEST_F(AdfFile, ColoursAreLabels) {
  pictures();
  const auto scan = read(adf());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  // numbers, not texts: plane0010 comes after plane009
  ASSERT_EQ(scan->size, math::Ijk(kX, kY, kZ));
  EXPECT_EQ(wrong(*scan, truth), 0);
  EXPECT_TRUE(scan->spacing_mm.isApprox(math::Vec3(0.2, 0.2, 0.3), 1e-9));
  EXPECT_TRUE(scan->axes.isApprox(math::Mat3::Identity(), 1e-9));
  // the middle of the volume is at 0
  EXPECT_TRUE(scan->origin_mm.isApprox(math::Vec3(-1.1, -0.8, -1.8), 1e-9)) << scan->origin_mm;
  ASSERT_EQ(scan->label_names.size(), 2U);
  EXPECT_EQ(scan->label_names[0].name, "colour 244,214,49");
  EXPECT_NEAR(scan->label_names[1].colour[2], 219 / 255.0, 1e-6);
  EXPECT_TRUE(scan->questions.empty());
}

TEST_F(AdfFile, FoldersThatHoldOne) {
  pictures();
  adf();
  // the folder of both; a file that describes something else does not count
  write(path("ADF/drill.yaml"), "bodies: [BODY drill]\nBODY drill: {name: drill}\n");
  const auto whole = read(folder.string());
  ASSERT_TRUE(whole.ok()) << whole.error().text;
  EXPECT_EQ(wrong(*whole, truth), 0);
  adf("ADF/other.yaml");
  const auto two = read(folder.string());
  ASSERT_FALSE(two.ok());
  EXPECT_NE(two.error().text.find("holds 2 ADF files (other.yaml, volume.yaml)"), std::string::npos)
      << two.error().text;

  // the pictures' folder, with the ADF inside it, or beside it
  lines["path"] = ".";
  adf("resources/volumes/RT/v.yaml");
  const auto inside = read(path("resources/volumes/RT"));
  ASSERT_TRUE(inside.ok()) << inside.error().text;
  fs::remove(path("resources/volumes/RT/v.yaml"));
  lines["path"] = "RT";
  adf("resources/volumes/v.yaml");
  const auto beside = read(path("resources/volumes/RT"));
  ASSERT_TRUE(beside.ok()) << beside.error().text;
  EXPECT_EQ(wrong(*beside, truth), 0);
  fs::remove(path("resources/volumes/v.yaml"));
  const auto bare = read(path("resources/volumes/RT"));
  ASSERT_FALSE(bare.ok());
  EXPECT_NE(bare.error().text.find("put the ADF (.yaml)"), std::string::npos) << bare.error().text;
}

TEST_F(AdfFile, OtherKindsOfPictures) {
  const Colour dark = {40, 40, 40, 255}, light = {200, 200, 200, 255};
  const auto grey = [&](int x, int y, int z) {
    return in_nerve(x, y, z) ? dark : in_bone(x, y, z) ? light : kAir;
  };
  for (const int kind : {0, 2, 6}) {
    pictures(kind, grey);
    const auto scan = read(adf());
    ASSERT_TRUE(scan.ok()) << kind << scan.error().text;
    EXPECT_EQ(wrong(*scan,
                    [](int x, int y, int z) {
                      return in_nerve(x, y, z) ? 40 : in_bone(x, y, z) ? 200 : 0;
                    }),
              0)
        << kind;
  }
  pictures(2);  // without alpha, air is black
  const auto scan = read(adf());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(wrong(*scan, truth), 0);
  // many shades are a grey scan
  pictures(0, [](int x, int y, int z) {
    return Colour{static_cast<std::uint8_t>((x * 37 + y * 71 + z * 13) % 256), 0, 0, 255};
  });
  const auto shades = read(adf());
  ASSERT_TRUE(shades.ok()) << shades.error().text;
  EXPECT_TRUE(shades->labels.empty());
  EXPECT_FALSE(shades->hounsfield);
}

// The converter of FIVRS adds the colours of two structures, alpha too, and keeps 8 bits.
TEST_F(AdfFile, OverlappingStructures) {
  pictures(6, [](int x, int y, int z) {
    if (!in_nerve(x, y, z)) return colour_at(x, y, z);
    return x == 1 ? Colour{(255 + 244) & 0xFF, (249 + 214) & 0xFF, (219 + 49) & 0xFF, 254} : kNerve;
  });
  const auto scan = read(adf());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(wrong(*scan, truth), 0);
  EXPECT_TRUE(says(*scan, "overlap in 12 voxels")) << scan->notices[0];
}

TEST_F(AdfFile, NamesByColour) {
  pictures();
  const auto scan = read(adf());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  // numbers that are not those of the scan: only the colours count
  write(path("names.txt"),
        "9 255 249 219 1 1 1 \"Temporal bone\"\n2 244 214 49 1 1 1 \"Facial nerve\"\n"
        "1 1 2 3 1 1 1 \"Stapes\"\n");
  scenario::BoneRecipe recipe;
  recipe.labels = path("names.txt");
  const auto plan = importing::plan_import(*scan, recipe);
  ASSERT_TRUE(plan.ok()) << plan.error().text;
  std::map<std::string, volume::TissueKind> kinds;
  for (const auto& one : plan->tissues) kinds[one.tissue.name] = one.tissue.kind;
  EXPECT_EQ(kinds.at("Temporal bone"), volume::TissueKind::solid);
  EXPECT_EQ(kinds.at("Facial nerve"), volume::TissueKind::soft);
  write(path("names.txt"), "1 1 2 3 1 1 1 \"Stapes\"\n");
  const auto none = importing::plan_import(*scan, recipe);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().text.find("none of its colours"), std::string::npos) << none.error().text;
}

TEST_F(AdfFile, CountsAndHoles) {
  pictures();
  lines["count"] = "512";  // as FIVRS writes it for fewer pictures
  const auto fewer = read(adf());
  ASSERT_TRUE(fewer.ok()) << fewer.error().text;
  EXPECT_TRUE(says(*fewer, "states 512 pictures, and 13 are there"));
  EXPECT_EQ(wrong(*fewer, truth), 0);
  lines["count"] = "5";
  const auto more_there = read(adf());
  ASSERT_TRUE(more_there.ok()) << more_there.error().text;
  EXPECT_EQ(more_there->size.z(), 6);
  EXPECT_TRUE(says(*more_there, "7 pictures have numbers beyond the 5"));
  lines["count"] = "13";
  fs::remove(picture(4));
  fs::remove(picture(11));
  const auto holes = read(adf());
  ASSERT_TRUE(holes.ok()) << holes.error().text;
  ASSERT_EQ(holes->questions.size(), 1U);
  EXPECT_EQ(holes->questions[0].ask, Ask::missing);
  EXPECT_NE(holes->questions[0].text.find("numbers 4, 11"), std::string::npos);
  // slice 4 is like slice 3, slice 11 like slice 10
  EXPECT_EQ(wrong(*holes, truth), 0);
}

TEST_F(AdfFile, SizesThatNoBoneHas) {
  pictures();
  lines["dimensions"] = "{x: 1.0, y: 1.0, z: 1.0}";
  const auto scan = read(adf());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->questions.size(), 1U);
  EXPECT_EQ(scan->questions[0].ask, Ask::spacing);
  EXPECT_NE(scan->questions[0].text.find("1000 x 1000 x 1000 mm"), std::string::npos);
  ReadOptions options;
  options.spacing_mm = {0.2, 0.2, 0.3};
  const auto told = read(path("ADF/volume.yaml"), options);
  ASSERT_TRUE(told.ok()) << told.error().text;
  EXPECT_TRUE(told->questions.empty());
  EXPECT_TRUE(told->spacing_mm.isApprox(options.spacing_mm, 1e-9));
  // pictures of 12 x 9 with dimensions of 9 x 12 voxels of 0.2 mm
  lines["dimensions"] = "{x: 0.0018, y: 0.0024, z: 0.0039}";
  const auto turned = read(adf());
  ASSERT_TRUE(turned.ok()) << turned.error().text;
  ASSERT_EQ(turned->questions.size(), 1U);
  EXPECT_NE(turned->questions[0].text.find("if rows and columns are exchanged"), std::string::npos);
  more = "  scale: 0.5\n";
  lines["dimensions"] = "{x: 0.0024, y: 0.0018, z: 0.0039}";
  const auto half = read(adf());
  ASSERT_TRUE(half.ok()) << half.error().text;
  EXPECT_TRUE(half->spacing_mm.isApprox(math::Vec3(0.1, 0.1, 0.15), 1e-9));
}

TEST_F(AdfFile, RefusedInOneSentence) {
  pictures();
  struct Row {
    const char* words;
    std::map<std::string, std::string> lines;
  };
  const std::vector<Row> rows = {
      {"dimensions must be three lengths", {{"dimensions", "{x: 0.1, y: 0.1}"}}},
      {"dimensions must be three lengths", {{"dimensions", "{x: 0.1, y: -1, z: 0.1}"}}},
      {"is no folder beside the file", {{"path", "/etc/"}}},
      {"is no folder beside the file", {{"path", "../../volumes"}}},
      {"is no folder beside the file", {{"path", ".."}}},
      {"is missing or cannot be read", {{"path", "../resources/LT"}}},
      {"holds no picture named slice", {{"prefix", "slice"}}},
      {"burr reads png", {{"format", "jpg"}}},
      {"is not a number of pictures", {{"count", "many"}}},
      {"is no valid YAML", {{"dimensions", "{x: [}"}}},
  };
  const auto good = lines;
  for (const Row& row : rows) {
    lines = good;
    for (const auto& [key, value] : row.lines) lines[key] = value;
    const auto scan = read(adf());
    ASSERT_FALSE(scan.ok()) << row.words;
    EXPECT_NE(scan.error().text.find(row.words), std::string::npos) << scan.error().text;
    EXPECT_EQ(scan.error().text.rfind("volume.yaml: ", 0), 0U) << scan.error().text;
  }
  lines = good;
  adf();
  const std::string bytes = content(picture(3));
  const std::vector<std::pair<const char*, std::string>> pictures_of = {
      {"plane003.png: is a damaged PNG", bytes.substr(0, bytes.size() / 2)},
      {"plane003.png: is a damaged PNG", "no picture"},
      {"plane003.png: is 5 x 4 pixels large", png(5, 4, 6, 8, [](int, int) { return kBone; })},
      {"plane003.png: has 16 bits", png(kX, kY, 0, 16, [](int, int) { return kBone; })},
      {"plane003.png: its ",
       bytes.substr(0, 16) + big32(30000) + big32(30000) + bytes.substr(24, 5) +
           big32(static_cast<std::uint32_t>(
               ::crc32(0,
                       reinterpret_cast<const Bytef*>(
                           ("IHDR" + big32(30000) + big32(30000) + bytes.substr(24, 5)).data()),
                       17))) +
           bytes.substr(33)}};
  for (const auto& [words, changed] : pictures_of) {
    write(picture(3), changed);
    const auto scan = read(path("ADF/volume.yaml"));
    ASSERT_FALSE(scan.ok()) << words;
    EXPECT_NE(scan.error().text.find(words), std::string::npos) << scan.error().text;
  }
  write(picture(3), bytes);
  write(path("resources/volumes/RT/plane00007.png"), bytes);
  const auto twice = read(path("ADF/volume.yaml"));
  ASSERT_FALSE(twice.ok());
  EXPECT_NE(twice.error().text.find("have the same number"), std::string::npos)
      << twice.error().text;
}

TEST_F(AdfFile, MoreThan255Colours) {
  pictures(6, [](int x, int y, int z) {
    return Colour{static_cast<std::uint8_t>(x + 1), static_cast<std::uint8_t>(y),
                  static_cast<std::uint8_t>(z), 255};
  });
  const auto scan = read(adf());
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("more than 255 different colours"), std::string::npos);
}

TEST_F(AdfFile, ALinkThatLeadsOutIsNotFollowed) {
  pictures();
  const fs::path outside = folder.parent_path() / (folder.filename().string() + "-outside");
  fs::rename(folder / "resources/volumes/RT", outside);
  fs::create_directory_symlink(outside, folder / "resources/volumes/RT");
  const auto scan = read(adf());
  fs::remove_all(outside);
  ASSERT_FALSE(scan.ok());
  EXPECT_NE(scan.error().text.find("is missing or cannot be read"), std::string::npos)
      << scan.error().text;
}

TEST(YamlText, AliasesAndDepthDoNotGrow) {
  const auto tree = parse_yaml("a: &x {b: 1, c: [2, 'three']}\nd: *x\n", "t.yaml");
  ASSERT_TRUE(tree.ok()) << tree.error().text;
  EXPECT_EQ(tree->find("a")->find("c")->values[1].text, "three");
  EXPECT_EQ(tree->find("d")->kind, Yaml::Kind::alias);
  EXPECT_EQ(tree->find("e"), nullptr);
  EXPECT_FALSE(parse_yaml(std::string(500, '['), "t.yaml").ok());
  EXPECT_FALSE(parse_yaml("", "t.yaml").ok());
  EXPECT_FALSE(parse_yaml(std::string_view(), "t.yaml").ok());  // as of an empty file
}

// phantom01 of volumetric_drilling: 252 pictures of 185 x 341; its ADF was made from voxels of 0.35
// mm, so all three spacings must come out as that.
TEST_F(AdfFile, APhantomOfFivrs) {
  BURR_NEEDS_DATA("drill_trajectory/phantom01");
  const auto scan = read((test::data_dir() / "drill_trajectory/phantom01").string());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->size, math::Ijk(185, 341, 252));
  EXPECT_TRUE(scan->spacing_mm.isApprox(math::Vec3(0.35, 0.35, 0.35), 1e-6)) << scan->spacing_mm;
  EXPECT_TRUE(scan->questions.empty());
  std::map<int, int> counts;
  for (const std::uint8_t label : scan->labels) ++counts[label];
  // counted by another PNG decoder
  EXPECT_EQ(counts, (std::map<int, int>{{0, 13183272}, {1, 1936211}, {2, 22497}, {3, 755440}}));
}

// The temporal bone as FIVRS has it: pictures made from a part of the .seg.nrrd, with its colours.
TEST_F(AdfFile, TheTemporalBoneAsPictures) {
  BURR_NEEDS_DATA("temporal_bone/LT151_256.seg.nrrd");
  const auto bone = read((test::data_dir() / "temporal_bone/LT151_256.seg.nrrd").string());
  ASSERT_TRUE(bone.ok()) << bone.error().text;
  const int side = 64, start = 96;
  const auto label = [&](int x, int y, int z) {
    return bone
        ->labels[(static_cast<std::size_t>(start + z) * static_cast<std::size_t>(bone->size.y()) +
                  static_cast<std::size_t>(start + y)) *
                     static_cast<std::size_t>(bone->size.x()) +
                 static_cast<std::size_t>(start + x)];
  };
  std::map<int, Colour> colours = {{0, kAir}};
  for (const Label& one : bone->label_names) {
    Colour& colour = colours[one.value];
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] = static_cast<std::uint8_t>(std::lround(one.colour[c] * 255));
    colour[3] = 255;
  }
  for (int z = 0; z < side; ++z)
    write(picture(z), png(side, side, 6, 8, [&](int column, int row) {
            return colours.at(label(column, side - 1 - row, z));
          }));
  lines["count"] = "64";
  lines["dimensions"] = "{x: 0.0128, y: 0.0128, z: 0.0128}";
  const auto scan = read(adf());
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  ASSERT_EQ(scan->size, math::Ijk(side, side, side));
  // the same structure in each voxel, by its colour
  std::map<int, Colour> back = {{0, kAir}};
  for (const Label& one : scan->label_names)
    for (std::size_t c = 0; c < 3; ++c) {
      back[one.value][c] = static_cast<std::uint8_t>(std::lround(one.colour[c] * 255));
      back[one.value][3] = 255;
    }
  std::size_t at = 0, different = 0, structures = scan->label_names.size();
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x, ++at)
        different += back.at(scan->labels[at]) != colours.at(label(x, y, z)) ? 1 : 0;
  EXPECT_EQ(different, 0U);
  EXPECT_GT(structures, 3U);
}

}  // namespace
}  // namespace burr::io
