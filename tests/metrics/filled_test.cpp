// A gap of known volume, filled by a formula: what is in it, and what lies beside it.
#include "burr/metrics/filled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using phantom::Depth;
using test::kMm;

double ball_volume(double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; }

// Solid bone below 7 mm with a round gap of 3 mm, in which lies a ball of r.
test::Cut filled_with(double r, const Vec3& middle, double h) {
  test::Plan plan;
  plan.lo = Vec3::Constant(-4 * kMm);
  plan.hi = Vec3::Constant(4 * kMm);
  plan.bone = phantom::without(test::below(7 * kMm), phantom::ball(3 * kMm, middle));
  const Depth filling = phantom::ball(r * kMm, middle);
  // where the filling touches the bone there is no seam
  const Depth after = [bone = plan.bone, whole = test::below(7 * kMm), filling,
                       full = r >= 3](const Vec3& p) {
    return full ? whole(p) : std::max(bone(p), filling(p));
  };
  return {test::build(plan, plan.bone, h), test::build(plan, after, h)};
}

TEST(Filled, SharesOfARoundGap) {
  const Vec3 middle = {0.07 * kMm, 0.03 * kMm, -0.11 * kMm};
  const Region gap = in_ball(middle, 3 * kMm);
  const double space = ball_volume(3 * kMm);
  for (const double h : test::kVoxels)
    for (const double r : {1.5, 2.5, 3.0}) {
      const auto bones = filled_with(r, middle, h);
      const auto full = filled_of(*bones.before, *bones.after, gap, {});
      ASSERT_TRUE(full) << full.reason();
      const double share = ball_volume(r * kMm) / space;
      std::printf("Filled h %.3f r %.1f: %.3f of %.3f, error %.3f\n", h / kMm, r, full->share,
                  share, full->error);
      EXPECT_NEAR(full->space, space, (0.01 + full->error) * space);
      EXPECT_NEAR(full->share, share, 0.01 + full->error);
      EXPECT_NEAR(full->stray, 0, full->error);
      EXPECT_NEAR(full->all, ball_volume(r * kMm), 0.015 * space);
    }
}

// On flat bone a ball of 2 mm is added of which the planned gap holds the lower half.
TEST(Filled, WhatLiesBesideTheGapIsStrayButForALittle) {
  test::Plan plan;
  plan.bone = test::below(-4 * kMm);
  const Depth filling = phantom::ball(2 * kMm);
  const Depth after = [bone = plan.bone, filling](const Vec3& p) {
    return std::max(bone(p), filling(p));
  };
  const test::Cut bones = {test::build(plan, plan.bone, 0.25 * kMm),
                           test::build(plan, after, 0.25 * kMm)};
  const Region low = in_half_space({0, 0, 0}, test::kUp);
  const auto half = filled_of(*bones.before, *bones.after, low, {});
  ASSERT_TRUE(half);
  EXPECT_NEAR(half->stray, 0.5, 0.01);
  // of a ball cut by a plane at 1 mm of 2, 5/32 of the volume lie above
  const auto most = filled_of(*bones.before, *bones.after, low, {.grown = 1 * kMm});
  ASSERT_TRUE(most);
  EXPECT_NEAR(most->stray, 5.0 / 32, 0.01);
  EXPECT_NEAR(most->filled, half->filled, 1e-15);
}

// What was cut away elsewhere neither counts as space nor against the filling.
TEST(Filled, CuttingElsewhereChangesNothing) {
  test::Plan plan;
  plan.bone = test::below(4 * kMm);
  const auto bones = test::cut(plan, phantom::ball(2 * kMm), 0.25 * kMm);
  const auto none = filled_of(*bones.before, *bones.after, in_ball({0, 0, 6 * kMm}, 1.5 * kMm), {});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->filled, 0);
  EXPECT_EQ(none->all, 0);
  EXPECT_EQ(none->stray, 0);
}

TEST(Filled, WithoutAGapThereIsNoAnswer) {
  test::Plan plan;
  plan.bone = test::below(7 * kMm);
  const auto bones = test::cut(plan, phantom::ball(1 * kMm), 0.4 * kMm);
  EXPECT_FALSE(filled_of(*bones.before, *bones.after, in_ball({0, 0, -3 * kMm}, 1 * kMm), {}));
}

}  // namespace
}  // namespace burr::metrics
