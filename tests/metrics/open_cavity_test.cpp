// What a ball reaches is open; lines through cells and needle's holes are not.
#include "burr/metrics/open_cavity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "burr/metrics/cover.h"
#include "burr/metrics/identified.h"
#include "burr/metrics/intact_plate.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

// Dura below z = 0 under bone that was cut down to a height above it.
test::Plan over_dura() {
  test::Plan plan;
  plan.lo = {-5 * kMm, -5 * kMm, -2 * kMm};
  plan.hi = {5 * kMm, 5 * kMm, 7 * kMm};
  plan.bone = phantom::common(test::below(6 * kMm), test::above(0));
  plan.labels = {{test::below(0), test::kNerve}};
  return plan;
}

double share_found(const test::Cut& bones, bool exposed) {
  const OpenCavity open(*bones.before, *bones.after, {});
  CoverSettings settings = {.towards = {kUp}, .most_samples = 0};
  if (exposed) settings.exposed = &open;
  const auto cover =
      cover_of(*bones.before, *bones.after, test::voxels_of(*bones.before, test::kNerve),
               in_box({}, Vec3(2.5, 2.5, 3) * kMm), settings);
  EXPECT_TRUE(cover) << cover.reason();
  return identified(*cover, {})->mark.value;
}

TEST(OpenCavity, WhatWasMilledOffIsExposedAsBefore) {
  for (const double h : test::kVoxels)
    for (const double left : {0.5, 1.5}) {
      const auto bones = test::cut(over_dura(), test::above(left * kMm), h);
      EXPECT_EQ(share_found(bones, true), share_found(bones, false)) << h;
      EXPECT_EQ(share_found(bones, true), left < 1 ? 1 : 0) << h;
    }
}

// Slots of 1 mm between walls of 0.3 mm, cut open above 2.5 mm: 2 mm of bone and cells lie over the dura. Lines
// of sight meet only 0.5 mm of bone, but no ball of 1.5 mm comes near.
TEST(OpenCavity, CellsThatAreCutOpenStillHide) {
  for (const double h : {0.25 * kMm, 0.125 * kMm}) {
    test::Plan plan = over_dura();
    plan.bone = [](const Vec3& p) {
      const double wall = 0.15 * kMm - std::abs(std::remainder(p.x(), 1.3 * kMm));
      const double solid = std::max({wall, 0.5 * kMm - p.z(), p.z() - 4 * kMm});
      return std::min({solid, p.z(), 6 * kMm - p.z()});
    };
    const auto bones = test::cut(plan, test::above(2.5 * kMm), h);
    EXPECT_GT(share_found(bones, false), 0.9) << h << ": the lines through the cells";
    EXPECT_EQ(share_found(bones, true), 0) << h;
  }
}

TEST(OpenCavity, ANeedlesHoleExposesNothingAndAWideHoleItsGround) {
  for (const double h : test::kVoxels) {
    const auto drilled = [h](double radius) {
      return test::cut(
          over_dura(),
          [radius](const Vec3& p) {
            return std::min(radius - std::hypot(p.x(), p.y()), p.z() - 0.5 * kMm);
          },
          h);
    };
    EXPECT_EQ(share_found(drilled(0.5 * kMm), true), 0) << h;
    const double wide = share_found(drilled(1.5 * kMm), true);
    EXPECT_GT(wide, 0.2) << h;
    // of 25 mm^2; looks aslant see 0.6 mm more all round
    EXPECT_LT(wide, M_PI * 2.1 * 2.1 / 25) << h;
  }
  const auto untouched = test::build(over_dura(), over_dura().bone, 0.25 * kMm);
  EXPECT_TRUE(OpenCavity(*untouched, *untouched, {}).empty());
}

// An old room that was opened widely is part of the cavity; one behind a wall is not.
TEST(OpenCavity, ARoomBelongsToItOnceItIsOpened) {
  for (const double h : {0.25 * kMm, 0.125 * kMm})
    for (const double roof : {4.5, 2.9}) {  // the room ends at 3.2 mm
      test::Plan plan = over_dura();
      plan.bone = [](const Vec3& p) {
        const double room = 1.3 * kMm - std::abs(p.z() - 1.9 * kMm);  // from 0.6 to 3.2 mm
        return std::min({-room, p.z(), 6 * kMm - p.z()});
      };
      const auto bones = test::cut(plan, test::above(roof * kMm), h);
      EXPECT_EQ(share_found(bones, true), roof < 3.2 ? 1 : 0) << h << " " << roof;
    }
}

// Holes in a plate of 0.5 mm: the area is that of the hole, not what is seen below its rim.
TEST(OpenCavity, TheAreaOfASmallHoleIsItsOwn) {
  for (const double h : {0.25 * kMm, 0.125 * kMm})
    for (const double radius : {0.4, 0.8}) {
      const auto bones = test::cut(
          over_dura(),
          [radius](const Vec3& p) {
            return std::max(p.z() - 0.5 * kMm, radius * kMm - std::hypot(p.x(), p.y()));
          },
          h);
      const auto cover =
          cover_of(*bones.before, *bones.after, test::voxels_of(*bones.before, test::kNerve), {},
                   {.towards = {kUp}, .most_samples = 0});
      ASSERT_TRUE(cover);
      const auto plate = intact_plate(*cover, 1, {});
      ASSERT_TRUE(plate) << plate.reason();
      const double area = M_PI * radius * radius * 1e-6;
      EXPECT_NEAR(plate->mark.value, area, 0.15 * area + plate->mark.error / 2) << h;
      EXPECT_EQ(plate->mark.met, radius < 0.5);
    }
}

}  // namespace
}  // namespace burr::metrics
