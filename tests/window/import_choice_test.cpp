// What the import page works out: greys, directions, regions, tables, planes, memory.
#include "window/import/import_choice.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>

#include "window/import/import_preview.h"
#include "window/user.h"

namespace burr::app {
namespace {

io::Scan box_scan(math::Ijk size) {
  io::Scan scan;
  scan.size = size;
  scan.format = "test";
  scan.values.resize(static_cast<std::size_t>(size.prod()));
  return scan;
}

TEST(Greys, CountEveryVoxelOnceAndKnowTheShareAboveALevel) {
  io::Scan scan = box_scan({10, 10, 10});
  scan.hounsfield = true;
  for (std::size_t n = 0; n < scan.values.size(); ++n)
    scan.values[n] = n < 900 ? -1000.0F : n < 999 ? 1000.0F : 30'000.0F;  // metal
  const Greys greys = greys_of(scan);
  std::int64_t total = 0;
  for (const std::int64_t n : greys.counts) total += n;
  EXPECT_EQ(total, 1000);
  EXPECT_EQ(greys.most, 900);
  EXPECT_EQ(greys.high, 30'000);
  EXPECT_LT(greys.to, 4000) << "one voxel of metal presses all others together";
  EXPECT_NEAR(greys.share_from(300), 0.1, 1e-9);
  EXPECT_NEAR(greys.share_from(-1100), 1, 1e-9);
  EXPECT_EQ(greys.share_from(40'000), 0);
}

TEST(Greys, OfAScanOfOneValueAreNoTrouble) {
  const io::Scan scan = box_scan({4, 4, 4});
  const Greys greys = greys_of(scan);
  EXPECT_GT(greys.to, greys.from);
  EXPECT_GT(greys.step(), 0);
}

TEST(Directions, SayWhereEachAxisPointsInThePatient) {
  math::Mat3 axes;  // i forwards, j to the right, k upwards
  axes << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const auto ways = directions(axes);
  EXPECT_EQ(ways[0].way, PatientDirection::forwards);
  EXPECT_EQ(ways[1].way, PatientDirection::right);
  EXPECT_EQ(ways[2].way, axes(2, 2) > 0 ? PatientDirection::upwards : PatientDirection::downwards);
  EXPECT_FALSE(ways[0].about);
  const math::Mat3 turned = Eigen::AngleAxisd(0.2, math::Vec3::UnitX()).toRotationMatrix();
  EXPECT_FALSE(directions(turned)[0].about);
  EXPECT_TRUE(directions(turned)[1].about);
}

TEST(Planes, StandAsOneIsUsedToSeeThem) {
  // a sagittal scan: rows backwards, columns downwards, slices to the right
  math::Mat3 axes;
  axes.col(0) = math::Vec3(0, 1, 0);
  axes.col(1) = math::Vec3(0, 0, -1);
  axes.col(2) = math::Vec3(-1, 0, 0);
  const auto planes = planes_of(axes);
  EXPECT_EQ(planes[0].through, 1);  // axial: through the columns
  EXPECT_EQ(planes[0].across, 2);
  EXPECT_TRUE(planes[0].flip_across) << "the patient's right is left in the picture";
  EXPECT_FALSE(planes[0].flip_down) << "the front is at the top";
  EXPECT_EQ(planes[2].through, 2);
  EXPECT_FALSE(planes[2].flip_down) << "the head is at the top, the columns begin there";

  // a bright voxel at the patient's left, behind, above
  io::Scan scan = box_scan({8, 8, 8});
  scan.axes = axes;
  scan.values[7 + 8 * (0 + 8 * 0)] = 1000;
  PlaneValues plane;
  sample(scan, planes[0], 0, 8, 8, plane);
  EXPECT_EQ(plane.values[8 * 7 + 7], 1000) << "axial: right and below";
  sample(scan, planes[1], 7, 8, 8, plane);
  EXPECT_EQ(plane.values[7], 1000) << "coronal: right and above";
  sample(scan, planes[2], 0, 8, 8, plane);
  EXPECT_EQ(plane.values[7], 1000) << "sagittal: right and above";
}

TEST(Preview, OutlinesWhatIsTinted) {
  PlaneValues plane{8, 8, std::vector<float>(64, 0)};
  for (int y = 2; y < 7; ++y)
    for (int x = 2; x < 7; ++x) plane.values[static_cast<std::size_t>(8 * y + x)] = 500;
  std::vector<std::uint8_t> with, without;
  draw_greys(plane, 0, 1000, 300, 1, {}, with);
  draw_greys(plane, 0, 1000, std::nullopt, 1, {}, without);
  const auto pixel = [](const std::vector<std::uint8_t>& rgba, int x, int y) {
    const std::size_t at = 4 * static_cast<std::size_t>(8 * y + x);
    return std::array<int, 3>{rgba[at], rgba[at + 1], rgba[at + 2]};
  };
  EXPECT_EQ(pixel(with, 0, 0), pixel(without, 0, 0));
  EXPECT_NE(pixel(with, 4, 4), pixel(without, 4, 4));
  EXPECT_NE(pixel(with, 2, 4), pixel(with, 4, 4)) << "no line";
  EXPECT_EQ(pixel(with, 2, 4), pixel(with, 4, 6));
}

TEST(Region, IsSaidInVoxelsOfTheFileAndReadBack) {
  io::Scan scan = box_scan({10, 20, 30});
  EXPECT_FALSE(region_of(scan, whole(scan)).has_value());
  const Box box{{1, 2, 3}, {8, 17, 20}};
  EXPECT_TRUE((*region_of(scan, box) == scenario::Region{{1, 8}, {2, 17}, {3, 20}}));
  scan.k_reversed = true;
  EXPECT_TRUE((*region_of(scan, box) == scenario::Region{{1, 8}, {2, 17}, {9, 26}}));
  for (const Box& one : {box, whole(scan)}) {
    const auto back = box_of(scan, region_of(scan, one));
    ASSERT_TRUE(back);
    EXPECT_TRUE(*back == one);
  }
  for (const scenario::Region& wrong :
       {scenario::Region{{0, 10}, {0, 19}, {0, 29}}, scenario::Region{{5, 4}, {0, 19}, {0, 29}}})
    EXPECT_FALSE(box_of(scan, wrong)) << scenario::region_text(wrong);
}

TEST(LabelTable, SaysOnlyWhatDiffersAndNoNames) {
  std::vector<importing::TissueFound> found(2);
  found[0].tissue.label = 3;
  found[0].tissue.name = "Svensson";
  found[1].tissue.label = 7;
  using volume::TissueKind;
  EXPECT_EQ(table_of(found, choices_of(found)), "");
  std::vector<LabelChoice> wanted = choices_of(found);
  wanted[1].kind = TissueKind::air;
  const std::string table = table_of(found, wanted);
  EXPECT_NE(table.find("value = 7\nkind = \"air\""), std::string::npos) << table;
  EXPECT_EQ(table.find("value = 3"), std::string::npos);
  EXPECT_EQ(table.find("Svensson"), std::string::npos);
  EXPECT_EQ(table.find("spare"), std::string::npos);
  wanted = choices_of(found);
  wanted[0].spare = true;
  EXPECT_NE(table_of(found, wanted).find("value = 3\nspare = true"), std::string::npos);
}

// ---- memory, in a window

double memory_now_mb(const char* which) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind(which, 0) == 0) return std::stod(line.substr(std::string(which).size())) / 1024;
  return 0;
}

class MemoryWindow : public Window {};

TEST_F(MemoryWindow, OfASessionIsAboutWhatWasSaid) {
#if defined(BURR_SANITIZED)
  GTEST_SKIP() << "a sanitizer's own memory is in the way";
#endif
  // a sponge of 192^3 voxels of 0.5 mm: much surface, as trabecular bone has
  const fs::path path = folder_ / "sponge.nrrd";
  {
    constexpr int kSize = 192;
    std::ofstream file(path, std::ios::binary);
    file << "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
            "sizes: 192 192 192\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\n"
            "space origin: (0,0,0)\nendian: little\nencoding: raw\n\n";
    std::vector<std::int16_t> slice(kSize * kSize);
    for (int k = 0; k < kSize; ++k) {
      for (int j = 0; j < kSize; ++j)
        for (int i = 0; i < kSize; ++i) {
          const double wave = std::sin(0.35 * i) * std::cos(0.35 * j) +
                              std::sin(0.35 * j) * std::cos(0.35 * k) +
                              std::sin(0.35 * k) * std::cos(0.35 * i);
          slice[static_cast<std::size_t>(kSize * j + i)] =
              static_cast<std::int16_t>(std::clamp(300 + 900 * wave, -1000.0, 1800.0));
        }
      file.write(reinterpret_cast<const char*>(slice.data()),
                 static_cast<std::streamsize>(2 * slice.size()));
    }
  }
  scenario::BoneRecipe volume;
  volume.source = path.string();
  NoProgress quiet;
  SessionMemory said;
  {
    auto opened = open_scan(volume, quiet);
    ASSERT_TRUE(opened) << opened.error().text;
    ASSERT_TRUE(opened->planned) << opened->planned.error().text;
    said = opened->planned->memory;
  }
  double before = 0, peak = 0, working = 0;
  pages_by({{"the start page", on(Page::start), nullptr},
            {"its pictures", looks(20),
             [&] {
               before = memory_now_mb("VmRSS:");
               std::ofstream("/proc/self/clear_refs") << "5\n";  // the peak begins anew
               drop(path);
             }},
            {"the import page", on(Page::import), [] { press(SDLK_RETURN); }},
            {"milling", on(Page::milling), nullptr},
            {"its pictures", looks(40),
             [&] {
               working = memory_now_mb("VmRSS:") - before;
               peak = memory_now_mb("VmHWM:") - before;
               leave_work();
             }},
            {"the start page again", on(Page::start), [] { press(SDLK_ESCAPE); }}});
  RecordProperty("said_making", std::to_string(said.making));
  RecordProperty("made", std::to_string(peak));
  std::printf("making: said %.0f, took %.0f MB; working: said %.0f, took %.0f MB\n", said.making,
              peak, said.working, working);
  EXPECT_NEAR(said.making / peak, 1, 0.34);
  EXPECT_NEAR(said.working / working, 1, 0.34);
}

TEST(Memory, LeftIsKnown) {
  EXPECT_GT(free_memory_mb(), 10);
  EXPECT_LT(free_memory_mb(), 1e8);
}

}  // namespace
}  // namespace burr::app
