// Work that is not that of its case has no mark, whatever its items say (scoring/whole_work.h): on bones of known volumes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "burr/base/progress.h"
#include "burr/proof/known_bone.h"
#include "burr/scoring/whole_work.h"

namespace burr::proof {
namespace {

using scoring::NoMark;

constexpr const char* kGroove = "cap -15 0 15 15 0 15 2";
constexpr const char* kSecond = "cap -15 10 15 15 10 15 2";
const std::string kBoth = std::string(kGroove) + " ; " + kSecond;
// of both grooves: half a cylinder, and two quarters of a ball, each [mm3]
const double kPlanned = 2 * (0.5 * M_PI * 4 * 30 + 0.5 * 4.0 / 3 * M_PI * 8);

class NoMarkTest : public ::testing::Test {
 protected:
  static KnownBone made(const std::string& name) {
    NoProgress quiet;
    auto bone = KnownBone::make({.case_name = name}, quiet);
    EXPECT_TRUE(bone) << bone.error().text;
    return std::move(*bone);
  }
  static void cut(KnownBone& bone, const std::string& shapes) {
    NoProgress quiet;
    const Status done = bone.cut(shapes, quiet);
    ASSERT_TRUE(done) << done.error().text;
  }
};

TEST_F(NoMarkTest, WhoDoesAllPartsHasOne) {
  KnownBone block = made("block");
  cut(block, kBoth);
  EXPECT_FALSE(block.score().no_mark) << text_of(block.score().no_mark);
  EXPECT_GT(block.score().product.points.value_or(0), 90);
}

TEST_F(NoMarkTest, WhoLeavesAPartOutHasNone) {
  KnownBone block = made("block");
  cut(block, kGroove);
  const NoMark& none = block.score().no_mark;
  EXPECT_EQ(none.why, NoMark::Why::part);
  EXPECT_EQ(none.part, "second groove");
  EXPECT_NEAR(none.share, 0, 0.001);
  EXPECT_FALSE(block.score().product.points);
  EXPECT_EQ(text_of(none), "of the part \"second groove\" 0 % is done, less than 20 %");
  // 15 % of the second one: a stroke along 4.5 of its 30 mm
  cut(block, std::string(kGroove) + " ; cyl -15 10 15 -10.5 10 15 2");
  EXPECT_EQ(block.score().no_mark.why, NoMark::Why::part);
  EXPECT_NEAR(block.score().no_mark.share, 0.5 * M_PI * 4 * 4.5 / (0.5 * kPlanned), 0.02);
  cut(block, std::string(kGroove) + " ; cyl -15 10 15 -7 10 15 2");  // 24 %
  EXPECT_FALSE(block.score().no_mark) << text_of(block.score().no_mark);
}

TEST_F(NoMarkTest, WhoCutsAwayWhatIsNotPlannedHasNone) {
  KnownBone block = made("block");
  cut(block, kBoth + " ; half 0 -1 0 5");  // y < -5 mm: 40 x 15 x 30 mm3 of the block
  const NoMark& none = block.score().no_mark;
  EXPECT_EQ(none.why, NoMark::Why::gone);
  EXPECT_NEAR(1e9 * none.elsewhere, 40 * 15 * 30, 0.03 * 40 * 15 * 30);
  EXPECT_NEAR(none.share, 40 * 15 * 30 / kPlanned, 0.05 * none.share);
  // half of what is allowed: a ball of 20 mm3 within the block, 8 mm beside the first groove
  cut(block, kBoth + " ; ball 0 -10 5 1.7");
  EXPECT_FALSE(block.score().no_mark) << text_of(block.score().no_mark);
}

TEST_F(NoMarkTest, WhatIsAddedDoesNotMakeUpForWhatIsGone) {
  KnownBone block = made("block");
  // 320 mm3 are gone within the block, and as much is added on its top
  cut(block, kBoth + " ; box 0 -15 0 20 8 2 ; + box 0 -15 16 20 8 2");
  EXPECT_EQ(block.score().no_mark.why, NoMark::Why::gone);
  EXPECT_NEAR(1e9 * block.score().no_mark.elsewhere, 320, 10);
  cut(block, kBoth + " ; + box 0 -15 16 20 8 2");
  EXPECT_EQ(block.score().no_mark.why, NoMark::Why::added);
  EXPECT_NEAR(1e9 * block.score().no_mark.elsewhere, 320, 10);
}

TEST_F(NoMarkTest, AnItemIsEarnedByItsOwnPart) {
  KnownBone tooth = made("tooth");
  cut(tooth, "box -0.1 -2.7 7.1 2.4 2.4 5");  // the pit's cavity alone
  EXPECT_EQ(tooth.score().no_mark.why, NoMark::Why::part);
  for (const char* id : {"roof.kept", "dentine.spared", "pulp.covered", "pulp.not-bare"}) {
    ASSERT_NE(tooth.outcome(id), nullptr) << id;
    EXPECT_EQ(standing_of(*tooth.outcome(id)), scoring::Standing::too_early) << id;
  }
  for (const char* id : {"pit.cleared", "pit.outline", "pit.depth", "pit.spared"})
    EXPECT_EQ(standing_of(*tooth.outcome(id)), scoring::Standing::met) << id;
}

// A plane milled off the block leaves no rim: the outline is not met, and it stays among the items.
TEST_F(NoMarkTest, WhatTheWorkLeftWithoutAShapeIsNotMet) {
  KnownBone block = made("block");
  cut(block, "half 0 0 1 13");
  const scoring::Total& product = block.score().product;
  EXPECT_EQ(product.assessable, product.items);
  EXPECT_EQ(standing_of(*block.outcome("groove.outline")), scoring::Standing::not_met);
  EXPECT_EQ(block.score().no_mark.why, NoMark::Why::gone);
}

}  // namespace
}  // namespace burr::proof
