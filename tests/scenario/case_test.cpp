#include "burr/scenario/case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include "burr/phantom/phantoms.h"
#include "burr/volume/pyramid.h"
#include "support/folder.h"

namespace burr::scenario {
namespace {

constexpr const char* kGood = R"(
title = "A case"
phantom = "block"
voxel_mm = 0.5
[work]
at_mm = [1, 2.0, 3]
into = [0, 0, -2]
[burr]
diameter_mm = 4
kind = "diamond"
rpm = 60000
[[spare]]
tissue = "nerve"
[[target]]
tissue = "bone"
goal = "remove"
share = 0.5
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Case, IsReadIntoMetresAndRadians) {
  const auto read = parse_case(kGood, "my_case.toml");
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_EQ(read->name, "my_case");
  EXPECT_EQ(read->phantom, "block");
  EXPECT_DOUBLE_EQ(read->voxel, 0.5e-3);
  EXPECT_LT((*read->at - math::Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_EQ(*read->into, -math::Vec3::UnitZ()) << "made a unit vector";
  EXPECT_DOUBLE_EQ(read->burr.radius, 2e-3);
  EXPECT_EQ(read->burr.kind, tool::BurrKind::diamond);
  EXPECT_DOUBLE_EQ(read->full_speed, 2000 * std::numbers::pi);
  ASSERT_EQ(read->targets.size(), 1U);
  EXPECT_EQ(read->targets[0].goal, Goal::remove);
  EXPECT_DOUBLE_EQ(read->targets[0].share, 0.5);
  EXPECT_EQ(read->spare, std::vector<std::string>{"nerve"});
  EXPECT_EQ(read->tool, "");
  const auto named = parse_case(
      with(kGood, "title = \"A case\"", "title = \"A case\"\ntool = \"flame\""), "a.toml");
  ASSERT_TRUE(named.ok()) << named.error().text;
  EXPECT_EQ(named->tool, "flame");
}

TEST(Case, MistakesAreNamedByFileAndField) {
  struct Mistake {
    std::string from, to, field, says;
  };
  const Mistake mistakes[] = {
      {"title = \"A case\"", "", "title", "missing"},
      {"title = \"A case\"", "title = 7", "title", "text"},
      {"phantom = \"block\"", "", "phantom", "either"},
      {"phantom = \"block\"", "phantom = \"block\"\nvolume = \"x.nrrd\"", "phantom", "either"},
      {"voxel_mm = 0.5", "voxel_mm = -1", "voxel_mm", "above 0"},
      {"voxel_mm = 0.5", "voxel_mm = nan", "voxel_mm", "above 0"},
      {"voxel_mm = 0.5", "voxel_mm = \"small\"", "voxel_mm", "number"},
      {"voxel_mm = 0.5", "voxle_mm = 0.5", "voxle_mm", "not a known field"},
      {"[1, 2.0, 3]", "[1, 2]", "work.at_mm", "three numbers"},
      {"[1, 2.0, 3]", "[1, \"2\", 3]", "work.at_mm", "three numbers"},
      {"[0, 0, -2]", "[0, 0, 0]", "work.into", "must be a direction"},
      {"diameter_mm = 4", "diameter_mm = 70", "burr.diameter_mm",
       "must be a number from 0.6 to 7 mm, not 70"},
      {"diameter_mm = 4", "diameter_mm = 0.1", "burr.diameter_mm",
       "must be a number from 0.6 to 7 mm, not 0.1"},
      {"kind = \"diamond\"", "kind = \"laser\"", "burr.kind", "use one of cutting, diamond"},
      {"rpm = 60000", "", "burr.rpm", "missing"},
      {"[burr]", "[bohrer]", "bohrer", "not a known field"},
      {"goal = \"remove\"", "goal = \"eat\"", "target[1].goal", "use one of open, expose, remove"},
      {"share = 0.5", "share = 1.5", "target[1].share", "at most 1"},
      {"[[spare]]\ntissue = \"nerve\"", "[spare]\ntissue = \"nerve\"", "spare", "list of tables"},
      {"[[spare]]\ntissue = \"nerve\"", "[[spare]]", "spare[1].tissue", "missing"},
      {"title = \"A case\"", "title = \"A case\"\ntool = \"spoon\"", "tool",
       "use one of fissure-bur"},
      {"into = [0, 0, -2]", "into = [0, 0", "line", ""},
  };
  for (const Mistake& mistake : mistakes) {
    const auto read = parse_case(with(kGood, mistake.from, mistake.to), "my.toml");
    ASSERT_FALSE(read.ok()) << mistake.to;
    EXPECT_EQ(read.error().trouble, Trouble::data);
    EXPECT_EQ(read.error().text.find("my.toml: line "), 0U) << read.error().text;
    EXPECT_NE(read.error().text.find(": " + mistake.field), std::string::npos) << read.error().text;
    EXPECT_NE(read.error().text.find(mistake.says), std::string::npos) << read.error().text;
    EXPECT_EQ(read.error().text.find('\n'), std::string::npos);
  }
}

TEST(Case, WhatTheLibraryTakesForGrantedIsRefusedToo) {
  // three brackets stop a debug build inside toml++ itself
  const auto read = parse_case("[[[", "a.toml");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().text.find("a.toml: line 1"), std::string::npos) << read.error().text;
}

TEST(Case, AWordOutOfTheFileCannotMoveTheCursor) {
  const auto read =
      parse_case(with(kGood, "\"diamond\"", "\"\\u001B[2J" + std::string(9999, 'x') + "\""), "a");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().text.find('\x1B'), std::string::npos);
  EXPECT_LT(read.error().text.size(), 300U);
}

TEST(Case, NoTextHoweverBrokenDoesHarm) {
  const std::uint64_t seed = 91;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  for (int n = 0; n < 5000; ++n) {
    std::string text = kGood;
    for (int hits = 1 + static_cast<int>(random() % 4); hits > 0; --hits) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0)
        text[at] = static_cast<char>(random());
      else
        text.erase(at, random() % 20);
    }
    const auto read = parse_case(text, "broken.toml");
    if (!read) {
      EXPECT_EQ(read.error().text.find("broken.toml: "), 0U) << read.error().text;
    }
  }
}

TEST(Case, AFileIsFoundByPathAndItsVolumeLiesBesideIt) {
  const test::Folder own;
  const std::filesystem::path folder = own / "cases";
  std::filesystem::create_directories(folder);
  const auto path = folder / "own.toml";
  std::ofstream(path) << with(kGood, "phantom = \"block\"",
                              "rubric = \"marks.toml\"\nvolume = \"\"\"\\\n  scan.nrrd\"\"\"");
  const auto read = read_case(path.string());
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_EQ(read->name, "own");
  EXPECT_EQ(read->volume, (folder / "scan.nrrd").string());
  EXPECT_EQ(read->rubric, (folder / "marks.toml").string());
  EXPECT_FALSE(names_no_file(*read));
  // a recording keeps the text, and no name of a file
  const auto kept = parse_case(read->text, "own.toml");
  ASSERT_TRUE(kept.ok()) << kept.error().text;
  EXPECT_EQ(kept->volume, kOwnFile);
  EXPECT_EQ(kept->rubric, kOwnFile);
  EXPECT_TRUE(names_no_file(*kept));
  std::filesystem::remove_all(folder);

  const auto gone = read_case(path.string());
  ASSERT_FALSE(gone.ok());
  EXPECT_EQ(gone.error().trouble, Trouble::io);
  EXPECT_EQ(gone.error().text.find(folder.string()), std::string::npos) << "no path in messages";
  const auto unknown = read_case("elbow");
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().trouble, Trouble::usage);
  EXPECT_NE(unknown.error().text.find("temporal-bone"), std::string::npos);
}

TEST(Case, TheBuiltInOnesAreThere) {
  const auto names = built_in_cases();
  for (const char* name : {"temporal-bone", "jaw", "tooth", "spine", "block"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

// every built-in case begins on bone that may be cut, and names tissues that its bone has
TEST(Case, TheBuiltInOnesFitTheirBones) {
  for (const std::string& name : built_in_cases()) {
    SCOPED_TRACE(name);
    const auto read = read_case(name);
    ASSERT_TRUE(read.ok()) << read.error().text;
    EXPECT_FALSE(read->description.empty());
    EXPECT_GE(read->burr.radius, 2 * read->voxel) << "too coarse for the burr";
    NoProgress nobody;
    auto bone = phantom::phantom(read->phantom, 1600 * read->voxel, nobody, 0);
    ASSERT_TRUE(bone.ok()) << bone.error().text;
    const Status fits = check_tissues(*read, (*bone)->tissues());
    EXPECT_TRUE(fits.ok()) << fits.error().text;
    for (const std::string& spared : read->spare)
      for (const volume::Tissue& tissue : (*bone)->tissues().tissues)
        if (tissue.name == spared) {
          EXPECT_TRUE(tissue.spare) << spared;
        }

    ASSERT_TRUE(read->at && read->into);
    const volume::Grid& grid = (*bone)->grid();
    const volume::Pyramid pyramid(**bone);
    const math::Vec3 from = *read->at - 8e-3 * *read->into;
    const auto hit = pyramid.first_hit(grid.grid_from_world(from), *read->into, 16e-3 / grid.voxel);
    ASSERT_TRUE(hit.has_value()) << "no bone within 8 mm of where work begins";
    EXPECT_GT(*hit, 0);
    const math::Ijk voxel = grid.grid_from_world(from + (*hit + 0.7) * grid.voxel * *read->into)
                                .array()
                                .round()
                                .cast<int>();
    const volume::Tissue& met =
        (*bone)->tissues()[(*bone)->tissue(voxel.x(), voxel.y(), voxel.z())];
    EXPECT_FALSE(met.spare && name != "tooth") << met.name;
  }
}

TEST(Case, ATissueTheBoneLacksIsNamed) {
  auto read = parse_case(kGood, "my.toml");
  ASSERT_TRUE(read.ok());
  const Status status = check_tissues(*read, {});
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().text.find("my.toml: spare"), std::string::npos) << status.error().text;
  EXPECT_NE(status.error().text.find("\"nerve\""), std::string::npos);
}

}  // namespace
}  // namespace burr::scenario
