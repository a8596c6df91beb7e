// How the bone was made, in a recording: to the bit, without a path; as older recordings said it too.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "burr/record/player.h"
#include "burr/scenario/recipe.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using nlohmann::json;
using scenario::BoneRecipe;
using scenario::Region;

BoneRecipe any_recipe(test::Random& random) {
  const auto coin = [&] { return random() % 2 == 0; };
  std::uniform_real_distribution<double> share(0, 1);
  BoneRecipe recipe;
  recipe.source = coin() ? "phantom:jaw" : "/home/anna/scan.nrrd";
  if (coin()) recipe.series = coin() ? "#3" : "1.2.840.113619.2.55.3.604688119.971";
  if (coin()) recipe.spacing_mm = {0.1 + share(random), 0.1 + share(random), 1.0 / 3};
  if (coin()) recipe.region = Region{{3, static_cast<int>(random() % 999)}, {0, 7}, {8, 999'999}};
  if (coin()) recipe.voxel_mm = share(random);
  if (coin()) recipe.iso = 3000 * (share(random) - 0.5);
  if (coin()) recipe.smooth = 100 * share(random);
  if (coin()) recipe.labels = "/home/anna/labels.toml";
  if (coin()) recipe.materials = "/home/anna/materials.toml";
  if (coin()) recipe.memory_mb = 16 + 1e4 * share(random);
  recipe.reserve_bricks = random() % 1000;
  return recipe;
}

TEST(RecordedRecipe, ComesBackToTheBitWithoutPaths) {
  BURR_SEEDED(random, 31);
  const auto bone = test::any_bone(random);
  const burr::test::Folder folder;
  for (int n = 0; n < 40; ++n) {
    SessionInfo info = test::info_of(*bone, random);
    info.volume.recipe = scenario::without_paths(any_recipe(random));
    Recorder recorder(1000);
    const Status started = recorder.start(folder / "s.mcap", info);
    ASSERT_TRUE(started.ok()) << started.error().text;
    ASSERT_TRUE(recorder.finish().ok());
    const auto player = Player::open(folder / "s.mcap");
    ASSERT_TRUE(player) << player.error().text;
    EXPECT_TRUE((*player)->info().volume.recipe == info.volume.recipe)
        << scenario::to_json(info.volume.recipe);
    EXPECT_EQ((*player)->info().volume.format, "DICOM");
  }
}

// what `burr mill` of 2026-11-24 wrote
std::string old_session(const json& numbers, const json& words) {
  test::Random random(1);
  const auto bone = test::any_bone(random);
  json session = json::parse(to_json(test::info_of(*bone, random)));
  json& volume = session["volume"];
  volume.erase("recipe");
  volume.erase("format");
  volume["reserve_bricks"] = 77;
  volume["numbers"] = numbers;
  volume["words"] = words;
  return session.dump();
}

TEST(RecordedRecipe, OfAnOlderRecordingIsTheSame) {
  const json usual = {{"voxel_mm", 0.25}, {"smooth", -1.0}, {"memory_mb", 0.0}};
  auto read = session_from_json(
      old_session(usual, {{"format", "formula"}, {"phantom", "temporal-bone"}}), "old.mcap");
  ASSERT_TRUE(read) << read.error().text;
  BoneRecipe wanted;
  wanted.source = "phantom:temporal-bone";
  wanted.voxel_mm = 0.25;
  wanted.reserve_bricks = 77;
  wanted.margin = false;  // older than the layers of air at the border
  wanted.check_values = false;
  wanted.check_scan = false;
  wanted.bone_law = 1;
  EXPECT_TRUE(read->volume.recipe == wanted) << scenario::to_json(read->volume.recipe);
  EXPECT_EQ(read->volume.format, "formula");

  read = session_from_json(old_session({{"voxel_mm", 0.0}, {"smooth", 20.5}, {"memory_mb", 512.0}},
                                       {{"format", "NRRD"},
                                        {"iso", "-1.25"},
                                        {"roi", "0,17,0,23,4,23"},
                                        {"spacing_mm", "0.3,0.3,0.6"},
                                        {"series", "given by name"},
                                        {"tissue_table", "own"},
                                        {"materials", "own"}}),
                           "old.mcap");
  ASSERT_TRUE(read) << read.error().text;
  wanted = {};
  wanted.series = scenario::kOwn;
  wanted.spacing_mm = {0.3, 0.3, 0.6};
  wanted.region = Region{{0, 17}, {0, 23}, {4, 23}};
  wanted.iso = -1.25;
  wanted.smooth = 20.5;
  wanted.labels = wanted.materials = scenario::kOwn;
  wanted.memory_mb = 512;
  wanted.reserve_bricks = 77;
  wanted.margin = false;  // older than the layers of air at the border
  wanted.check_values = false;
  wanted.check_scan = false;
  wanted.bone_law = 1;
  EXPECT_TRUE(read->volume.recipe == wanted) << scenario::to_json(read->volume.recipe);
}

TEST(RecordedRecipe, WhatIsBrokenIsNamed) {
  for (const auto& [word, text] : {std::pair{"roi", "1,2"}, {"iso", "high"}, {"spacing_mm", "1"}}) {
    const auto read = session_from_json(old_session(json::object(), {{word, text}}), "old.mcap");
    ASSERT_FALSE(read) << word;
    EXPECT_NE(read.error().text.find(std::string("volume.words.") + word), std::string::npos)
        << read.error().text;
  }
}

}  // namespace
}  // namespace burr::record
