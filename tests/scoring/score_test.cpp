// Whole scores: an untouched bone earns nothing, a good cut earns what it should, a cut that went
// too far loses it.
#include "burr/scoring/score.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "burr/base/progress.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/reference.h"
#include "burr/volume/sample.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "metrics/metric_bones.h"

namespace burr::scoring {
namespace {

using metrics::test::kMm;

// A hard ball of 3 mm in a block that ends at z = 6 mm; the pit above it is to go.
constexpr const char* kLesson = R"(format = 2
title = "t"
phantom = "block"
approach = [[0, 0, 1]]
[burr]
diameter_mm = 4
[[structure]]
name = "ball"
names = ["hard"]
intact = "solid"
[[region]]
name = "pit"
add = [{ shape = "box", at = [0, 0, 5.5], size_mm = [30, 30, 4] }]
[reference]
remove = ["pit"]
)";

constexpr const char* kRubric = R"([rubric]
name = "ball"
version = 1
case = "block"
[[item]]
id = "ball.seen"
part = "product"
measure = "identified"
structure = "ball"
share = 0.1
requires = "ball.whole"
say = "Find the ball."
[[item]]
id = "ball.whole"
part = "product"
gate = true
measure = "intact_solid"
structure = "ball"
say = "Leave it whole."
[[item]]
id = "pit.gone"
part = "product"
measure = "removed"
region = "pit"
say = "Clear the pit."
[[item]]
id = "burr.choice"
part = "process"
measure = "burr_choice"
say = "Change the burr."
)";

// Everything above z [mm] is cut away.
Score score_of_cut(double z) {
  metrics::test::Plan plan;
  plan.bone = metrics::test::below(6 * kMm);
  plan.labels = {{phantom::ball(3 * kMm, {0, 0, 0}), metrics::test::kHard}};
  const auto bones = metrics::test::cut(plan, metrics::test::above(z * kMm), 0.4 * kMm);
  const auto lesson = scenario::parse_lesson(kLesson, "c.toml");
  const auto rubric = parse_rubric(kRubric, "r.toml");
  EXPECT_TRUE(lesson && rubric);
  EXPECT_TRUE(check(*rubric, *lesson));
  NoProgress quiet;
  auto made = score(*rubric, *lesson, *bones.before, *bones.after, nullptr, quiet);
  EXPECT_TRUE(made) << made.error().text;
  return std::move(*made);
}

TEST(Score, NothingCutEarnsNothing) {
  const Score idle = score_of_cut(20);
  EXPECT_EQ(idle.outcomes[0].verdict, Verdict::unmet);
  EXPECT_EQ(idle.outcomes[1].verdict, Verdict::unmet);
  EXPECT_FALSE(idle.outcomes[1].earned);
  EXPECT_EQ(idle.outcomes[2].verdict, Verdict::unmet);
  EXPECT_EQ(idle.worked, 0);
  EXPECT_FALSE(idle.product.points) << "there is no mark for no work";
  EXPECT_EQ(idle.product.met, 0U);
  EXPECT_EQ(idle.no_mark.why, NoMark::Why::part);
  EXPECT_EQ(idle.outcomes[3].verdict, Verdict::not_assessable);
  EXPECT_EQ(idle.outcomes[3].reason, "it needs a recording");
  EXPECT_FALSE(idle.process.points);
  EXPECT_TRUE(idle.unfinished);
}

TEST(Score, AGoodCutMeetsItsItems) {
  const Score good = score_of_cut(3.5);
  for (const std::size_t n : {0U, 1U, 2U})
    EXPECT_EQ(good.outcomes[n].verdict, Verdict::met) << good.outcomes[n].id;
  EXPECT_DOUBLE_EQ(good.product.points.value_or(-1), 100);
  EXPECT_GT(good.worked, 0.9);
  ASSERT_TRUE(good.outcomes[0].place);
  EXPECT_NEAR(good.outcomes[0].place->z(), 3 * kMm, 1 * kMm);  // its top
}

TEST(Score, WhatWasCutOpenWasNotFound) {
  const Score deep = score_of_cut(2);
  EXPECT_EQ(deep.outcomes[1].verdict, Verdict::unmet);
  EXPECT_TRUE(deep.outcomes[1].earned);
  EXPECT_GT(deep.outcomes[1].value.value_or(0), 1e-9);
  EXPECT_EQ(deep.outcomes[0].verdict, Verdict::unmet);
  EXPECT_EQ(deep.outcomes[0].reason, "it requires \"ball.whole\", which is not met");
  EXPECT_NEAR(deep.product.points.value_or(-1), 100.0 / 3, 1e-9);
}

TEST(Score, NamesTheSpotsItLookedAt) {
  const auto count = [](const Score& score, Spot::Kind kind) {
    const auto& spots = score.outcomes[0].spots;
    return std::count_if(spots.begin(), spots.end(), [&](auto& s) { return s.kind == kind; });
  };
  const Score idle = score_of_cut(20), good = score_of_cut(3.5);
  EXPECT_GT(count(idle, Spot::Kind::left), 50);
  EXPECT_EQ(count(idle, Spot::Kind::good), 0);
  ASSERT_GT(count(good, Spot::Kind::good), 10);
  EXPECT_LE(good.outcomes[0].spots.size(), kMostSpots);
  for (const Spot& spot : good.outcomes[0].spots) {
    EXPECT_NEAR(spot.at.norm(), 3 * kMm, 0.5 * kMm);  // on the ball
    if (spot.kind != Spot::Kind::good) continue;
    EXPECT_GT(spot.at.z(), 0);
  }
}

TEST(Score, ShowsWhatTheCaseSaysToRemove) {
  const Score score = score_of_cut(20);
  ASSERT_TRUE(score.shown.remove);
  EXPECT_NEAR(score.shown.remove({0, 0, 5.5 * kMm}), 2 * kMm, 1e-9);  // the middle of the pit
  EXPECT_LT(score.shown.remove({0, 0, 0}), 0);
  EXPECT_FALSE(score.shown.keep);
  EXPECT_EQ(score.shown.regions.count("pit"), 1U);
  EXPECT_TRUE(score.shown.track.samples.empty());  // without a recording
}

// The pit reaches down to 0.5 mm from the ball; the reference leaves 1 mm of bone over it.
TEST(Score, TheReferenceLeavesBoneOverAStructure) {
  metrics::test::Plan plan;
  plan.bone = metrics::test::below(6 * kMm);
  plan.labels = {{phantom::ball(3 * kMm, {0, 0, 0}), metrics::test::kHard}};
  auto bones = metrics::test::cut(plan, metrics::test::above(20 * kMm), 0.25 * kMm);
  const auto lesson = scenario::parse_lesson(
      std::string(kLesson) + "leave = [{ structure = \"ball\", mm = 1 }]\n", "c.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  NoProgress quiet;
  ASSERT_TRUE(cut_to_reference(*bones.after, *bones.before, *lesson, quiet));
  const auto depth = [&](const math::Vec3& p) { return volume::depth_at(*bones.after, p); };
  EXPECT_GT(depth({0, 0, 3.7 * kMm}), 0);
  EXPECT_LT(depth({0, 0, 4.3 * kMm}), 0);
  EXPECT_LT(depth({6 * kMm, 0, 3.8 * kMm}), 0);  // beside the ball the whole pit is gone
  EXPECT_GT(depth({6 * kMm, 0, 3.2 * kMm}), 0);
}

// A face cut at z [mm] with that tilt, planned at 3 mm and level.
std::set<std::string> unmet_of_face(double z, double tilt_deg) {
  metrics::test::Plan plan;
  plan.bone = metrics::test::below(6 * kMm);
  const double a = tilt_deg * M_PI / 180;
  const math::Vec3 normal = {std::sin(a), 0, std::cos(a)};
  const auto bones = metrics::test::cut(
      plan, [=](const math::Vec3& p) { return normal.dot(p) - z * kMm * normal.z(); }, 0.4 * kMm);
  auto lesson = scenario::parse_lesson(std::string(kLesson) + R"(
[[landmark]]
name = "face"
at_mm = [0, 0, 3]
normal = [0, 0, 1]
)",
                                       "c.toml");
  std::string text = "[rubric]\nname = \"face\"\nversion = 1\ncase = \"block\"\n";
  for (const char* what : {"offset", "angle", "even"})
    text += fmt::format(
        "[[item]]\nid = \"{0}\"\npart = \"product\"\nmeasure = \"plane_{0}\"\nregion = "
        "\"pit\"\nplane = "
        "\"face\"\nsay = \"s\"\n",
        what);
  const auto rubric = parse_rubric(text, "r.toml");
  EXPECT_TRUE(rubric && lesson && check(*rubric, *lesson));
  NoProgress quiet;
  const auto made = score(*rubric, *lesson, *bones.before, *bones.after, nullptr, quiet);
  std::set<std::string> ids;
  for (const Outcome& one : made->outcomes)
    if (one.verdict != Verdict::met) ids.insert(one.id);
  return ids;
}

TEST(Score, AFaceBesideItsPlanLosesTheOffsetAndATiltedOneTheAngle) {
  EXPECT_EQ(unmet_of_face(3.6, 0), std::set<std::string>{});
  EXPECT_EQ(unmet_of_face(4.9, 0), std::set<std::string>{"offset"});
  EXPECT_EQ(unmet_of_face(4.2, 8), std::set<std::string>{"angle"});
  EXPECT_EQ(unmet_of_face(20, 0),
            (std::set<std::string>{"angle", "even", "offset"}));  // nothing cut
}

TEST(Score, TheUntouchedTemporalBoneMeetsNothing) {
  const auto work = scenario::read_case("temporal-bone");
  const auto rubric = read_rubric("temporal-bone");
  ASSERT_TRUE(work && rubric);
  auto read = scenario::lesson_of(*work);
  ASSERT_TRUE(read);
  const auto lesson =
      scenario::place(std::move(*read), workshop::landmarks_of(*work), "temporal-bone.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  ASSERT_TRUE(check(*rubric, *lesson)) << check(*rubric, *lesson).error().text;
  scenario::BoneRecipe coarse;
  coarse.voxel_mm = 0.5;
  NoProgress quiet;
  const auto made = workshop::open_bone(workshop::recipe_of(*work, coarse), quiet);
  ASSERT_TRUE(made) << made.error().text;
  const auto idle = score(*rubric, *lesson, *made->bone, *made->bone, nullptr, quiet);
  ASSERT_TRUE(idle) << idle.error().text;
  EXPECT_EQ(idle->product.met, 0U);
  EXPECT_GE(idle->product.assessable, 15U);
  for (const Outcome& one : idle->outcomes) EXPECT_NE(one.verdict, Verdict::met) << one.id;
}

}  // namespace
}  // namespace burr::scoring
