// Identified and skeletonised: shares of a patch that are known.
#include "burr/metrics/identified.h"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

#include "burr/metrics/shares.h"
#include "burr/metrics/skeletonised.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

// A flat sheet of dura under bone, at z = 0, 10 x 10 mm; the cut leaves 0.5 mm of bone over the part
// x < edge, and 2.5 mm over the rest.
test::Cut over_a_sheet(double edge, double h) {
  test::Plan plan;
  plan.lo = {-5 * kMm, -5 * kMm, -2 * kMm};
  plan.hi = {5 * kMm, 5 * kMm, 6 * kMm};
  const phantom::Depth dura = test::below(0);
  plan.bone = phantom::common(test::below(5 * kMm), test::above(0));
  plan.labels = {{dura, test::kNerve}};
  const phantom::Depth deep =
      phantom::common(test::above(0.5 * kMm), phantom::slab({1, 0, 0}, {edge, 0, 0}));
  return test::cut(plan, phantom::either(test::above(2.5 * kMm), deep), h);
}

Cover seen(const test::Cut& bones, const Region& region = {}) {
  const auto cover =
      cover_of(*bones.before, *bones.after, test::voxels_of(*bones.before, test::kNerve), region,
               {.towards = {kUp}, .most_samples = 0});
  EXPECT_TRUE(cover) << cover.reason();
  return *cover;
}

TEST(Identified, CountsTheShareUnderThinBone) {
  for (const double h : test::kVoxels)
    for (const double edge : {-2.0, 1.0}) {
      const auto found = identified(seen(over_a_sheet(edge * kMm, h)), {.x = 1 * kMm, .y = 0.5});
      ASSERT_TRUE(found) << found.reason();
      // a strip of 0.77 mm at the foot of the step is seen aslant through less than 1 mm
      const double share = (edge + 5) / 10;
      EXPECT_LT(found->mark.value, share + 0.1 + h / (10 * kMm)) << h;
      EXPECT_GT(found->mark.value, share - 0.02 - h / (10 * kMm)) << h;
      EXPECT_EQ(found->mark.met, edge > 0);
      EXPECT_NEAR(found->least_cover, 0.5 * kMm, 0.08 * kMm);
      EXPECT_GT(found->worst_at.x(), edge * kMm);
      EXPECT_GT(found->worst_cover, 2.3 * kMm);
    }
}

TEST(Identified, AlongATubeCountsSlices) {
  // a nerve along x of 10 mm; thin bone over x < edge
  for (const double h : test::kVoxels)
    for (const double edge : {-1.0, 3.0}) {
      test::Plan plan;
      plan.lo = {-5 * kMm, -4 * kMm, -3 * kMm};
      plan.hi = {5 * kMm, 4 * kMm, 6 * kMm};
      const phantom::Depth nerve =
          phantom::capsule({-20 * kMm, 0, 0}, {20 * kMm, 0, 0}, 0.85 * kMm);
      plan.bone = phantom::without(test::below(5 * kMm), nerve);
      plan.labels = {{nerve, test::kNerve}};
      const phantom::Depth deep =
          phantom::common(test::above(1.35 * kMm), phantom::slab({1, 0, 0}, {edge * kMm, 0, 0}));
      const auto bones = test::cut(plan, phantom::either(test::above(3.35 * kMm), deep), h);
      const Course course = {{{-5 * kMm, 0, 0}, {5 * kMm, 0, 0}}};
      const auto found = identified(seen(bones), {.x = 1 * kMm, .course = course});
      ASSERT_TRUE(found) << found.reason();
      EXPECT_EQ(found->mark.threshold, 0.6);
      EXPECT_NEAR(found->mark.value, (edge + 5) / 10, 0.11) << h;
      EXPECT_EQ(found->mark.met, edge > 0);
      ASSERT_EQ(found->slices.size(), 10U);
      EXPECT_NEAR(found->slices[2].cover, 0.5 * kMm, std::max(0.05 * kMm, 0.2 * h));
      EXPECT_GT(found->slices[9].cover, 1.0 * kMm);  // aslant, from the step at 3 mm
    }
}

TEST(Identified, CoarseVoxelsAreNoAnswer) {
  const Cover cover = seen(over_a_sheet(1 * kMm, 0.4 * kMm));
  const auto found = identified(cover, {.x = 0.5 * kMm});
  ASSERT_FALSE(found);
  EXPECT_NE(found.reason().find("0.25 mm or finer"), std::string::npos) << found.reason();
  EXPECT_FALSE(skeletonised(cover, 1, {.lo = 0.05 * kMm}));
}

TEST(Identified, SaysWhenItIsNearTheThreshold) {
  const auto cover = seen(over_a_sheet(0, 0.25 * kMm));
  const auto found = identified(cover, {});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->mark.borderline());
  const auto near =
      identified(cover, {.x = 1 * kMm, .y = found->mark.value + 0.5 * found->mark.error});
  ASSERT_TRUE(near);
  EXPECT_TRUE(near->mark.borderline());
}

TEST(Skeletonised, NeedsMostOfItThinAndHardlyAnyBare) {
  for (const double h : test::kVoxels) {
    const auto even = skeletonised(seen(over_a_sheet(4 * kMm, h)), 1, {});
    ASSERT_TRUE(even) << even.reason();
    EXPECT_GT(even->even.value, 0.88);
    EXPECT_TRUE(even->even.met);
    EXPECT_LT(even->bare.value, 0.02);
    EXPECT_NEAR(even->median, 0.5 * kMm, std::max(0.05 * kMm, 0.2 * h));

    const auto little = skeletonised(seen(over_a_sheet(-3 * kMm, h)), 1, {});
    ASSERT_TRUE(little);
    EXPECT_FALSE(little->even.met);
  }
}

// Nothing is bare because nothing was done.
TEST(Skeletonised, WhoDidNothingLaidNothingBare) {
  const Cover cover = seen(over_a_sheet(4 * kMm, 0.4 * kMm));
  const auto idle = skeletonised(cover, 0.1, {}), worked = skeletonised(cover, 0.3, {});
  ASSERT_TRUE(idle && worked);
  EXPECT_FALSE(idle->bare.met);
  EXPECT_FALSE(idle->bare.earned);
  EXPECT_TRUE(worked->bare.met && worked->bare.earned);
  static_assert(!std::is_default_constructible_v<Worked>);
}

TEST(Shares, TheErrorIsTwoStandardErrors) {
  EXPECT_DOUBLE_EQ(share_error(0.5, 0.5, 0.5, 100), 0.1);
  EXPECT_DOUBLE_EQ(share_error(0.5, 0.3, 0.6, 100), 0.2);
  EXPECT_DOUBLE_EQ(share_error(0.5, 0.4, 0.8, 100), 0.3);
}

// All of it thin but 30 % laid bare: not skeletonised.
TEST(Skeletonised, BareIsNotThin) {
  for (const double h : test::kVoxels) {
    test::Plan plan;
    plan.lo = {-5 * kMm, -5 * kMm, -2 * kMm};
    plan.hi = {5 * kMm, 5 * kMm, 6 * kMm};
    plan.bone = phantom::common(test::below(5 * kMm), test::above(0));
    plan.labels = {{test::below(0), test::kNerve}};
    const phantom::Depth bare =
        phantom::common(test::above(-1 * kMm), phantom::slab({1, 0, 0}, {-2 * kMm, 0, 0}));
    const auto bones = test::cut(plan, phantom::either(test::above(0.6 * kMm), bare), h);
    const auto thin = skeletonised(seen(bones), 1, {});
    ASSERT_TRUE(thin);
    EXPECT_NEAR(thin->bare.value, 0.3, 0.03);
    EXPECT_FALSE(thin->bare.met);
    EXPECT_GT(thin->even.value, 0.6);
    EXPECT_FALSE(thin->even.met);
    EXPECT_LT(thin->thinnest_at.x(), -2 * kMm + h);
  }
}

}  // namespace
}  // namespace burr::metrics
