// Cheap ways to a mark: what each leaves of the block, by closed form; a rubric that one of them beats is named.
#include "burr/proof/tricks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "burr/proof/cheap_marks.h"
#include "burr/proof/known_bone.h"
#include "burr/scenario/case.h"
#include "burr/workshop/prepare.h"
#include "support/folder.h"

namespace burr::proof {
namespace {

template <class One>
const One& named(const std::vector<One>& all, const std::string& name) {
  for (const One& one : all)
    if (one.name == name) return one;
  ADD_FAILURE() << "no trick \"" << name << '"';
  return all.front();
}

TEST(Tricks, OfTheBlockHaveNoMarkOrNoWork) {
  NoProgress quiet;
  const auto block = KnownBone::make({.case_name = "block"}, quiet);
  ASSERT_TRUE(block);
  const auto work = scenario::read_case("block");
  ASSERT_TRUE(work);
  const auto tried = try_tricks(block->rubric(), block->lesson(), workshop::recipe_of(*work),
                                2 * work->burr.radius, 1, quiet);
  ASSERT_TRUE(tried) << tried.error().text;
  EXPECT_GE(tried->size(), 12U);
  using Why = scoring::NoMark::Why;
  EXPECT_EQ(named(*tried, "nothing").product.met, 0U);
  EXPECT_EQ(named(*tried, "everything").no_mark.why, Why::gone);
  EXPECT_EQ(named(*tried, "flat to the floor").no_mark.why, Why::gone);
  // the top of 40 x 40 mm2 to the deepest voxel of the plan, but for what lies within 2 mm of the grooves: capsules of 30 mm
  // and radius 4 mm about their axes in the top
  const double d = 2 - 0.125, part = 0.5 * d * std::sqrt(16 - d * d) + 8 * std::asin(d / 4);
  const double beside = 2 * (2 * 30 * part + M_PI * (16 * d - d * d * d / 3));
  EXPECT_NEAR(1e9 * named(*tried, "flat to the floor").no_mark.elsewhere, 1600 * d - beside, 40);
  EXPECT_EQ(named(*tried, "exact, and half of the bone gone").no_mark.why, Why::gone);
  EXPECT_EQ(named(*tried, "only \"groove\"").no_mark.why, Why::part);
  EXPECT_EQ(named(*tried, "only \"groove\"").no_mark.part, "second groove");
  EXPECT_EQ(named(*tried, "shifted to one side").product.points.value_or(0), 0);
  // holes of 1 mm every 3 mm: pi / 36 of the plan
  EXPECT_NEAR(named(*tried, "peep-holes").no_mark.share, M_PI / 36, 0.04);
}

// The whole top is to go, and one item asks whether any of it is gone: half of it off in one plane earns all.
TEST(Tricks, TellARubricThatCanBeBeaten) {
  const test::Folder folder;
  const std::string file = (folder.path() / "weak.toml").string(),
                    work_file = (folder.path() / "top.toml").string();
  const auto block = scenario::read_case("block");
  ASSERT_TRUE(block);
  std::string text = block->text;
  const std::string two = "remove = [\"groove\", \"second groove\"]";
  ASSERT_NE(text.find(two), std::string::npos);
  text.replace(text.find(two), two.size(), "remove = [\"top\"]");
  text +=
      "\n[[region]]\nname = \"top\"\n"
      "add = [{ shape = \"box\", at = [0, 0, 14], size_mm = [44, 44, 4] }]\n";
  std::ofstream(work_file) << text;
  const auto rubric_of = [&file](const char* share) {
    std::ofstream(file) << "[rubric]\nname = \"weak\"\nversion = 1\ncase = \"top.toml\"\n"
                           "[[item]]\nid = \"begun\"\npart = \"product\"\nmeasure = \"removed\"\n"
                           "region = \"top\"\nshare = "
                        << share << "\nsay.en = \"Begin.\"\n";
  };
  const auto work = scenario::read_case(work_file);
  ASSERT_TRUE(work) << work.error().text;
  NoProgress quiet;
  rubric_of("0.01");
  const auto marks = cheap_marks(file, *work, {}, {.careless = 1}, quiet);
  ASSERT_TRUE(marks) << marks.error().text;
  ASSERT_TRUE(marks->careless);
  EXPECT_EQ(marks->careless->product.met, 1) << "he cuts the grooves";
  const CheapMark& half = named(marks->tricks, "flat to the middle");
  EXPECT_TRUE(half.beats) << half.no_mark;
  EXPECT_EQ(half.earned, std::vector<std::string>{"begun"});
  EXPECT_FALSE(named(marks->tricks, "nothing").beats);
  EXPECT_FALSE(named(marks->tricks, "everything").beats) << "it is gone, and the block too";
}

// A case without a reference: a sentence, and no cheap way is made up.
TEST(Tricks, NeedAReference) {
  const test::Folder folder;
  const std::string file = (folder.path() / "weak.toml").string(),
                    work_file = (folder.path() / "plain.toml").string();
  const auto block = scenario::read_case("block");
  ASSERT_TRUE(block);
  std::ofstream(work_file) << block->text.substr(0, block->text.find("[reference]"));
  std::ofstream(file) << "[rubric]\nname = \"weak\"\nversion = 1\ncase = \"plain.toml\"\n"
                         "[[item]]\nid = \"begun\"\npart = \"product\"\nmeasure = \"removed\"\n"
                         "region = \"groove\"\nshare = 0.5\nsay.en = \"Begin.\"\n";
  const auto work = scenario::read_case(work_file);
  ASSERT_TRUE(work) << work.error().text;
  NoProgress quiet;
  const auto marks = cheap_marks(file, *work, {}, {.careless = 1}, quiet);
  ASSERT_FALSE(marks);
  EXPECT_EQ(
      marks.error().text,
      "weak.toml: the case \"plain\" has no [reference] with regions to remove, from which cheap "
      "ways to a mark are made; add it to the case");
}

}  // namespace
}  // namespace burr::proof
