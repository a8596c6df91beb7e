// A corridor with other holes beside it, in dense and in spongy bone: what is the corridor, and how wide it is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>

#include "burr/metrics/axis_fit.h"
#include "burr/metrics/main_cut.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;

test::Plan block() {
  test::Plan plan;
  plan.lo = {-8 * kMm, -8 * kMm, -14 * kMm};
  plan.hi = {8 * kMm, 8 * kMm, 2 * kMm};
  plan.bone = test::below(0);
  return plan;
}

phantom::Depth hole(double x, double y, double radius, double deep) {
  return [=](const Vec3& p) {
    return std::min(radius - std::hypot(p.x() - x, p.y() - y), p.z() + deep);
  };
}

const PlannedAxis kPlan = {{0, 0, 0}, {0, 0, -1}};

// Holes of 2 mm, 5 mm beside a bed of 4 mm, and one so deep as the bed.
TEST(Corridor, HolesBesideItMoveNothing) {
  for (const double h : test::kVoxels) {
    const auto alone = test::cut(block(), hole(0, 0, 2 * kMm, 10 * kMm), h);
    phantom::Depth all = hole(0, 0, 2 * kMm, 10 * kMm);
    for (const Vec3& at : {Vec3(0, 5, 8), Vec3(0, -5, 8), Vec3(5, 0, 10)})
      all = phantom::either(all, hole(at.x() * kMm, at.y() * kMm, 1 * kMm, at.z() * kMm));
    const auto bones = test::cut(block(), all, h);
    const auto was = axis_fit(*alone.before, *alone.after, kPlan, {}),
               is = axis_fit(*bones.before, *bones.after, kPlan, {});
    ASSERT_TRUE(was && is) << is.reason();
    EXPECT_EQ(is->entry_off, was->entry_off);
    EXPECT_EQ(is->angle, was->angle);
    EXPECT_EQ(is->depth, was->depth);
    EXPECT_NEAR(is->width, 4 * kMm, 0.05 * kMm) << h;
    EXPECT_NEAR(is->reach, 10 * kMm, 0.5 * h);
    const MainCut cut = main_cut(*bones.before, *bones.after, {});
    EXPECT_EQ(cut.others, 3U);
    // pi (1 + 1) * 8 + pi * 10 of that and 4 pi * 10
    EXPECT_NEAR(cut.others_share, 26.0 / 66, 0.03) << h;
  }
}

// Spongy bone is not in pieces; holes 1.6 mm apart are.
TEST(Corridor, PoresDoNotPartIt) {
  const double h = 0.25 * kMm;
  test::Plan plan = block();
  plan.bone = [](const Vec3& p) {
    const double wall = std::max(0.2 * kMm - std::abs(std::remainder(p.x(), 0.6 * kMm)),
                                 0.2 * kMm - std::abs(std::remainder(p.z(), 2 * kMm)));
    return std::min(-p.z(), wall);
  };
  const auto spongy = test::cut(plan, hole(0, 0, 2 * kMm, 10 * kMm), h);
  EXPECT_EQ(main_cut(*spongy.before, *spongy.after, {}).others, 0U);
  for (const double gap : {0.6, 1.6}) {
    const auto two = test::cut(block(),
                               phantom::either(hole(-2 * kMm, 0, 2 * kMm, 8 * kMm),
                                               hole((1 + gap) * kMm, 0, 1 * kMm, 8 * kMm)),
                               h);
    EXPECT_EQ(main_cut(*two.before, *two.after, {}).others, gap > 1 ? 1U : 0U) << gap;
  }
  EXPECT_TRUE(main_cut(*spongy.before, *spongy.before, {}).gone.empty());
}

// The surface lies 1 mm behind the plan's first point: the corridor is 1 mm shorter, and ends where it was planned.
TEST(Corridor, ReachIsFromThePlanAndDepthFromTheBone) {
  for (const double h : test::kVoxels) {
    const auto bones = test::cut(block(), hole(0, 0, 1.5 * kMm, 10 * kMm), h);
    const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 1 * kMm}, {0, 0, -1}}, {});
    ASSERT_TRUE(fit) << fit.reason();
    EXPECT_NEAR(fit->depth, 10 * kMm, 0.5 * h);
    EXPECT_NEAR(fit->reach, 11 * kMm, 0.5 * h);
  }
}

}  // namespace
}  // namespace burr::metrics
