// What a surgeon believes and means to remove, on a block whose answer is known.
#include "burr/surgeon/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

#include "burr/surgeon/step_work.h"
#include "surgeon/surgeon_bone.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

Believed believed(const volume::Bone& bone, const scenario::CaseLesson& lesson, double rms,
                  std::uint64_t seed) {
  NoProgress quiet;
  auto made = Believed::make(bone, lesson, rms, seed, quiet);
  EXPECT_TRUE(made.ok());
  return std::move(*made);
}

TEST(Believed, WithoutErrorDistancesAreTrue) {
  const auto bone = block_with_vein(0.25);
  const scenario::CaseLesson lesson = block_lesson();
  const Believed seen = believed(*bone, lesson, 0, 1);
  EXPECT_EQ(seen.error_of("vein"), Vec3(Vec3::Zero()));
  for (const Vec3& p : {Vec3(0, 0, -1 * kMm), Vec3(2 * kMm, 3 * kMm, -4 * kMm)})
    EXPECT_NEAR(seen.distance("vein", p), -kVein(p), 0.15 * kMm);
  EXPECT_TRUE(std::isinf(seen.distance("nerve", Vec3::Zero())));
}

TEST(Believed, AStructureIsMovedAsAWholeByItsError) {
  const auto bone = block_with_vein(0.25);
  const scenario::CaseLesson lesson = block_lesson();
  const Believed truth = believed(*bone, lesson, 0, 1);
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    const Believed seen = believed(*bone, lesson, 1.5 * kMm, seed);
    const Vec3 e = seen.error_of("vein");
    EXPECT_GT(e.norm(), 0);
    EXPECT_NE(e, seen.error_of("stone"));
    for (const Vec3& p : {Vec3(0, 0, -1 * kMm), Vec3(2 * kMm, 3 * kMm, -2 * kMm)})
      EXPECT_DOUBLE_EQ(seen.distance("vein", p), truth.distance("vein", p - e));
  }
}

TEST(Believed, ErrorsHaveTheRmsPerAxis) {
  const auto bone = block_with_vein(0.5);
  const scenario::CaseLesson lesson = block_lesson();
  double square = 0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    square += believed(*bone, lesson, 0.5 * kMm, seed).error_of("vein").squaredNorm();
  EXPECT_NEAR(std::sqrt(square / (3 * kSeeds)), 0.5 * kMm, 0.05 * kMm);
}

TEST(Believed, APlanIsMovedByItsErrorAndItsCurvesAreTilted) {
  const auto bone = block_with_vein(0.5);
  scenario::CaseLesson lesson = block_lesson();
  scenario::CaseRegion bore;
  bore.name = "bore";
  scenario::Shape tube;
  tube.kind = scenario::ShapeKind::tube;
  tube.points = {Vec3(0, 0, 0), Vec3(0, 0, -8) * kMm};
  tube.radius = 1 * kMm;
  bore.add = {tube};
  lesson.regions.push_back(bore);
  double square = 0;
  constexpr int kSeeds = 100;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Believed seen = believed(*bone, lesson, 0.5 * kMm, seed);
    const Believed::PlanError error = seen.plan_error_of("bore");
    EXPECT_NE(error.first, error.last);
    EXPECT_NE(error.first, seen.plan_error_of("trough").first);
    square += error.first.squaredNorm() + error.last.squaredNorm();
    const auto depth = seen.region(lesson.regions.back());
    EXPECT_NEAR(depth(error.first), 1 * kMm, 1e-9);
    EXPECT_NEAR(depth(Vec3(0, 0, -8 * kMm) + error.last), 1 * kMm, 1e-9);
    EXPECT_NEAR(depth(Vec3(0, 0, -4 * kMm) + 0.5 * (error.first + error.last)), 1 * kMm, 1e-9);
  }
  EXPECT_NEAR(std::sqrt(square / (6 * kSeeds)), 0.5 * kMm, 0.05 * kMm);
  const Believed truth = believed(*bone, lesson, 0, 1);
  EXPECT_NEAR(truth.region(lesson.regions.back())(Vec3(0, 0, -3 * kMm)), 1 * kMm, 1e-12);
}

// How many of 30 surgeons believe that the middle of the vein is free, with its margin.
int who_miss_the_vein(double perception) {
  const auto bone = block_with_vein(0.5);
  const scenario::CaseLesson lesson = block_lesson();
  int missed = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Believed seen = believed(*bone, lesson, perception, seed);
    missed += seen.distance("vein", Vec3(0, 0, -5 * kMm)) > 1 * kMm ? 1 : 0;
  }
  return missed;
}

TEST(Believed, ALargeErrorOfPerceptionMissesWhatIsToBeSpared) {
  EXPECT_EQ(who_miss_the_vein(0.25 * kMm), 0);
  EXPECT_GE(who_miss_the_vein(4 * kMm), 15);
}

// A step may be done from another side than the rest of the case.
TEST(Goal, GoesInFromWhereTheStepSays) {
  const auto bone = block_with_vein(0.25);
  scenario::CaseLesson lesson = block_lesson();
  scenario::Step step;
  EXPECT_EQ(approach_of(lesson, step), approach_of(lesson));
  step.approach = {Vec3::UnitX()};
  EXPECT_EQ(approach_of(lesson, step), step.approach);
  scenario::Shape& box = lesson.regions.front().add.front();
  box.a.at = Vec3(0, 1, -2) * kMm;  // beside the vein's margin, and below the surface
  box.size = Vec3(2, 2, 1) * kMm;
  const Believed seen = believed(*bone, lesson, 0, 1);
  const Spare spare = spare_of(bone->grid(), lesson, seen, 0);
  const Vec3 above = Vec3(0, 1, -0.5) * kMm, beside = Vec3(3, 1, -2) * kMm;
  const FieldGrid down = goal_of(lesson.regions.front(), approach_of(lesson), seen, spare);
  EXPECT_GT(down.at(above), 0);
  EXPECT_LT(down.at(beside), 0);
  const FieldGrid across = goal_of(lesson.regions.front(), approach_of(lesson, step), seen, spare);
  EXPECT_LT(across.at(above), 0);
  EXPECT_GT(across.at(beside), 0);
}

TEST(Goal, ACorridorThatReachesTheSurfaceHasStraightWalls) {
  const auto bone = block_with_vein(0.25);
  scenario::CaseLesson lesson = block_lesson();
  scenario::Shape& box = lesson.regions.front().add.front();
  const Believed seen = believed(*bone, lesson, 0, 1);
  const Spare spare = spare_of(bone->grid(), lesson, seen, 0);
  // the trough's wall is at y = -3
  EXPECT_LT(goal_of(lesson.regions.front(), approach_of(lesson), seen, spare)
                .at(Vec3(-4, -3.3, -0.3) * kMm),
            0);
  // below the surface, the way in to it may open outwards
  box.a.at = Vec3(0, 1, -4) * kMm;
  box.size = Vec3(10, 8, 1) * kMm;
  const FieldGrid buried = goal_of(lesson.regions.front(), approach_of(lesson), seen, spare);
  EXPECT_GT(buried.at(Vec3(-4, 5.2, -0.3) * kMm), 0);
  EXPECT_LT(buried.at(Vec3(-4, 5.2, -3.6) * kMm), 0);
}

// A surgeon's work where the plan is one groove along x, through the middle of the block's top. [m]
struct GrooveWork {
  GrooveWork(double half_length, double radius, const Skill& skill, double case_diameter,
             std::optional<std::pair<double, double>> tool = {})
      : lesson([&] {
          scenario::CaseLesson made = block_lesson();
          scenario::Shape groove;
          groove.kind = scenario::ShapeKind::capsule;
          groove.a.at = Vec3(-half_length, 0, 0);
          groove.b.at = Vec3(half_length, 0, 0);
          groove.radius = radius;
          made.regions.front().add = {groove};
          if (tool) made.steps.front().diameter = tool;
          return made;
        }()),
        seen(believed(*bone, lesson, 0, 1)),
        spare(spare_of(bone->grid(), lesson, seen, 0)),
        goal(goal_of(lesson.regions.front(), approach_of(lesson), seen, spare)),
        work(*bone, lesson.steps.front(), lesson, goal, goal, spare, skill, case_diameter) {}

  decltype(block_with_vein(0.25)) bone = block_with_vein(0.25);
  scenario::CaseLesson lesson;
  Believed seen;
  Spare spare;
  FieldGrid goal;
  StepWork work;
};

TEST(StepWork, ABurrThatIsTooWideForThePlanIsChanged) {
  // the only burr of a careless one is 2.4 mm wide
  GrooveWork on(4 * kMm, 1 * kMm, skill_of(Level::careless), 3 * kMm);
  EXPECT_GT(on.work.count(), 10U);
  people::RandomStream random(1, 3);
  std::optional<NextStroke> next;
  for (int n = 0; n < 20 && !next && !on.work.exhausted(); ++n)
    next = on.work.next(*on.bone, Vec3(0, 0, 20 * kMm), {1.2 * kMm}, random);
  ASSERT_TRUE(next);
  EXPECT_LE(next->burr.radius, 1 * kMm);
}

// Nobody strokes for a minute with a burr that removes nothing.
TEST(StepWork, ABurrThatRemovesNothingIsChangedSoon) {
  Skill skill;
  GrooveWork on(7 * kMm, 3 * kMm, skill, 3 * kMm);
  people::RandomStream random(1, 3);
  std::optional<double> first;
  double last = 0;
  for (int n = 0; n < 20; ++n) {
    const auto next = on.work.next(*on.bone, Vec3(0, 0, 20 * kMm), {1 * kMm}, random);
    if (!next) continue;
    if (!first) first = next->burr.radius;
    last = next->burr.radius;
  }
  ASSERT_TRUE(first);
  EXPECT_LT(last, *first);
}

// The step names burrs of 2 to 3 mm; the level's own for this place is 1.2 mm wide.
TEST(StepWork, TheBurrIsThatOfTheStepWhereItFits) {
  Skill skill;
  skill.burrs.far = 0.4;
  GrooveWork on(7 * kMm, 3 * kMm, skill, 3 * kMm, std::pair{2 * kMm, 3 * kMm});
  people::RandomStream random(1, 3);
  std::optional<NextStroke> next;
  for (int n = 0; n < 20 && !next; ++n)
    next = on.work.next(*on.bone, Vec3(0, 0, 20 * kMm), {1 * kMm}, random);
  ASSERT_TRUE(next);
  EXPECT_DOUBLE_EQ(next->burr.radius, 1 * kMm);
}

// Across a narrow groove there is no room for a stroke, so most strokes of a surgeon who follows nothing
// run along it all the same.
TEST(StepWork, ADirectionWithoutRoomIsTriedAgain) {
  Skill skill;
  skill.along = 0;
  skill.burrs = {1, 1, 1, 1, 0, false};
  GrooveWork on(7 * kMm, 2 * kMm, skill, 3.2 * kMm);
  people::RandomStream random(1, 3);
  int strokes = 0, along = 0;
  for (int n = 0; n < 60; ++n) {
    const auto next = on.work.next(*on.bone, Vec3(0, 0, 20 * kMm), {1 * kMm}, random);
    if (!next) continue;
    ++strokes;
    if (std::abs(next->stroke.along.x()) > 0.8) ++along;
  }
  EXPECT_GT(strokes, 10);
  EXPECT_GT(2 * along, strokes);  // of one try each: 41 %
}

// A stone of 1.5 mm hangs 3 mm above a floor. What lies below its rim is reached aslant only: straight up the
// middle of a burr would pass beside the stone, and its side would cut it.
struct UnderAStone {
  UnderAStone(const Vec3& region, const Vec3& size, const Vec3& aslant = Vec3(0.8, 0, 0.6))
      : lesson([&] {
          scenario::CaseLesson made = block_lesson();
          made.approach = {Vec3::UnitZ(), aslant};
          made.regions.front().add.front().a.at = region;
          made.regions.front().add.front().size = size;
          return made;
        }()),
        seen(believed(*bone, lesson, 0, 1)),
        spare(spare_of(bone->grid(), lesson, seen, 0)),
        goal(goal_of(lesson.regions.front(), approach_of(lesson), seen, spare)),
        work(*bone, lesson.steps.front(), lesson, goal, goal, spare, skill(), 1.2 * kMm) {}

  static Skill skill() {
    Skill one;
    one.burrs = {1, 1, 1, 1, 0, false};
    return one;
  }
  static std::unique_ptr<volume::Bone> floor_and_stone() {
    volume::TissueTable tissues;
    tissues.tissues.push_back({.name = "stone", .cutting_energy = 1e9, .spare = true});
    phantom::Formula formula;
    const phantom::Depth stone = phantom::ball(1.5 * kMm, Vec3::Zero());
    const phantom::Depth floor = phantom::slab(Vec3::UnitZ(), Vec3(0, 0, -3 * kMm));
    formula.depth = [=](const Vec3& p) { return std::max(floor(p), stone(p)); };
    formula.tissue = [=](const Vec3& p, double depth) -> volume::TissueId {
      if (stone(p) > -0.5 * kMm) return 2;
      return depth > -2 * kMm ? 1 : 0;
    };
    NoProgress quiet;
    auto made = phantom::bone_from_formula(
        phantom::box_grid(Vec3(-9, -6, -7) * kMm, Vec3(9, 6, 6) * kMm, 0.25 * kMm), tissues,
        formula, 256, 2, quiet);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
  }
  // The burr's side meets the stone on the way from here in this direction.
  static bool hits(const Vec3& from, const Vec3& out) {
    for (double s = 0; s < 10 * kMm; s += 0.1 * kMm)
      if ((from + s * out).norm() < (1.5 + 0.6 - 0.2) * kMm) return true;
    return false;
  }

  decltype(floor_and_stone()) bone = floor_and_stone();
  scenario::CaseLesson lesson;
  Believed seen;
  Spare spare;
  FieldGrid goal;
  StepWork work;
};

TEST(StepWork, AStrokeHasAWayOutThatMissesWhatIsSpared) {
  UnderAStone on(Vec3(1.9, 0, -3.5) * kMm, Vec3(2.4, 3, 1.6) * kMm);
  people::RandomStream random(1, 3);
  int strokes = 0;
  for (int n = 0; n < 40; ++n) {
    const auto next = on.work.next(*on.bone, Vec3(2, 0, -2) * kMm, {0.6 * kMm}, random);
    if (!next) continue;
    ++strokes;
    EXPECT_FALSE(on.hits(next->stroke.start, next->stroke.out))
        << next->stroke.start.transpose() << ", " << next->stroke.out.transpose();
  }
  EXPECT_GT(strokes, 5);
}

TEST(StepWork, APlaceIsLeftOnItsOwnWayOut) {
  UnderAStone on(Vec3(-7, 0, -3.5) * kMm, Vec3(3, 6, 1.6) * kMm);
  people::RandomStream random(1, 3);
  const Vec3 hand = Vec3(1.6, 0, -2.3) * kMm;
  ASSERT_TRUE(on.hits(hand, Vec3::UnitZ()));
  std::optional<NextStroke> next;
  HeldBurr held;  // after a change of burrs the way is made anew
  for (int n = 0; n < 20 && !(next && next->burr == held); ++n) {
    if (next) held = next->burr;
    next = on.work.next(*on.bone, hand, held, random);
  }
  ASSERT_TRUE(next && next->burr == held);
  ASSERT_EQ(next->stroke.points, 3);
  EXPECT_FALSE(on.hits(hand, (next->stroke.way[0] - hand).normalized()));
}

// A direction to the surgeon at a right angle to the first one does not rise: the way out ends all the same.
TEST(StepWork, AWayOutAcrossTheFirstDirectionHasAnEnd) {
  UnderAStone on(Vec3(-7, 0, -3.5) * kMm, Vec3(3, 6, 1.6) * kMm, Vec3::UnitX());
  people::RandomStream random(1, 3);
  const Vec3 hand = Vec3(1.6, 0, -2.3) * kMm;
  HeldBurr held;  // after a change of burrs the way is made anew
  int ways = 0;
  for (int n = 0; n < 40; ++n) {
    const auto next = on.work.next(*on.bone, hand, held, random);
    if (!next) continue;
    held = next->burr;
    for (int w = 0; w < next->stroke.points; ++w, ++ways)
      EXPECT_LT((next->stroke.way[static_cast<std::size_t>(w)] - hand).norm(), 100 * kMm);
  }
  EXPECT_GT(ways, 3);
}

TEST(StepWork, AGrooveIsCutAlong) {
  Skill skill;
  skill.along = 1;
  GrooveWork on(7 * kMm, 2 * kMm, skill, 2 * kMm);
  people::RandomStream random(1, 3);
  int strokes = 0;
  for (int n = 0; n < 30; ++n) {
    const auto next = on.work.next(*on.bone, Vec3(0, 0, 20 * kMm), {1 * kMm}, random);
    if (!next) continue;
    ++strokes;
    EXPECT_GT(std::abs(next->stroke.along.x()), 0.8);
  }
  EXPECT_GT(strokes, 5);
}

TEST(Goal, IsTheDepthInTheRegionAndTheRoomToWhatIsSpared) {
  const auto bone = block_with_vein(0.25);
  const scenario::CaseLesson lesson = block_lesson();
  const Believed seen = believed(*bone, lesson, 0, 1);
  const Spare spare = spare_of(bone->grid(), lesson, seen, 0);
  const FieldGrid goal = goal_of(lesson.regions.front(), approach_of(lesson), seen, spare);
  // the floor of the trough is at z = -4, the vein's margin ends at -2.5
  EXPECT_NEAR(goal.at(Vec3(0, 0, -2 * kMm)), 0.5 * kMm, 0.15 * kMm);
  EXPECT_NEAR(goal.at(Vec3(0, 0, -3 * kMm)), -0.5 * kMm, 0.15 * kMm);
  // beside the vein the floor counts
  EXPECT_NEAR(goal.at(Vec3(-2 * kMm, 4.2 * kMm, -3.5 * kMm)), 0.5 * kMm, 0.15 * kMm);
  // out of the trough, and in the stone
  EXPECT_LT(goal.at(Vec3(0, -5 * kMm, -2 * kMm)), -1 * kMm);
  EXPECT_LT(goal.at(Vec3(3 * kMm, 5 * kMm, -1.5 * kMm)), -0.5 * kMm);
  // above the bone the way is free
  EXPECT_GT(goal.at(Vec3(0, 0, 1 * kMm)), 2 * kMm);
}

TEST(Goal, LessMarginReachesNearerByAsMuch) {
  const auto bone = block_with_vein(0.25);
  const scenario::CaseLesson lesson = block_lesson();
  const Believed seen = believed(*bone, lesson, 0, 1);
  const Spare plan = spare_of(bone->grid(), lesson, seen, 0);
  const Spare less = spare_of(bone->grid(), lesson, seen, 0.5 * kMm);
  const Vec3 p(0, 0, -2 * kMm);
  EXPECT_NEAR(less.free.at(p) - plan.free.at(p), 0.5 * kMm, 1e-6);
  EXPECT_EQ(less.near.at(p), plan.near.at(p));
}

TEST(Goal, WhatLiesBehindASparedStructureIsNoGoal) {
  const auto bone = block_with_vein(0.25);
  scenario::CaseLesson lesson = block_lesson();
  lesson.regions.front().add.front().size = Vec3(10, 8, 16) * kMm;  // down below the vein
  const Believed seen = believed(*bone, lesson, 0, 1);
  const Spare spare = spare_of(bone->grid(), lesson, seen, 0);
  const FieldGrid goal = goal_of(lesson.regions.front(), approach_of(lesson), seen, spare);
  EXPECT_LT(goal.at(Vec3(0, 0, -8.5 * kMm)), 0);                // in the shadow of the vein
  EXPECT_GT(goal.at(Vec3(-3 * kMm, 4 * kMm, -8 * kMm)), 0);     // beside it
  EXPECT_GT(spare.free.at(Vec3(0, 0, -8.5 * kMm)), 0.5 * kMm);  // though it is far enough away
}

TEST(Goal, ChangesByAtMostOneMetrePerMetre) {
  const auto bone = block_with_vein(0.5);
  const scenario::CaseLesson lesson = block_lesson();
  const Believed seen = believed(*bone, lesson, 0.5 * kMm, 4);
  const Spare spare = spare_of(bone->grid(), lesson, seen, 0);
  const FieldGrid goal = goal_of(lesson.regions.front(), approach_of(lesson), seen, spare);
  const auto x = static_cast<std::size_t>(goal.size().x());
  for (std::size_t n = 1; n < goal.nodes(); ++n) {
    if (n % x == 0) continue;
    ASSERT_LE(std::abs(goal.value[n] - goal.value[n - 1]), 1.02 * goal.spacing()) << n;
  }
}

}  // namespace
}  // namespace burr::surgeon
