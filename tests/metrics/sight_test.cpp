// What was in sight, the hand's tremor, strokes along a tube, contacts with solid structures, noise.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "burr/metrics/noise.h"
#include "burr/metrics/solid_contacts.h"
#include "burr/metrics/stroke_direction.h"
#include "burr/metrics/tremor.h"
#include "burr/metrics/visibility.h"
#include "metrics/metric_bones.h"
#include "metrics/ticks.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::Happening;
using test::kMm;

// Q7: a cavity under a roof over its half x > 0; the eye is above, at the cavity's axis or aside
TEST(Visibility, OfAHalfHiddenCut) {
  test::Plan plan;
  plan.bone = phantom::common(
      test::below(6 * kMm),
      phantom::either(test::below(-2 * kMm),
                      phantom::common(test::above(2 * kMm), phantom::slab({-1, 0, 0}, {0, 0, 0}))));
  const auto bone = test::build(plan, plan.bone, 0.25 * kMm);
  const Vec3 eye = {0, 0, 300 * kMm};
  EXPECT_EQ(share_in_sight(*bone, {-4 * kMm, 0, 0}, 1 * kMm, eye), 1);
  EXPECT_EQ(share_in_sight(*bone, {4 * kMm, 0, 0}, 1 * kMm, eye), 0);
  // at the edge of the roof one of the seven points is under it
  const double edge = share_in_sight(*bone, {-0.3 * kMm, 0, 0}, 1 * kMm, eye);
  EXPECT_NEAR(edge, 6.0 / 7, 1e-9);

  const std::vector<EyeSample> eyes = {{.t = 0, .eye = eye}};
  VisibilityMaker maker(eyes);
  MomentMaker moments(test::kRate);
  Moment now;
  // half of the volume in the open, then half under the roof
  const auto rows = test::rows_of(2, [](double t) {
    return Happening{.place = {(t < 1 ? -4 : 4) * kMm, 0, 0}, .removal = 1e-9};
  });
  for (const tick::TickRow& row : rows)
    if (moments.make(row, false, now) && maker.add(now)) maker.look(*bone);
  const auto seen = maker.finish();
  ASSERT_TRUE(seen) << seen.reason();
  EXPECT_NEAR(seen->seen_share, 0.5, 0.06);
  EXPECT_NEAR(seen->mean, 0.5, 0.06);
  ASSERT_EQ(seen->worst.size(), 3U);
  EXPECT_EQ(seen->worst[0].v, 0);
  EXPECT_GT(seen->worst[0].at.x(), 0);
}

TEST(Visibility, WithoutAnEyeIsNoAnswer) {
  EXPECT_FALSE(VisibilityMaker({}).finish());
  ASSERT_FALSE(view_changes({}, 30));
  EXPECT_NE(view_changes({}, 30).reason().find("where the eye was"), std::string::npos);
  EXPECT_FALSE(view_changes(std::vector<EyeSample>{{.eye = Vec3::Constant(NAN)}}, 30));
  EXPECT_FALSE(view_changes(std::vector<EyeSample>{{}}, 0));
}

// Half of the time nobody knows where the eye was, or how large the burr was: that half is left out.
TEST(Visibility, WhatIsNotKnownIsLeftOut) {
  test::Plan plan;
  plan.bone = test::below(0);
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const Vec3& wrong : {Vec3(NAN, 0, 0), Vec3(0, 0, kInfinite), Vec3(0, 1e300, 0)}) {
    EXPECT_EQ(share_in_sight(*bone, {0, 0, 3 * kMm}, 1 * kMm, wrong), 0);
    if (wrong.allFinite()) continue;
    std::vector<record::View> views(2);
    views[0].eye = {0, 0, 300 * kMm};
    views[1].tick = 1000;
    views[1].eye = wrong;
    const std::vector<EyeSample> eyes = eyes_of(views, test::kRate);
    VisibilityMaker maker(eyes);
    MomentMaker moments(test::kRate);
    Moment now;
    const auto rows = test::rows_of(2, [](double) {
      return Happening{.place = {0, 0, 3 * kMm}, .removal = 1e-9};
    });
    for (const tick::TickRow& row : rows)
      if (moments.make(row, false, now) && maker.add(now)) maker.look(*bone);
    if (maker.end()) maker.look(*bone);
    const auto seen = maker.finish();
    ASSERT_TRUE(seen) << seen.reason();
    EXPECT_NEAR(seen->volume, 0.9e-9, 0.1e-9);
    EXPECT_EQ(seen->seen_share, 1);
  }
  const std::vector<EyeSample> eyes = {{.eye = {0, 0, 300 * kMm}}};
  VisibilityMaker maker(eyes);
  Moment now;
  now.dt = 1e-3;
  now.removed = 1e-12;
  now.tool.radius = 0;
  EXPECT_FALSE(maker.add(now));
  EXPECT_TRUE(maker.end());
  maker.look(*bone);
  ASSERT_FALSE(maker.finish());
  EXPECT_EQ(maker.finish().reason(), "the burr's radius is not recorded");
}

TEST(Visibility, TheEyeIsThatOfTheView) {
  record::View view;
  view.tick = 500;
  view.eye = {1, 2, 3};
  view.magnification = 7;
  const std::vector<EyeSample> eyes = eyes_of(std::vector<record::View>{view}, 1000);
  ASSERT_EQ(eyes.size(), 1U);
  EXPECT_EQ(eyes[0].t, 0.5);
  EXPECT_EQ(eyes[0].eye, Vec3(1, 2, 3));
  EXPECT_EQ(eyes[0].forward, Vec3(0, 0, -1));
  EXPECT_EQ(eyes[0].magnification, 7);
}

TEST(Visibility, CountsChangesOfTheView) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const std::vector<EyeSample> eyes = {
      {.t = 0, .forward = {0, 0, -1}, .magnification = 4},
      {.t = 1, .forward = {0, 0, -1}, .magnification = 4.1},  // too little
      {.t = 2, .forward = {s, 0, -c}, .magnification = 4.1},
      {.t = 3, .forward = {s, 0, -c}, .magnification = 8}};
  const auto changes = view_changes(eyes, 30);
  ASSERT_TRUE(changes);
  EXPECT_DOUBLE_EQ(changes->magnification, 2);
  EXPECT_DOUBLE_EQ(changes->direction, 2);
}

TEST(Tremor, IsTheHandsShakingInContact) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const auto story = [](double t) {
    Happening now;
    now.touching = t < 5;
    // 9 Hz of 0.1 mm along x; slow motion and a drill's line at 300 Hz do not count
    now.place = {0.1 * kMm * std::sin(kTurn * 9 * t), 5 * kMm * std::sin(kTurn * 0.3 * t),
                 0.1 * kMm * std::sin(kTurn * 300 * t)};
    return now;
  };
  const auto tremor = tremor_of(test::process(8, story).track);
  ASSERT_TRUE(tremor) << tremor.reason();
  const double rms = 0.1 * kMm / std::sqrt(2.0) / std::sqrt(3.0);
  EXPECT_NEAR(tremor->rms, rms, 0.05 * rms);
  EXPECT_NEAR(tremor->seconds, 5, 0.02);
  EXPECT_FALSE(tremor_of(test::process(1, story).track));
}

// A long stroke at 2 Hz holds little between 6 and 12 Hz: the hand does not tremble.
TEST(Tremor, AStrokeIsNone) {
  const auto story = [](double t) {
    Happening now;
    now.touching = true;
    now.place.x() = 5 * kMm * std::sin(2 * std::numbers::pi * 2 * t);
    return now;
  };
  const auto tremor = tremor_of(test::process(8, story).track);
  ASSERT_TRUE(tremor) << tremor.reason();
  EXPECT_LT(tremor->rms, 0.005 * kMm);
}

TEST(StrokeDirection, AlongAndAcross) {
  const Course course = {{{-50 * kMm, 0, 0}, {50 * kMm, 0, 0}}};
  for (const double angle : {0.0, 60.0, 90.0}) {
    std::vector<BurrStroke> strokes(6);
    const double a = angle * std::numbers::pi / 180;
    for (std::size_t n = 0; n < strokes.size(); ++n) {
      const double way = n % 2 == 0 ? 1 : -1;
      // the surface of the burr comes within 2 mm; on the last one it stays 3.5 mm away
      const Vec3 beside = (n == 5 ? 5.5 : 4) * kMm * Vec3::UnitZ();
      strokes[n].from = beside;
      strokes[n].to = beside + way * 5 * kMm * Vec3(std::cos(a), std::sin(a), 0);
      strokes[n].radius = 2 * kMm;
      strokes[n].d = 1 * kMm;  // to what is to be spared: says nothing about the tube
    }
    const auto direction = stroke_direction(strokes, course);
    ASSERT_TRUE(direction) << direction.reason();
    EXPECT_EQ(direction->count, 5U);
    EXPECT_NEAR(direction->mean, std::cos(a), 1e-9);
    EXPECT_EQ(direction->along_share, angle < 45 ? 1 : 0);
  }
  EXPECT_FALSE(stroke_direction({}, course));
  const auto unknown = stroke_direction(std::vector<BurrStroke>(6), course);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.reason(), kNoRadius);
}

// Across the tube, but beside something else: these strokes do not count, however near that is.
TEST(StrokeDirection, OnlyStrokesNearTheTubeCount) {
  const Course course = {{{-50 * kMm, 0, 0}, {50 * kMm, 0, 0}}};
  std::vector<BurrStroke> strokes(15);
  for (std::size_t n = 0; n < strokes.size(); ++n) {
    const bool here = n < 5;
    strokes[n].from = here ? Vec3(0, 2 * kMm, 0) : Vec3(0, 20 * kMm, 0);
    strokes[n].to = strokes[n].from + 5 * kMm * (here ? Vec3::UnitX() : Vec3::UnitY());
    strokes[n].radius = 1 * kMm;
    strokes[n].d = 0.5 * kMm;
  }
  const auto direction = stroke_direction(strokes, course);
  ASSERT_TRUE(direction) << direction.reason();
  EXPECT_EQ(direction->count, 5U);
  EXPECT_EQ(direction->along_share, 1);
}

TEST(SolidContacts, OfTheNearestTissueOnly) {
  test::Plan plan;
  plan.bone = test::below(0);
  plan.labels = {{phantom::slab({1, 0, 0}, {0, 0, 0}), test::kHard}};  // x < 0 is hard
  const auto bone = test::build(plan, plan.bone, 0.25 * kMm);
  const std::array<volume::TissueId, 2> solid = {test::kBone, test::kHard};
  const std::array<volume::TissueId, 1> hard = {test::kHard};
  NoProgress quiet;
  const auto all = volume::DistanceTo::make(*bone, solid, {}, quiet);
  ASSERT_TRUE(all);
  SolidContactsMaker maker(*all, hard, 0.25 * kMm);
  MomentMaker moments(test::kRate);
  Moment now;
  const auto rows = test::rows_of(4, [](double t) {
    Happening one;
    one.touching = true;
    one.force = 0.7;
    one.place = {(t < 1 ? -3 : t < 2 ? 3 : -3) * kMm, 0, 1 * kMm};
    if (t > 3) one.spindle = 0;  // stands still
    return one;
  });
  for (const tick::TickRow& row : rows)
    if (moments.make(row, false, now)) maker.add(now);
  const auto contacts = maker.finish();
  ASSERT_TRUE(contacts) << contacts.reason();
  EXPECT_EQ(contacts->count(), 2U);
  EXPECT_NEAR(contacts->seconds(), 2, 0.01);
  EXPECT_NEAR(contacts->list()[0].force, 0.7, 1e-9);
}

TEST(SolidContacts, WithoutBoneOrRadiusAreNoAnswer) {
  const std::array<volume::TissueId, 1> hard = {test::kHard};
  const volume::DistanceTo nowhere;
  EXPECT_NE(SolidContactsMaker(nowhere, hard, kMm).finish().reason().find("no solid tissue"),
            std::string::npos);
  test::Plan plan;
  plan.bone = test::below(0);
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  const auto all = test::distance_to(*bone, test::kBone);
  EXPECT_NE(SolidContactsMaker(*all, {}, kMm).finish().reason().find("not in this bone"),
            std::string::npos);
  SolidContactsMaker maker(*all, hard, kMm);
  EXPECT_EQ(maker.finish().reason(), "the burr never turned");
  Moment now;
  now.turning = now.touching = true;
  now.normal = {0, 0, 1};
  maker.add(now);
  EXPECT_EQ(maker.finish().reason(), "the burr's radius is not recorded");
}

TEST(Noise, OfABurrOfUnknownSizeIsNoAnswer) {
  NoiseMaker maker;
  ASSERT_TRUE(maker.dose());
  EXPECT_EQ(*maker.dose(), 0);  // no contact, no noise
  Moment now;
  now.turning = now.touching = true;
  maker.add(now);
  EXPECT_FALSE(maker.dose());
}

TEST(Noise, EightHoursAtTheLimitAreOneHundredPercent) {
  // 108 dBA at 6.5 mm: 23 dB above 85, so the day's dose after 8 h / 2^(23 / 3)
  Moment now;
  now.touching = now.turning = true;
  now.tool.radius = 3.25e-3;
  now.dt = 1;
  NoiseMaker maker;
  const double seconds = 8 * 3600 / std::exp2(23.0 / 3);
  for (int n = 0; n < 100; ++n) maker.add(now);
  ASSERT_TRUE(maker.dose());
  EXPECT_NEAR(*maker.dose(), 100 * 100 / seconds, 1e-9);
  NoiseMaker half;  // 6 dB less: a quarter of the dose
  now.tool.radius = 3.25e-3 / 2;
  for (int n = 0; n < 100; ++n) half.add(now);
  EXPECT_NEAR(*half.dose(), *maker.dose() / 4, 1e-9);
}

}  // namespace
}  // namespace burr::metrics
