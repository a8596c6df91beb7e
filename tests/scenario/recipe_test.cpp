// A recipe written and read again is the same to the bit; texts of a person become its numbers.
#include "burr/scenario/recipe.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace burr::scenario {
namespace {

TEST(BoneRecipe, ComesBackToTheBitThroughJson) {
  constexpr std::uint64_t kSeed = 21;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> share(0, 1);
  const auto coin = [&] { return random() % 2 == 0; };
  for (int n = 0; n < 2000; ++n) {
    BoneRecipe recipe;
    if (coin()) recipe.source = coin() ? "phantom:jaw" : "/scans/\xc3\xa5 \"b\"\n.nrrd";
    if (coin()) recipe.series = "#3";
    if (coin()) recipe.spacing_mm = {1e-9 + share(random), 1e-9 + share(random), 1.0 / 3};
    if (coin())
      recipe.region = Region{{static_cast<int>(random() % 1000), 999'999},
                             {0, static_cast<int>(random() % 1000)},
                             {3, 4}};
    if (coin()) recipe.allow_missing = true;
    if (coin()) recipe.as_it_is = true;
    if (coin()) recipe.voxel_mm = share(random);
    if (coin()) recipe.iso = std::ldexp(share(random) - 0.5, static_cast<int>(random() % 40));
    if (coin()) recipe.smooth = 100 * share(random);
    if (coin()) recipe.labels = "labels.toml";
    if (coin()) recipe.materials = "m.toml";
    if (coin()) recipe.memory_mb = 16 + 1e4 * share(random);
    if (coin()) recipe.read_seconds = share(random);
    if (coin()) recipe.read_memory_mb = share(random);
    if (coin()) recipe.reserve_bricks = random() % 100'000;
    if (coin()) recipe.margin = false;
    if (coin()) recipe.check_values = false;
    if (coin()) recipe.check_scan = false;
    if (coin()) recipe.bone_law = 1;
    if (coin()) recipe.keep.largest = 1 + static_cast<int>(random() % 100);
    while (random() % 3 == 0)
      recipe.keep.at_mm.emplace_back(1 - 1e3 * share(random), share(random) / 3, 1e-9);
    if (coin()) recipe.drop_islands_mm3 = share(random);
    const auto back = recipe_from_json(to_json(recipe), "x");
    ASSERT_TRUE(back) << back.error().text;
    ASSERT_TRUE(*back == recipe) << to_json(recipe) << "\n" << to_json(*back);
    if (recipe.iso) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(*back->iso),
                std::bit_cast<std::uint64_t>(*recipe.iso));
    }
  }
}

// A recording that does not name the margin is older, and its bone had none.
TEST(BoneRecipe, WithoutAWordOfTheMarginHasNone) {
  const auto old = recipe_from_json(R"({"source": "", "voxel_mm": 0})", "x");
  ASSERT_TRUE(old) << old.error().text;
  EXPECT_FALSE(old->margin);
  EXPECT_TRUE(BoneRecipe{}.margin);
  EXPECT_FALSE(old->check_values);
  EXPECT_TRUE(BoneRecipe{}.check_values);
  EXPECT_FALSE(old->check_scan);
  EXPECT_TRUE(BoneRecipe{}.check_scan);
  EXPECT_EQ(old->bone_law, 1);
  EXPECT_EQ(BoneRecipe{}.bone_law, 2);
}

TEST(BoneRecipe, WithoutPathsNamesNobody) {
  BoneRecipe recipe;
  recipe.source = "/home/anna/ct";
  recipe.series = "1.2.840.113619";
  recipe.labels = "/home/anna/l.toml";
  recipe.materials = "m.toml";
  recipe.iso = 300;
  const BoneRecipe bare = without_paths(recipe);
  EXPECT_EQ(bare.source, "");
  EXPECT_EQ(bare.series, kOwn);
  EXPECT_EQ(bare.labels, kOwn);
  EXPECT_EQ(bare.materials, kOwn);
  EXPECT_EQ(bare.iso, recipe.iso);
  recipe.source = phantom_source("jaw");
  recipe.series = "#2";
  EXPECT_EQ(without_paths(recipe).source, "phantom:jaw");
  EXPECT_EQ(without_paths(recipe).series, "#2");
  EXPECT_EQ(phantom_name(recipe.source), "jaw");
  EXPECT_EQ(phantom_name("jaw"), "");
}

TEST(BoneRecipe, InARecordingKeepsWhatTellsNothingOfThePatient) {
  for (const char* kept : {"", "#2", "3", "70 keV", "55kev"}) {
    BoneRecipe recipe;
    recipe.series = kept;
    EXPECT_EQ(without_paths(recipe).series, kept);
  }
  for (const char* hidden : {"1.2.840", "1.2", "12345678", "Svensson keV", "1.2.840#2"}) {
    BoneRecipe recipe;
    recipe.series = hidden;
    EXPECT_EQ(without_paths(recipe).series, kOwn) << hidden;
  }
}

TEST(BoneRecipe, OfTheWrongKindIsRefusedByField) {
  for (const auto& [text, field] : std::initializer_list<std::pair<const char*, const char*>>{
           {R"({"voxel_mm": "fine"})", "voxel_mm"},
           {R"({"voxel_mm": -1})", "voxel_mm"},
           {R"({"region": [1, 2, 3]})", "region"},
           {R"({"region": [0, 1, 0, 1, 0, -1]})", "region"},
           {R"({"region": [0, 1, 0, 1, 0, 1000000]})", "region"},
           {R"({"spacing_mm": [1, 2, 1000]})", "spacing_mm"},
           {R"({"reserve_bricks": 1.5})", "reserve_bricks"},
           {R"({"margin": 1})", "margin"},
           {R"({"keep": "largest"})", "keep"},
           {R"({"keep": {"largest": -1}})", "keep"},
           {R"({"keep": {"at_mm": [[1, 2]]}})", "keep"},
           {R"({"keep": {"at_mm": [[1, 2, 1e7]]}})", "keep"},
           {R"({"keep": {"smallest": 1}})", "keep"},
           {R"({"drop_islands_mm3": -1})", "drop_islands_mm3"},
           {R"({"source": 7})", "source"}}) {
    const auto read = recipe_from_json(text, "f.json");
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().text.find(std::string("recipe.") + field), std::string::npos)
        << read.error().text;
  }
  EXPECT_FALSE(recipe_from_json("[]", "f.json"));
}

TEST(BoneRecipe, IsTypedInVoxelsLevelsAndMillimetres) {
  const auto region = parse_region("10,200,0,99,5,80");
  ASSERT_TRUE(region) << region.error().text;
  EXPECT_TRUE((*region == Region{{10, 200}, {0, 99}, {5, 80}}));
  EXPECT_EQ(region_text(*region), "10,200,0,99,5,80");
  EXPECT_EQ(*parse_level("-12.5"), -12.5);
  EXPECT_EQ(*parse_spacing("0.3,0.3,0.6"), math::Vec3(0.3, 0.3, 0.6));
  for (const char* wrong : {"", "1,2,3", "a,b,c,d,e,f", "0,1,0,1,0,-1", "0,1,0,1,0,1e7"})
    EXPECT_FALSE(parse_region(wrong)) << wrong;
  for (const char* wrong : {"", "high", "1,2"}) EXPECT_FALSE(parse_level(wrong)) << wrong;
  for (const char* wrong : {"", "0.3", "0,1,1", "1,1,101", "-1,1,1"})
    EXPECT_FALSE(parse_spacing(wrong)) << wrong;
}

TEST(BoneRecipe, PartsToKeepAreTypedAsANumberOrPoints) {
  EXPECT_EQ(parse_keep("largest")->largest, 1);
  EXPECT_EQ(parse_keep("3")->largest, 3);
  EXPECT_EQ(parse_keep("3 largest")->largest, 3);
  EXPECT_TRUE(parse_keep("all")->all());
  for (const char* text : {"at 1,-2,3.5; 4,5,6", "1,-2,3.5;4,5,6"}) {
    const auto keep = parse_keep(text);
    ASSERT_TRUE(keep) << keep.error().text;
    EXPECT_EQ(keep->largest, 0);
    ASSERT_EQ(keep->at_mm.size(), 2U);
    EXPECT_EQ(keep->at_mm[0], math::Vec3(1, -2, 3.5));
    EXPECT_EQ(keep->at_mm[1], math::Vec3(4, 5, 6));
  }
  for (const char* wrong : {"", "at", "0", "-1", "1.5", "smallest", "1,2", "at 1,2", "1,2,3;",
                            "at 1,2,nan", "at 1,2,1e9", "1e9", "largest 3x"})
    EXPECT_FALSE(parse_keep(wrong)) << wrong;
}

}  // namespace
}  // namespace burr::scenario
