// The language of the tables, the right values against integrals done by hand, and the tables that are built in.
#include "burr/proof/known_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/proof/ask.h"

namespace burr::proof {
namespace {

TEST(KnownTable, ReadsBonesNamesAndAnswers) {
  const auto table = read_table(
      "case block   # a comment\n"
      "coarser 0.5\n"
      "few 1\n"
      "let A  cap -15 0 15 15 0 15 2\n"
      "let B  {A} ; ball 0 0 0 1\n"
      "left out: strokes.long  it is not of the bone\n"
      "bone one\n"
      "  cut {B}\n"
      "  groove.cleared,groove.floor  0.5  share\n"
      "  groove.depth  unmet\n",
      "t.txt");
  ASSERT_TRUE(table) << table.error().text;
  EXPECT_EQ(table->case_name, "block");
  EXPECT_EQ(table->coarser_mm, 0.5);
  EXPECT_EQ(table->few, 1U);
  ASSERT_EQ(table->bones.size(), 1U);
  EXPECT_EQ(table->bones[0].shapes, "cap -15 0 15 15 0 15 2 ; ball 0 0 0 1");
  ASSERT_EQ(table->bones[0].right.size(), 3U);
  EXPECT_EQ(table->bones[0].right[1].item, "groove.floor");
  EXPECT_EQ(table->bones[0].right[1].tolerance.fixed, kShare.fixed);
  EXPECT_EQ(table->bones[0].right[2].verdict, kUnmet);
  ASSERT_EQ(table->left_out.size(), 1U);
  EXPECT_EQ(table->left_out[0].why, "it is not of the bone");
}

TEST(KnownTable, SaysWhichLineIsWrong) {
  const std::vector<std::pair<const char*, const char*>> wrong = {
      {"coarser 0.5\n", "names no case"},
      {"case x\ncoarser -1\n", "line 2"},
      {"case x\nfew none\n", "gives no number of bones"},
      {"case x\nbone\n", "names no bone"},
      {"case x\na.b met\n", "before the first bone"},
      {"case x\nbone b\ncut {NOBODY}\n", "{NAME}"},
      {"case x\nbone b\na.b 1\n", "no answer"},
      {"case x\nbone b\na.b one width\n", "neither a number nor"},
      {"case x\nbone b\na.b 1 wide\n", "no tolerance"},
      {"case x\nleft out: a.b\n", "without a reason"}};
  for (const auto& [text, why] : wrong) {
    const auto table = read_table(text, "t.txt");
    ASSERT_FALSE(table) << text;
    EXPECT_NE(table.error().text.find(why), std::string::npos) << table.error().text;
  }
}

// A block of bone, of which every share, gap and height is known.
TEST(RightValue, IsWhatAnIntegralByHandGives) {
  NoProgress quiet;
  auto block = KnownBone::make({.case_name = "block", .voxel_mm = 0.5}, quiet);
  ASSERT_TRUE(block) << block.error().text;
  const Places places = {{"line", {{{-10, 0, 0}, {10, 0, 0}}, {}}}};
  const auto is = [&](const RightValue& value, const char* shapes) {
    const auto work = read_work(shapes, places);
    return value({block->before(), places, *work});
  };
  EXPECT_NEAR(is(share_gone("box 0 0 0 10 10 10"), "half 1 0 0 2.5"), 0.25, 0.005);
  EXPECT_NEAR(is(volume_gone("ball 0 0 0 9"), "ball 0 0 0 3"), 36 * M_PI, 1);
  EXPECT_NEAR(is(share_filled("box 0 0 16 10 10 2"), "+ half 0 0 -1 -15.5"), 0.25, 0.02);
  EXPECT_NEAR(is(share_beside("box 0 0 16 10 10 2"), "+ box 0 0 16 20 10 2"), 0.5, 0.02);
  EXPECT_NEAR(is(least_gap("ball 0 0 0 20", from_tube("line", 1), 50), "box 0 0 8 6 6 6"), 4, 0.05);
  EXPECT_NEAR(is(least_gap("ball 0 0 0 20", from_oval(0, 4, 2), 50), "box 0 8 0 6 6 6"), 3, 0.05);
  EXPECT_NEAR(is(median_above("box 0 0 12 4 4 6", 9, 1), ""), 5, 0.1) << "15 - 9, less 1";
  EXPECT_TRUE(std::isnan(is(share_gone("box 0 0"), "")));
}

// A wrong right value must be seen.
TEST(Ask, TellsRightFromWrong) {
  NoProgress quiet;
  auto block = KnownBone::make({.case_name = "block", .voxel_mm = 0.5}, quiet);
  ASSERT_TRUE(block) << block.error().text;
  const auto table = read_table(
      "case block\n"
      "bone first groove\n"
      "  cut cap -15 0 15 15 0 15 2\n"
      "  groove.cleared         1    border\n"
      "  second-groove.cleared  1    share\n"
      "  groove.depth           0.5  cavity\n"
      "  groove.outline         unmet\n",
      "t.txt");
  ASSERT_TRUE(table) << table.error().text;
  const auto answers = ask(*block, table->bones[0], quiet);
  ASSERT_TRUE(answers) << answers.error().text;
  ASSERT_EQ(answers->size(), 4U);
  const std::vector<Answer>& a = *answers;
  EXPECT_TRUE(a[0].value_holds() && a[0].verdict_holds());
  EXPECT_EQ(a[0].must, kMet) << "from its threshold";
  EXPECT_FALSE(a[1].value_holds());
  EXPECT_FALSE(a[1].verdict_holds());
  EXPECT_FALSE(a[2].value_holds());
  EXPECT_FALSE(a[3].verdict_holds());
  const auto sided = one_sided(block->rubric(), *table, a);
  EXPECT_NE(std::find(sided.begin(), sided.end(), "groove.floor"), sided.end());
  KnownLine no_item{"x", "", {}};
  no_item.right.emplace_back("no.item", kMet);
  EXPECT_FALSE(ask(*block, no_item, quiet));
}

TEST(BuiltInTables, HoldEightBonesOrMoreOfEveryCase) {
  ASSERT_EQ(known_cases().size(), 5U);
  for (const std::string& name : known_cases()) {
    const auto table = known_table(name);
    ASSERT_TRUE(table) << table.error().text;
    EXPECT_EQ(table->case_name, name);
    EXPECT_GE(table->bones.size(), 8U) << name;
    EXPECT_GT(table->coarser_mm, 0) << name;
    for (const KnownLine& bone : table->bones) EXPECT_FALSE(bone.right.empty()) << bone.name;
  }
  EXPECT_FALSE(known_table("no-case"));
}

}  // namespace
}  // namespace burr::proof
