// Removed, missed, excess; and the part of a cavity that lies under bone: bones of known volume.
#include "burr/metrics/removed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "burr/metrics/new_surface.h"
#include "burr/metrics/overhang.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

constexpr double kMm3 = 1e-9;

double ball_volume(double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; }

TEST(Removed, SharesOfABall) {
  test::Plan plan;
  plan.bone = test::below(7 * kMm);
  for (const double h : test::kVoxels)
    for (const double r : {2.0, 3.0, 4.0}) {
      // planned: a ball of 3 mm, shifted a little from the voxels; cut: one of r
      const Vec3 middle = {0.07 * kMm, 0.03 * kMm, -0.11 * kMm};
      const auto bones = test::cut(plan, phantom::ball(r * kMm, middle), h);
      const auto gone = removed_of(*bones.before, *bones.after, in_ball(middle, 3 * kMm), {});
      ASSERT_TRUE(gone) << gone.reason();
      const double bone = ball_volume(3 * kMm), cut = ball_volume(r * kMm);
      EXPECT_NEAR(gone->bone, bone, 0.01 * bone);
      EXPECT_NEAR(gone->all, cut, 0.01 * cut);
      const double share = std::min(1.0, cut / bone);
      std::printf("Removed h %.3f r %.0f: %.3f of %.3f, error %.3f\n", h / kMm, r, gone->share,
                  share, gone->error);
      EXPECT_NEAR(gone->share, share, 0.01 + (r == 3.0 ? gone->error : 0)) << h;
      EXPECT_NEAR(gone->removed + gone->missed, gone->bone, 1e-6 * bone);
      EXPECT_NEAR(gone->excess, std::max(0.0, cut - bone),
                  0.01 * cut + (r == 3.0 ? gone->error * bone : 0));
      const double dice = 2 * share * bone / (bone + cut);
      EXPECT_NEAR(gone->dice, dice, 0.02 + (r == 3.0 ? gone->error : 0));
    }
}

TEST(Removed, ALittleOutsideIsNoExcess) {
  test::Plan plan;
  plan.bone = test::below(7 * kMm);
  const auto bones = test::cut(plan, phantom::ball(4 * kMm), 0.25 * kMm);
  const auto gone =
      removed_of(*bones.before, *bones.after, in_ball({0, 0, 0}, 3 * kMm), {.grown = 0.5 * kMm});
  ASSERT_TRUE(gone);
  EXPECT_NEAR(gone->excess, ball_volume(4 * kMm) - ball_volume(3.5 * kMm), 2 * kMm3);
}

// Bricks far from the region's border are summed whole; a region that never ends one by itself says
// what every voxel says.
TEST(Removed, BricksFarFromTheBorderCountAsTheirVoxelsDo) {
  test::Plan plan;
  plan.bone = phantom::without(test::below(7 * kMm), phantom::gyroid(4 * kMm, 0.35));
  plan.lipschitz = phantom::kGyroidSteepness;
  const auto bones = test::cut(plan, phantom::ball(5 * kMm), 0.25 * kMm);
  for (const double radius : {1.0, 4.0, 5.0, 6.0}) {
    const Region ball = in_ball({0.3 * kMm, 0, 0}, radius * kMm);
    // the same, but for a depth of which no brick is far from the border
    const Region shallow = [ball](const Vec3& p) { return std::clamp(ball(p), -1 * kMm, 1 * kMm); };
    for (const double grown : {0.0, 0.5 * kMm}) {
      const auto fast = removed_of(*bones.before, *bones.after, ball, {.grown = grown});
      const auto slow = removed_of(*bones.before, *bones.after, shallow, {.grown = grown});
      ASSERT_TRUE(fast && slow);
      EXPECT_EQ(fast->bone, slow->bone);
      EXPECT_EQ(fast->removed, slow->removed);
      EXPECT_EQ(fast->excess, slow->excess);
      EXPECT_EQ(fast->all, slow->all);
      EXPECT_EQ(fast->error, slow->error);
    }
  }
}

// K11: a defect that was filled; what was added counts as negative
TEST(Removed, WhatWasAddedIsNegative) {
  test::Plan plan;
  plan.bone = phantom::without(test::below(7 * kMm), phantom::ball(3 * kMm));
  const auto defect = test::build(plan, plan.bone, 0.25 * kMm);
  for (const double rest : {1.0, 2.0}) {
    const auto filled = test::build(
        plan, phantom::without(test::below(7 * kMm), phantom::ball(rest * kMm)), 0.25 * kMm);
    const auto gone = removed_of(*defect, *filled, {}, {});
    ASSERT_TRUE(gone);
    EXPECT_NEAR(gone->all, ball_volume(rest * kMm) - ball_volume(3 * kMm), 1 * kMm3);
  }
}

TEST(Removed, NoBoneInTheRegionIsNoAnswer) {
  test::Plan plan;
  plan.bone = test::below(-3 * kMm);
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  EXPECT_FALSE(removed_of(*bone, *bone, in_ball({0, 0, 4 * kMm}, 2 * kMm), {}));
  const auto none = removed_of(*bone, *bone, {}, {});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->share, 0);
}

TEST(NewSurface, HasTheAreaOfTheCutAlone) {
  test::Plan plan;
  plan.bone = test::below(3 * kMm);
  for (const double h : test::kVoxels) {
    // a ball that opens to the top: its cap above 3 mm is missing
    const auto bones = test::cut(plan, phantom::ball(4 * kMm, {0.1 * kMm, 0, 0}), h);
    double area = 0;
    for (const SurfacePoint& one : new_surface(*bones.before, *bones.after, {})) {
      area += one.area;
      EXPECT_NEAR((one.place - Vec3(0.1 * kMm, 0, 0)).norm(), 4 * kMm, 0.4 * h + 0.02 * kMm);
      EXPECT_LT(one.place.z(), 3 * kMm);
    }
    const double truth = 2 * std::numbers::pi * 4 * (4 + 3) * 1e-6;
    std::printf("NewSurface h %.3f: %.1f of %.1f mm^2\n", h / kMm, area * 1e6, truth * 1e6);
    // half a voxel below the old surface is left out
    EXPECT_NEAR(area, truth, 0.02 * truth + 2 * std::numbers::pi * 4 * kMm * 0.6 * h);
  }
}

// K10: a cylinder of 4 mm under a lip with a round opening
TEST(Overhang, IsTheShareUnderTheLip) {
  test::Plan plan;
  plan.bone = test::below(4 * kMm);
  for (const double h : test::kVoxels)
    for (const double opening : {2.5, 3.5}) {
      const phantom::Depth room =
          phantom::placed(phantom::cylinder(4 * kMm, 1.5 * kMm), {.p = {0, 0, 0.5 * kMm}});
      const phantom::Depth mouth =
          phantom::placed(phantom::cylinder(opening * kMm, 3 * kMm), {.p = {0, 0, 3 * kMm}});
      const auto bones = test::cut(plan, phantom::either(room, mouth), h);
      const auto under = overhang(*bones.before, *bones.after, {}, {.towards = {kUp}});
      ASSERT_TRUE(under) << under.reason();
      const double ring = std::numbers::pi * (16 - opening * opening),
                   wall = 2 * std::numbers::pi * 4 * 3;
      const double open = std::numbers::pi * opening * opening + 2 * std::numbers::pi * opening * 2;
      const double share = (2 * ring + wall) / (2 * ring + wall + open);
      std::printf("K10 h %.3f opening %.1f: %.3f of %.3f\n", h / kMm, opening, under->mark.value,
                  share);
      EXPECT_NEAR(under->mark.value, share, 0.01 + under->mark.error);
      EXPECT_FALSE(under->mark.met);
      for (const Vec3& p : under->under) EXPECT_LT(p.z(), 2.1 * kMm);
    }
}

TEST(Overhang, ASaucerHasNone) {
  test::Plan plan;
  plan.bone = test::below(4 * kMm);
  for (const double h : test::kVoxels) {
    const auto bones = test::cut(plan, phantom::ball(6 * kMm, {0, 0, 5 * kMm}), h);
    const auto under = overhang(*bones.before, *bones.after, {}, {.towards = {kUp}});
    ASSERT_TRUE(under) << under.reason();
    EXPECT_LT(under->mark.value, 0.005);
    EXPECT_TRUE(under->mark.met);
    // an upright wall is no overhang
    const auto upright = test::cut(
        plan, phantom::placed(phantom::cylinder(4 * kMm, 4 * kMm), {.p = {0, 0, 4 * kMm}}), h);
    const auto well = overhang(*upright.before, *upright.after, {}, {.towards = {kUp}});
    ASSERT_TRUE(well);
    EXPECT_LT(well->mark.value, 0.01);
    // of several directions the best counts
    const auto two = overhang(*upright.before, *upright.after, {}, {.towards = {{1, 0, 0.2}, kUp}});
    ASSERT_TRUE(two);
    EXPECT_EQ(two->mark.value, well->mark.value);
  }
}

TEST(Overhang, AnUntouchedBoneIsNoAnswer) {
  test::Plan plan;
  plan.bone = test::below(0);
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  EXPECT_FALSE(overhang(*bone, *bone, {}, {.towards = {kUp}}));
}

}  // namespace
}  // namespace burr::metrics
