// What must stay whole: a solid structure by its volume, a plate of bone by the area of its holes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "burr/metrics/cover.h"
#include "burr/metrics/intact_plate.h"
#include "burr/metrics/intact_solid.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

constexpr double kMm3 = 1e-9, kMm2 = 1e-6;

// A hard ball of 3 mm in a block; the cut is everything above z.
test::Cut ball_cut_at(double z, double h) {
  test::Plan plan;
  plan.bone = test::below(6 * kMm);
  plan.labels = {{phantom::ball(3 * kMm, {0, 0, 0}), test::kHard}};
  return test::cut(plan, test::above(z), h);
}

TEST(IntactSolid, MeasuresTheLostVolume) {
  for (const double h : test::kVoxels)
    for (const double cap : {0.5, 1.0, 2.0}) {
      const auto bones = ball_cut_at((3 - cap) * kMm, h);
      const auto lost = intact_solid(*bones.before, *bones.after,
                                     test::voxels_of(*bones.before, test::kHard), 1, {});
      ASSERT_TRUE(lost) << lost.reason();
      const double truth = std::numbers::pi * cap * cap * (3 - cap / 3) * kMm3;
      // the ball's labels are whole voxels; the cut is the field's
      const double area = std::numbers::pi * cap * (6 - cap) * kMm2;
      std::printf("IntactSolid h %.3f cap %.1f: %.3f of %.3f mm^3\n", h / kMm, cap,
                  lost->mark.value / kMm3, truth / kMm3);
      EXPECT_NEAR(lost->mark.value, truth, 0.25 * h * area + 0.02 * truth);
      EXPECT_FALSE(lost->mark.met);
      EXPECT_GT(lost->at.z(), (3 - cap) * kMm - 1.1 * h);
      EXPECT_NEAR(lost->whole / kMm3, 4.0 / 3 * std::numbers::pi * 27, 0.02 * 113);
    }
}

// The cut follows the ball at a distance of half a voxel, and takes nothing of it.
TEST(IntactSolid, ACutBesideItTakesNothing) {
  for (const double h : test::kVoxels) {
    test::Plan plan;
    plan.bone = test::below(6 * kMm);
    // flat faces: a box in whole voxels, so that the distance is known
    const Vec3 half = Vec3::Constant(8 * h);
    plan.labels = {{phantom::box(half), test::kHard}};
    plan.lo = Vec3::Constant(-24 * h);
    plan.hi = Vec3::Constant(24 * h);
    plan.bone = test::below(20 * h);
    const auto beside = test::cut(plan, test::above(8.5 * h), h);
    const auto whole = intact_solid(*beside.before, *beside.after,
                                    test::voxels_of(*beside.before, test::kHard), 1, {});
    ASSERT_TRUE(whole) << whole.reason();
    EXPECT_EQ(whole->mark.value, 0);
    EXPECT_TRUE(whole->mark.met);
    const auto into = test::cut(plan, test::above(7 * h), h);
    const auto cut =
        intact_solid(*into.before, *into.after, test::voxels_of(*into.before, test::kHard), 1, {});
    ASSERT_TRUE(cut);
    EXPECT_NEAR(cut->mark.value, 16 * 16 * h * h * h, 0.02 * 256 * h * h * h);
  }
}

TEST(IntactSolid, AnUntouchedBoneEarnsNothing) {
  const auto bones = ball_cut_at(20 * kMm, 0.4 * kMm);
  const VoxelSet ball = test::voxels_of(*bones.before, test::kHard);
  const auto idle = intact_solid(*bones.before, *bones.after, ball, 0, {});
  ASSERT_TRUE(idle);
  EXPECT_EQ(idle->mark.value, 0);
  EXPECT_FALSE(idle->mark.met);
  EXPECT_FALSE(idle->mark.earned);
  const auto worked = intact_solid(*bones.before, *bones.after, ball, 0.3, {});
  ASSERT_TRUE(worked);
  EXPECT_TRUE(worked->mark.met && worked->mark.earned);
}

TEST(IntactSolid, SoftOrMissingIsNoAnswer) {
  test::Plan plan;
  plan.bone = test::above(-6 * kMm);
  const phantom::Depth nerve = phantom::ball(2 * kMm, {0, 0, 0});
  plan.bone = phantom::without(test::below(6 * kMm), nerve);
  plan.labels = {{nerve, test::kNerve}};
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  const auto soft = intact_solid(*bone, *bone, test::voxels_of(*bone, test::kNerve), 1, {});
  ASSERT_FALSE(soft);
  EXPECT_NE(soft.reason().find("soft"), std::string::npos);
  EXPECT_FALSE(intact_solid(*bone, *bone, test::voxels_of(*bone, test::kHard), 1, {}));
}

// K3: dura below z = 0 under bone; a plate of 1 mm is left, with round holes in it.
struct Holes {
  double radius;
  Vec3 at;
};

test::Cut plate_with_holes(const std::vector<Holes>& holes, double h, double plate = 1.0 * kMm) {
  test::Plan plan;
  plan.lo = {-4.5 * kMm, -3 * kMm, -2 * kMm};
  plan.hi = {4.5 * kMm, 3 * kMm, 6 * kMm};
  plan.bone = phantom::common(test::below(5 * kMm), test::above(0));
  plan.labels = {{test::below(0), test::kNerve}};
  phantom::Depth cavity = test::above(plate);
  for (const Holes& hole : holes)
    cavity = phantom::either(
        cavity, phantom::placed(phantom::cylinder(hole.radius, 20 * kMm), {.p = hole.at}));
  return test::cut(plan, cavity, h);
}

Assessed<Cover> cover_of_dura(const test::Cut& bones) {
  return cover_of(*bones.before, *bones.after, test::voxels_of(*bones.before, test::kNerve), {},
                  {.towards = {kUp}, .most_samples = 0});
}

TEST(IntactPlate, MeasuresTheAreaOfItsHoles) {
  for (const double h : test::kVoxels) {
    const auto cover = cover_of_dura(plate_with_holes(
        {{1.5 * kMm, {-2 * kMm, 0.1 * kMm, 0}}, {0.8 * kMm, {2.5 * kMm, 1 * kMm, 0}}}, h));
    ASSERT_TRUE(cover) << cover.reason();
    const auto plate = intact_plate(*cover, 1, {});
    ASSERT_TRUE(plate) << plate.reason();
    const double large = std::numbers::pi * 2.25 * kMm2, small = std::numbers::pi * 0.64 * kMm2;
    std::printf("K3 h %.3f: %.2f of %.2f mm^2, pieces %.2f %.2f; error %.2f\n", h / kMm,
                plate->mark.value / kMm2, (large + small) / kMm2, plate->holes[0].area / kMm2,
                plate->holes.size() > 1 ? plate->holes[1].area / kMm2 : 0,
                plate->mark.error / kMm2);
    EXPECT_FALSE(plate->mark.met);
    EXPECT_GT(plate->mark.value, large + small - 0.5 * plate->mark.error);
    EXPECT_LT(plate->mark.value, large + small + plate->mark.error);
    EXPECT_LT(plate->mark.error, 8 * kMm2);
    ASSERT_EQ(plate->holes.size(), 2U);
    EXPECT_NEAR(plate->holes[0].area, large, 0.25 * large + 4 * h * kMm);
    EXPECT_LT((plate->holes[0].at - Vec3(-2 * kMm, 0.1 * kMm, plate->holes[0].at.z())).norm(), h);
  }
}

TEST(IntactPlate, IsMetWithoutHolesByOneWhoWorked) {
  for (const double h : test::kVoxels) {
    const auto cover = cover_of_dura(plate_with_holes({}, h));
    ASSERT_TRUE(cover) << cover.reason();
    const auto plate = intact_plate(*cover, 1, {});
    ASSERT_TRUE(plate) << plate.reason();
    EXPECT_EQ(plate->mark.value, 0);
    EXPECT_TRUE(plate->mark.met);
    const auto idle = intact_plate(*cover, 0.1, {});
    ASSERT_TRUE(idle);
    EXPECT_FALSE(idle->mark.met);
  }
}

TEST(IntactPlate, AThinPlateIsNoAnswer) {
  test::Plan plan;
  plan.lo = {-6 * kMm, -6 * kMm, -2 * kMm};
  plan.hi = {6 * kMm, 6 * kMm, 6 * kMm};
  // cells begin 0.4 mm above the dura
  const phantom::Depth cells = phantom::common(test::above(0.4 * kMm), test::below(1.5 * kMm));
  plan.bone = phantom::without(phantom::common(test::below(5 * kMm), test::above(0)), cells);
  plan.labels = {{test::below(0), test::kNerve}};
  const auto cover = cover_of_dura(test::cut(plan, test::above(2 * kMm), 0.25 * kMm));
  ASSERT_TRUE(cover) << cover.reason();
  const auto plate = intact_plate(*cover, 1, {});
  ASSERT_FALSE(plate);
  EXPECT_NE(plate.reason().find("thinner than two voxels"), std::string::npos);
}

}  // namespace
}  // namespace burr::metrics
