// Planes, axes and shapes of cavities, fitted to cuts whose numbers are known; and the arithmetic
// below them against the C library.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "burr/metrics/axis_fit.h"
#include "burr/metrics/breach.h"
#include "burr/metrics/cavity_shape.h"
#include "burr/metrics/divided.h"
#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/plane_fit.h"
#include "burr/metrics/same_math.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

TEST(SameMath, IsTheCLibrarysToFourteenDigits) {
  const std::uint64_t seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(-50, 50), any(-1, 1), power(-20, 20);
  for (int n = 0; n < 20000; ++n) {
    const double a = angle(random);
    EXPECT_NEAR(sine(a), std::sin(a), 3e-15);
    EXPECT_NEAR(cosine(a), std::cos(a), 3e-15);
    const double x = any(random), y = any(random) * std::exp2(power(random));
    EXPECT_NEAR(arc_tangent(y, x), std::atan2(y, x), 1e-14);
    const double p = power(random);
    EXPECT_NEAR(two_to(p), std::exp2(p), 1e-14 * std::exp2(p));
    EXPECT_NEAR(logarithm(std::exp2(p)), std::log(std::exp2(p)), 2e-14);
  }
  EXPECT_EQ(arc_tangent(0, 0), 0);
  EXPECT_NEAR(arc_tangent(0, -1), std::numbers::pi, 1e-15);
  EXPECT_EQ(logarithm(1), 0);
}

TEST(LineAndPlane, ARobustLineIgnoresAFewWildPoints) {
  std::vector<WeightedPoint> points;
  for (int n = 0; n < 40; ++n) points.push_back({Vec3(0.1 * n, 0.02 * n + 1, 2), 1});
  points[5].place.z() = 9;
  points[30].place.y() = -7;
  const LineThrough line = robust_line(points, {0, 0, 0}, {1, 0, 0});
  EXPECT_LT((line.at_zero - Vec3(0, 1, 2)).norm(), 0.01);
  EXPECT_LT((line.slope - Vec3(1, 0.2, 0)).norm(), 0.01);
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 1}, {2, 8}}, 0.5), 2);
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 1}, {2, 8}}, 0.95), 3);
}

// K7: a slot of 2 mm; its lower face lies d above the plan, tilted by b, with waves
struct Slot {
  double offset, tilt, wave;  // [m, rad, m]
};
test::Cut slot_of(const Slot& slot, double h) {
  test::Plan plan;
  plan.bone = phantom::box({7 * kMm, 7 * kMm, 7 * kMm});
  const Vec3 n = {std::sin(slot.tilt), 0, std::cos(slot.tilt)};
  const Vec3 point = {0, 0, slot.offset};
  const phantom::Depth cavity = [=](const Vec3& p) {
    const double up =
        (p - point).dot(n) + slot.wave * std::sin(2 * std::numbers::pi * p.y() / (3 * kMm));
    return std::min(up, 2 * kMm - up);
  };
  plan.lipschitz = 1 + slot.wave * 2 * std::numbers::pi / (3 * kMm);
  return test::cut(plan, cavity, h);
}

// A slot through a box, with a bridge of bone left in it: `bridge` wide across, all the way along y.
test::Cut divided_box(double bridge, double above, double h) {
  test::Plan plan;
  plan.bone = phantom::box({7 * kMm, 7 * kMm, 7 * kMm});
  const phantom::Depth cavity = [=](const Vec3& p) {
    const double slot = std::min(p.z() - above, above + 2 * kMm - p.z());
    return bridge > 0 ? std::min(slot, std::abs(p.x()) - 0.5 * bridge) : slot;
  };
  return test::cut(plan, cavity, h);
}

TEST(Divided, FindsTheSmallerPieceAndABridge) {
  for (const double h : test::kVoxels) {
    SCOPED_TRACE(h);
    // the piece above the slot is 4 of 12 mm high
    const auto two = divided_box(0, 1 * kMm, h);
    const auto found = divided(*two.before, *two.after, {}, 0.05);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->share, 4.0 / 12, 0.02);
    EXPECT_NEAR(found->first, 8.0 / 12, 0.02);
    const auto bridged = divided_box(5 * h, 1 * kMm, h);
    EXPECT_EQ(divided(*bridged.before, *bridged.after, {}, 0.05)->share, 0);
    // what is at most two voxels wide breaks
    const auto thin = divided_box(1.5 * h, 1 * kMm, h);
    EXPECT_GT(divided(*thin.before, *thin.after, {}, 0.05)->share, 0.3);
    // only what lies in the region counts
    const auto low = [](const Vec3& p) { return -p.z(); };
    EXPECT_EQ(divided(*two.before, *two.after, low, 0.05)->share, 0);
    const auto was = divided(*two.after, *two.after, {}, 0.05);
    ASSERT_FALSE(was);
    EXPECT_NE(was.reason().find("two pieces"), std::string::npos);
  }
}

TEST(PlaneFit, FindsOffsetAngleAndWaves) {
  for (const double h : test::kVoxels)
    for (const Slot& slot : {Slot{0.3 * kMm, 0, 0}, Slot{-0.5 * kMm, 4 * kDegree, 0},
                             Slot{0.2 * kMm, 2 * kDegree, 0.2 * kMm}}) {
      const auto bones = slot_of(slot, h);
      const auto fit = plane_fit(*bones.before, *bones.after, {{0, 0, 0}, kUp},
                                 in_box({}, Vec3::Constant(6 * kMm)), {});
      ASSERT_TRUE(fit) << fit.reason();
      std::printf("K7 h %.3f: offset %+.4f mm, angle %+.3f deg, rms %.3f\n", h / kMm,
                  (fit->offset - slot.offset) / kMm, (fit->angle - slot.tilt) / kDegree,
                  fit->rms / kMm);
      EXPECT_NEAR(fit->offset, slot.offset / 1.0, 0.02 * kMm + fit->error);
      EXPECT_NEAR(fit->angle, slot.tilt, 0.2 * kDegree);
      EXPECT_NEAR(fit->rms, slot.wave / std::sqrt(2.0), 0.03 * kMm);
      EXPECT_GE(fit->uneven, fit->rms - 1e-9);
    }
}

TEST(PlaneFit, NothingCutIsNoAnswer) {
  test::Plan plan;
  plan.bone = phantom::box({7 * kMm, 7 * kMm, 7 * kMm});
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  EXPECT_FALSE(plane_fit(*bone, *bone, {{0, 0, 0}, kUp}, {}, {}));
}

// K8: a corridor of 1.5 mm radius and 12 mm length into a block, shifted and tilted
TEST(AxisFit, FindsShiftAndTilt) {
  for (const double h : test::kVoxels)
    for (const double tilt : {0.0, 6.0}) {
      test::Plan plan;
      plan.lo = {-6 * kMm, -6 * kMm, -14 * kMm};
      plan.hi = {6 * kMm, 6 * kMm, 2 * kMm};
      plan.bone = test::below(0);
      const double shift = 0.7 * kMm, b = tilt * kDegree;
      const Vec3 inward = {std::sin(b), 0, -std::cos(b)}, entry = {shift, 0.1 * kMm, 0};
      const phantom::Depth corridor = [=](const Vec3& p) {
        const double l = (p - entry).dot(inward);
        const double across = ((p - entry) - l * inward).norm();
        return std::min(1.5 * kMm - across, 12 * kMm - l);
      };
      const auto bones = test::cut(plan, corridor, h);
      const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
      ASSERT_TRUE(fit) << fit.reason();
      const double off = std::hypot(shift, 0.1 * kMm);
      std::printf(
          "K8 h %.3f tilt %.0f: entry %+.4f mm, angle %+.3f deg, depth %+.3f, width %+.3f\n",
          h / kMm, tilt, (fit->entry_off - off) / kMm, fit->angle / kDegree - tilt,
          fit->depth / kMm - 12 * std::cos(b), fit->width / kMm - 3);
      EXPECT_NEAR(fit->entry_off, off, fit->error);
      EXPECT_NEAR(fit->angle, b, 0.5 * kDegree);
      EXPECT_NEAR(fit->depth, 12 * kMm * std::cos(b), 0.5 * h);
      EXPECT_NEAR(fit->width, 3 * kMm, 0.05 * kMm);
      EXPECT_FALSE(fit->through);
      EXPECT_LT((fit->apex - (entry + 12 * kMm * inward)).norm(), 0.5 * h + 0.05 * kMm);
    }
}

// Under 5 mm of dense bone only plates of 0.5 mm stand, every 1.2 mm: the slices there hold less than half
// as much bone, and count all the same.
TEST(AxisFit, SpongyBoneIsAsLongAndAsWide) {
  for (const double h : {0.25 * kMm, 0.125 * kMm}) {
    test::Plan plan;
    plan.lo = {-6 * kMm, -6 * kMm, -14 * kMm};
    plan.hi = {6 * kMm, 6 * kMm, 2 * kMm};
    plan.bone = [](const Vec3& p) {
      const double plate = 0.25 * kMm - std::abs(std::remainder(p.x(), 1.2 * kMm));
      return std::min(-p.z(), std::max(p.z() + 5 * kMm, plate));
    };
    const phantom::Depth corridor = [](const Vec3& p) {
      return std::min(1.5 * kMm - std::hypot(p.x(), p.y()), p.z() + 12 * kMm);
    };
    const auto bones = test::cut(plan, corridor, h);
    const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
    ASSERT_TRUE(fit) << fit.reason();
    EXPECT_GE(fit->centres.size(), 23U);  // of 24 slices of 0.5 mm
    EXPECT_NEAR(fit->width, 3 * kMm, 0.05 * kMm);
    EXPECT_LT(fit->angle, 1 * kDegree);
    EXPECT_NEAR(fit->depth, 12 * kMm, 0.5 * h);  // a plate stands on the axis
  }
}

// Dense bone on one side, plates of 0.5 mm every 1.2 mm on the other. What was removed has its centre 0.4 mm in
// the dense half, but the corridor is where it is.
TEST(AxisFit, PoresOnOneSideDoNotMoveTheAxis) {
  for (const double h : {0.4 * kMm, 0.25 * kMm}) {
    test::Plan plan;
    plan.lo = {-6 * kMm, -6 * kMm, -20 * kMm};
    plan.hi = {6 * kMm, 6 * kMm, 2 * kMm};
    plan.bone = [](const Vec3& p) {
      const double plate = 0.25 * kMm - std::abs(std::remainder(p.x(), 1.2 * kMm));
      return std::min(-p.z(), std::max(-p.x(), plate));
    };
    const phantom::Depth corridor = [](const Vec3& p) {
      return std::min(2.5 * kMm - std::hypot(p.x(), p.y()), p.z() + 18 * kMm);
    };
    const auto bones = test::cut(plan, corridor, h);
    const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
    ASSERT_TRUE(fit) << fit.reason();
    std::printf("K8 pores, h %.3f: entry %.4f mm, angle %.3f deg\n", h / kMm, fit->entry_off / kMm,
                fit->angle / kDegree);
    EXPECT_LT(fit->entry_off, 0.15 * kMm);
    EXPECT_LT(fit->angle, 0.2 * kDegree);
  }
}

// A corridor of 1 mm radius through a plate of 8 mm, and on into the air behind it.
TEST(AxisFit, ACorridorThroughThePlateEndsWhereThePlateEnds) {
  for (const double h : test::kVoxels)
    for (const double tilt : {0.0, 6.0}) {
      test::Plan plan;
      plan.lo = {-4 * kMm, -4 * kMm, -14 * kMm};
      plan.hi = {4 * kMm, 4 * kMm, 3 * kMm};
      plan.bone = phantom::common(test::below(0), test::above(-8 * kMm));
      const double b = tilt * kDegree;
      const Vec3 inward = {std::sin(b), 0, -std::cos(b)};
      const phantom::Depth corridor = [=](const Vec3& p) {
        return 1 * kMm - (p - math::dot(p, inward) * inward).norm();
      };
      const auto bones = test::cut(plan, corridor, h);
      const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
      ASSERT_TRUE(fit) << fit.reason();
      EXPECT_TRUE(fit->through);
      EXPECT_NEAR(fit->depth, 8 * kMm, 0.5 * h);
      EXPECT_NEAR(fit->apex.z(), -8 * kMm, 0.5 * h);
      EXPECT_LT(fit->entry_off, fit->error);
    }
}

// A closed hole deep in the bone, as if somebody had come from the side: its axis leads to no
// surface near the planned entry.
TEST(AxisFit, AnAxisThatMeetsNoSurfaceHasNoEntry) {
  test::Plan plan;
  plan.lo = {-4 * kMm, -4 * kMm, -30 * kMm};
  plan.hi = {4 * kMm, 4 * kMm, 2 * kMm};
  plan.bone = test::below(0);
  const auto bones =
      test::cut(plan, phantom::capsule({0, 0, -17 * kMm}, {0, 0, -26 * kMm}, 1 * kMm), 0.4 * kMm);
  const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, -16 * kMm}, {0, 0, -1}}, {});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.reason().find("planned entry"), std::string::npos) << fit.reason();
}

// Another bone lies on the way to the one that was drilled.
TEST(AxisFit, TheEntryIsThatOfTheBoneThatWasDrilled) {
  test::Plan plan;
  plan.lo = {-4 * kMm, -4 * kMm, -14 * kMm};
  plan.hi = {4 * kMm, 4 * kMm, 9 * kMm};
  plan.bone = phantom::either(test::below(0), phantom::plate(1 * kMm, kUp, {0, 0, 6 * kMm}));
  const double h = 0.25 * kMm;
  const auto bones =
      test::cut(plan, phantom::capsule({0, 0, 3 * kMm}, {0, 0, -10 * kMm}, 1 * kMm), h);
  const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
  ASSERT_TRUE(fit) << fit.reason();
  EXPECT_NEAR(fit->entry.z(), 0, 0.25 * h);
  EXPECT_FALSE(fit->through);
  EXPECT_NEAR(fit->depth, 11 * kMm, 0.5 * h);
}

TEST(AxisFit, AShortHoleHasNoAxis) {
  test::Plan plan;
  plan.bone = test::below(0);
  const auto bones = test::cut(
      plan, phantom::placed(phantom::cylinder(2 * kMm, 3 * kMm), {.p = {0, 0, 0}}), 0.25 * kMm);
  const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.reason().find("shorter than one and a half"), std::string::npos) << fit.reason();
  EXPECT_FALSE(axis_fit(*bones.before, *bones.before, {{0, 0, 0}, {0, 0, -1}}, {}));
}

// A needle's hole that goes on from the floor of a short hole makes no corridor of it.
TEST(AxisFit, AThinPartDoesNotCount) {
  test::Plan plan;
  plan.lo = {-4 * kMm, -4 * kMm, -12 * kMm};
  plan.hi = {4 * kMm, 4 * kMm, 2 * kMm};
  plan.bone = test::below(0);
  const phantom::Depth hole = phantom::cylinder(1.5 * kMm, 4 * kMm);
  const phantom::Depth needle = phantom::capsule({0, 0, 0}, {0, 0, -9 * kMm}, 0.5 * kMm);
  const auto bones = test::cut(plan, phantom::either(hole, needle), 0.25 * kMm);
  const auto fit = axis_fit(*bones.before, *bones.after, {{0, 0, 0}, {0, 0, -1}}, {});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.reason().find("shorter than one and a half"), std::string::npos) << fit.reason();
}

// K8: a round pedicle of 5 mm radius along z, with a core of marrow. A screw of 6 mm on an axis that lies
// s beside the pedicle's has 2 mm - s of bone; beyond s = 2 mm it sticks out. A pore in the wall does not count.
TEST(Breach, IsTheScrewsRadiusLessTheNearestWall) {
  for (const double h : test::kVoxels)
    for (const double s : {0.0, 1.0, 3.5}) {
      test::Plan plan;
      plan.lo = {-7 * kMm, -7 * kMm, -6 * kMm};
      plan.hi = {7 * kMm, 7 * kMm, 6 * kMm};
      const phantom::Depth core = phantom::cylinder(2 * kMm, 20 * kMm);
      const phantom::Depth pore = phantom::ball(0.3 * kMm, {0, 4 * kMm, 0});
      plan.bone =
          phantom::without(phantom::without(phantom::cylinder(5 * kMm, 20 * kMm), core), pore);
      plan.labels = {{core, test::kMarrow}};
      const auto bone = test::build(plan, plan.bone, h);
      const std::array<volume::TissueId, 1> glass = {test::kMarrow};
      const Vec3 beside = {s * kMm, 0, 0};
      const Breach found =
          breach(*bone, glass, beside - 4 * kMm * kUp, beside + 4 * kMm * kUp, 6 * kMm);
      EXPECT_NEAR(found.out, (3 - (5 - s)) * kMm, 0.5 * h);
      if (s > 0) {
        EXPECT_GT(found.way.x(), 0.95);
      }
    }
}

// An axis that is tilted leaves the bone at one of its ends.
TEST(Breach, IsThatOfTheWorstPlaceOnTheAxis) {
  test::Plan plan;
  plan.lo = {-7 * kMm, -7 * kMm, -6 * kMm};
  plan.hi = {7 * kMm, 7 * kMm, 6 * kMm};
  plan.bone = phantom::cylinder(5 * kMm, 20 * kMm);
  const double h = 0.25 * kMm;
  const auto bone = test::build(plan, plan.bone, h);
  const Vec3 from = {0, 0, 4 * kMm}, to = {0, 2 * kMm, -4 * kMm};
  const Breach found = breach(*bone, {}, from, to, 6 * kMm);
  const double slant = std::cos(std::atan2(2, 8));  // square to the axis the wall is farther
  EXPECT_NEAR(found.out, 3 * kMm - 3 * kMm / slant, 0.15 * kMm + 0.5 * h);
  EXPECT_LT((found.at - to).norm(), h);
}

// K9: a cavity with a flat or wavy floor and four walls that lean by `taper`
phantom::Depth frustum(double depth, double taper, double wave) {
  return [=](const Vec3& p) {
    const double floor = p.z() + depth + wave * std::sin(2 * std::numbers::pi * p.x() / (2 * kMm));
    // the mouth, at z = 0, is 8 x 6 mm; a taper below 0 narrows it downwards
    const double lean = std::tan(taper), c = std::cos(taper);
    const double x = c * (4 * kMm - p.z() * lean - std::abs(p.x()));
    const double y = c * (3 * kMm - p.z() * lean - std::abs(p.y()));
    return std::min({floor, x, y});
  };
}

TEST(CavityShape, FindsDepthTaperAndFloor) {
  for (const double h : test::kVoxels)
    for (const double taper : {-8.0, 0.0, 5.0})
      for (const double wave : {0.0, 0.1}) {
        test::Plan plan;
        plan.lo = {-6 * kMm, -5 * kMm, -5 * kMm};
        plan.hi = {6 * kMm, 5 * kMm, 1.5 * kMm};
        plan.bone = test::below(0);
        plan.lipschitz = 1.5;
        const auto bones = test::cut(plan, frustum(3 * kMm, taper * kDegree, wave * kMm), h);
        const auto shape = cavity_shape(*bones.before, *bones.after, kUp, {},
                                        in_box({}, {4 * kMm, 3 * kMm, 9 * kMm}));
        ASSERT_TRUE(shape) << shape.reason();
        ASSERT_TRUE(shape->taper && shape->outline);
        std::printf(
            "K9 h %.3f taper %+.0f wave %.1f: depth %+.3f, taper %+.2f, rms %.3f, outline %.3f\n",
            h / kMm, taper, wave, shape->depth / kMm - 3, *shape->taper / kDegree - taper,
            shape->uneven / kMm, *shape->outline / kMm);
        EXPECT_NEAR(shape->depth, 3 * kMm, 0.05 * kMm + 0.1 * h + 0.3 * wave * kMm);
        EXPECT_NEAR(*shape->taper, taper * kDegree, 0.6 * kDegree);
        EXPECT_NEAR(shape->uneven, wave * kMm / std::sqrt(2.0), 0.03 * kMm + 0.05 * h);
        EXPECT_LT(*shape->outline, 0.1 * kMm + 0.3 * h);
      }
}

TEST(CavityShape, NothingCutIsNoAnswer) {
  test::Plan plan;
  plan.bone = test::below(0);
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  EXPECT_FALSE(cavity_shape(*bone, *bone, kUp, {}, {}));
}

}  // namespace
}  // namespace burr::metrics
