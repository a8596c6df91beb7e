// From a case or a recipe to a session, a recording, and back to what was removed, without a program
// around it.
#include <gtest/gtest.h>
#include <functional>

#include <filesystem>
#include <numbers>
#include <string>

#include "burr/record/player.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "support/folder.h"

namespace burr::workshop {
namespace {

class Workshop : public testing::Test {
 protected:
  const test::Folder folder_;
  NoProgress quiet_;
};

scenario::BoneRecipe coarse() {
  scenario::BoneRecipe recipe;
  recipe.voxel_mm = 0.8;
  return recipe;
}

TEST_F(Workshop, ACaseIsPreparedAsItSays) {
  const auto work = scenario::read_case("block");
  ASSERT_TRUE(work) << work.error().text;
  auto prepared = prepare(*work, quiet_, {}, coarse());
  ASSERT_TRUE(prepared) << prepared.error().text;
  EXPECT_EQ(prepared->recipe.source, "phantom:block");
  EXPECT_EQ(prepared->bone->grid().voxel, 0.8e-3);
  EXPECT_EQ(prepared->burr.kind, work->burr.kind);
  EXPECT_NEAR(prepared->burr.radius, work->burr.radius, 1e-12);
  EXPECT_NEAR(prepared->spindle, work->full_speed, 1e-9);
  EXPECT_EQ(prepared->work_case->text, work->text);
  EXPECT_EQ(prepared->what, "block");
  const auto ordered = prepare(*work, quiet_, {.diameter_mm = 4, .rpm = 6000}, coarse());
  ASSERT_TRUE(ordered) << ordered.error().text;
  EXPECT_NEAR(ordered->burr.radius, 2e-3, 1e-12);
  EXPECT_NEAR(ordered->spindle, 200 * std::numbers::pi, 1e-9);
}

TEST_F(Workshop, ATissueThatTheBoneLacksIsOneSentence) {
  auto work = scenario::read_case("block");
  ASSERT_TRUE(work);
  work->spare = {"nerve of Wrisberg"};
  const auto prepared = prepare(*work, quiet_, {}, coarse());
  ASSERT_FALSE(prepared);
  EXPECT_NE(prepared.error().text.find("nerve of Wrisberg"), std::string::npos)
      << prepared.error().text;
}

TEST_F(Workshop, ABurrTooSmallForTheVoxelsIsANotice) {
  scenario::BoneRecipe recipe;
  recipe.source = "phantom:ball";
  recipe.voxel_mm = 1.33;
  const auto prepared = prepare(recipe, quiet_);
  ASSERT_TRUE(prepared) << prepared.error().text;
  EXPECT_NEAR(prepared->burr.radius, 2.7e-3, 1e-12);
  ASSERT_FALSE(prepared->summary.notices.empty());
  EXPECT_NE(prepared->summary.notices.back().find("too small"), std::string::npos);
}

TEST_F(Workshop, WhatDoesNothingForAPhantomIsRefused) {
  using scenario::BoneRecipe;
  const std::function<void(BoneRecipe&)> ways[] = {
      [](BoneRecipe& r) { r.smooth = 0; },        [](BoneRecipe& r) { r.smooth = 20; },
      [](BoneRecipe& r) { r.memory_mb = 512; },   [](BoneRecipe& r) { r.iso = 300; },
      [](BoneRecipe& r) { r.series = "#2"; },     [](BoneRecipe& r) { r.allow_missing = true; },
      [](BoneRecipe& r) { r.as_it_is = true; },   [](BoneRecipe& r) { r.spacing_mm = {1, 1, 1}; },
      [](BoneRecipe& r) { r.keep.largest = 1; },  [](BoneRecipe& r) { r.drop_islands_mm3 = 1; },
      [](BoneRecipe& r) { r.read_seconds = 9; },  [](BoneRecipe& r) { r.labels = "a.toml"; },
      [](BoneRecipe& r) { r.read_memory_mb = 9; }};
  for (const auto& change : ways) {
    BoneRecipe recipe;
    recipe.source = "phantom:ball";
    change(recipe);
    const auto prepared = prepare(recipe, quiet_);
    ASSERT_FALSE(prepared) << scenario::to_json(recipe);
    EXPECT_NE(prepared.error().text.find("only `voxel_mm` and `materials` apply"),
              std::string::npos);
  }
}

TEST_F(Workshop, WhatASessionRemovedIsReadFromItsRecordingAlone) {
  const std::string file = folder_ / "s.mcap";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto work = scenario::read_case("block");
  ASSERT_TRUE(work);
  auto prepared = prepare(*work, quiet_, {}, coarse());
  ASSERT_TRUE(prepared) << prepared.error().text;
  const std::uint64_t before = prepared->bone->content_hash();
  auto session = begin_by_itself(*prepared, "slot", 2, settings_of(*prepared), quiet_);
  ASSERT_TRUE(session) << session.error().text;
  About with = about(*prepared, (*session)->bone(), "slot");
  with.identity.mode = record::Mode::practise;
  with.identity.learner = "kestrel-27";
  with.identity.attempt = 2;
  auto recorder = record(**session, file, with);
  ASSERT_TRUE(recorder) << recorder.error().text;
  (*session)->run(2, quiet_);
  (*session)->set_recorder(nullptr);
  ASSERT_TRUE((*recorder)->finish().ok());
  const double removed = (*session)->outcome().ledger.removed;
  ASSERT_GT(removed, 1e-9) << "nothing was cut: the test shows nothing";

  auto player = record::Player::open(file);
  ASSERT_TRUE(player) << player.error().text;
  ASSERT_TRUE((*player)->info().work_case.has_value());
  EXPECT_TRUE((*player)->info().work_case->unchanged());
  const auto& who = (*player)->info().identity;
  ASSERT_TRUE(who.has_value());
  EXPECT_EQ(who->mode, record::Mode::practise);
  EXPECT_EQ(who->learner, "kestrel-27");
  EXPECT_EQ(who->attempt, 2U);
  EXPECT_EQ(who->case_hash, (*player)->info().work_case->text_hash);
  EXPECT_EQ(who->labels_hash, record::labels_hash((*session)->bone()));
  ASSERT_TRUE((*player)->info().shaft.has_value());
  EXPECT_GT((*player)->info().shaft->radius, 0.5e-3);
  EXPECT_EQ((*player)->lacks(), "");
  auto bone = workshop::bone_of(**player, {}, quiet_);
  ASSERT_TRUE(bone) << bone.error().text;
  EXPECT_EQ((*bone)->content_hash(), before);
  const auto lost = removed_by_tissue(**player, quiet_);
  ASSERT_TRUE(lost) << lost.error().text;
  double sum = 0;
  for (const TissueLoss& one : *lost) sum += one.removed;
  EXPECT_NEAR(sum / removed, 1, 0.02) << sum << " m3 instead of " << removed;
  const auto live = losses(**bone, (*session)->bone());
  ASSERT_EQ(live.size(), lost->size());
  for (std::size_t n = 0; n < live.size(); ++n) {
    EXPECT_EQ(live[n].name, (*lost)[n].name);
    EXPECT_EQ(live[n].removed, (*lost)[n].removed);
  }
  auto again = record::Player::open(file);
  ASSERT_TRUE(again);
  const auto watched = watch(**again, {}, quiet_);
  ASSERT_TRUE(watched) << watched.error().text;
  EXPECT_TRUE(watched->timeline.work.has_value());
  EXPECT_EQ(watched->bone->content_hash(), before);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the workshop prints nothing";
}

}  // namespace
}  // namespace burr::workshop
