// What is milled, and with what, when a person asks for a bone.
#include "window/mill/make_ready.h"

#include <gtest/gtest.h>

#include "burr/base/progress.h"
#include "commands/work.h"

namespace burr::app {
namespace {

Result<Ready> ball_of(double voxel_mm, double burr_mm) {
  WorkOptions options;
  options.volume.source = "phantom:ball";
  options.volume.voxel_mm = voxel_mm;
  options.burr_mm = burr_mm;
  NoProgress quiet;
  if (const Status taken = take_case(options); !taken) return taken.error();
  auto work = open_work(options, quiet);
  if (!work) return work.error();
  return make_ready(options, std::move(*work), quiet);
}

TEST(Work, ABurrTooSmallForTheVoxelsMakesWayForOneThatFitsAndSaysSo) {
  const auto ready = ball_of(1.33, 0);
  ASSERT_TRUE(ready) << ready.error().text;
  EXPECT_NEAR(ready->session->settings().servo.burr.radius, 2.7e-3, 1e-9) << "4 x 1.33 mm is 5.32";
  ASSERT_FALSE(ready->import.notices.empty());
  const std::string& said = ready->import.notices.back();
  for (const char* part : {"5.00 mm", "1.33 mm", "5.4 mm", "--voxel-mm 1.25"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
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
  EXPECT_NE(ready.error().text.find("--voxel-mm 1.250"), std::string::npos) << ready.error().text;
}

}  // namespace
}  // namespace burr::app
