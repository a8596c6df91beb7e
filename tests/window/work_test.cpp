// What is milled, and with what, when a person asks for a bone.
#include "shared/window_session.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "burr/base/progress.h"
#include "shared/work.h"

namespace burr::app {
namespace {

Result<WindowSession> ball_of(double voxel_mm, double burr_mm) {
  WorkOptions options;
  options.volume.source = "phantom:ball";
  options.volume.voxel_mm = voxel_mm;
  options.burr_mm = burr_mm;
  NoProgress quiet;
  if (const Status taken = take_case(options); !taken) return taken.error();
  auto work = open_work(options, quiet);
  if (!work) return work.error();
  return make_window_session(options, std::move(*work), quiet);
}

TEST(Work, ABurrTooSmallForTheVoxelsMakesWayForOneThatFitsAndSaysSo) {
  const auto ready = ball_of(1.33, 0);
  ASSERT_TRUE(ready) << ready.error().text;
  EXPECT_NEAR(ready->session->settings().servo.burr.radius, 2.7e-3, 1e-9) << "4 x 1.33 mm is 5.32";
  ASSERT_FALSE(ready->import.notices.empty());
  const std::string& said = ready->import.notices.back();
  for (const char* part : {"5.00 mm", "1.33 mm", "5.4 mm", "`voxel_mm` 1.25"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
}

// --bone and the box of the start page: the case on another bone.
TEST(Work, ACaseIsTakenToAnotherBone) {
  WorkOptions options;
  options.volume.source = "jaw";
  options.bone = 7;
  ASSERT_TRUE(take_case(options));
  EXPECT_EQ(options.volume.source, "phantom:jaw?long,defect,bone=7");
  EXPECT_EQ(options.work_case->phantom, "jaw?long,defect,bone=7");

  std::set<std::string> drawn;
  for (int n = 0; n < 8; ++n) {
    WorkOptions other;
    other.volume.source = "spine";
    other.other_bones = true;
    ASSERT_TRUE(take_case(other));
    EXPECT_TRUE(other.volume.source.starts_with("phantom:spine?bone=")) << other.volume.source;
    drawn.insert(other.volume.source);
  }
  EXPECT_GE(drawn.size(), 7U) << "the same bone again and again";

  // the block has no others: the box leaves it alone, the option is refused
  WorkOptions block;
  block.volume.source = "block";
  block.other_bones = true;
  ASSERT_TRUE(take_case(block));
  EXPECT_EQ(block.volume.source, "phantom:block");
  // the library's sentence about a case, in its own words, and the program's about what is none
  for (const auto& [source, remedy] : {std::pair{"block", "leave out `bone_number`"},
                                       std::pair{"phantom:jaw", "leave out --bone"}}) {
    WorkOptions bad;
    bad.volume.source = source;
    bad.bone = 3;
    const Status taken = take_case(bad);
    ASSERT_FALSE(taken) << source;
    EXPECT_NE(taken.error().text.find(remedy), std::string::npos) << taken.error().text;
  }
}

TEST(Work, ABurrThatFitsStaysAsAskedFor) {
  const auto ready = ball_of(1, 4);
  ASSERT_TRUE(ready) << ready.error().text;
  EXPECT_NEAR(ready->session->settings().servo.burr.radius, 2e-3, 1e-9);
  for (const std::string& said : ready->import.notices)
    EXPECT_EQ(said.find("too small"), std::string::npos) << said;
}

TEST(Work, VoxelsTooCoarseForAnyBurrAreRefusedWithTheRemedy) {
  const auto ready = ball_of(2, 0);
  ASSERT_FALSE(ready);
  EXPECT_NE(ready.error().text.find("voxels of 1.250 mm or finer"), std::string::npos)
      << ready.error().text;
}

}  // namespace
}  // namespace burr::app
