// The path of a cut along the plane of a step: which plane, how a tool is held in it, and how far it goes.
#include "burr/surgeon/plane_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/rack.h"

namespace burr::surgeon {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

// A slab 2 mm wide across x, its middle at x = 3 mm, cut from above.
scenario::CaseLesson slab() {
  scenario::CaseLesson lesson;
  lesson.approach = {Vec3::UnitZ()};
  scenario::CaseRegion& region = lesson.regions.emplace_back();
  region.name = "slab";
  for (auto* shapes : {&region.add, &region.take}) {
    scenario::Shape& face = shapes->emplace_back();
    face.kind = scenario::ShapeKind::half_space;
    face.normal = Vec3::UnitX();
    face.a.at = Vec3(shapes == &region.add ? 2 : 4, 7, 1) * kMm;
  }
  scenario::Step& step = lesson.steps.emplace_back();
  step.id = "cut";
  step.region = "slab";
  return lesson;
}

TEST(PlaneCut, TheMiddleOfASlabIsThePlane) {
  const auto plane = plane_of(slab(), "cut");
  ASSERT_TRUE(plane.ok()) << plane.error().text;
  EXPECT_NEAR(plane->at.x(), 3 * kMm, 1e-12);
  EXPECT_TRUE(plane->normal.isApprox(Vec3::UnitX()));
  EXPECT_TRUE(plane->out.isApprox(Vec3::UnitZ()));
}

TEST(PlaneCut, WhatHasNoPlaneIsRefusedWithAReason) {
  scenario::CaseLesson lesson = slab();
  const auto why = [&lesson](const char* step) {
    const auto plane = plane_of(lesson, step);
    return plane.ok() ? std::string() : plane.error().text;
  };
  EXPECT_NE(why("saw").find("its steps are cut"), std::string::npos) << why("saw");
  lesson.steps[0].approach = {Vec3::UnitX()};
  EXPECT_NE(why("cut").find("runs across"), std::string::npos) << why("cut");
  lesson.regions[0].take[0].normal = Vec3::UnitY();
  EXPECT_NE(why("cut").find("parallel"), std::string::npos) << why("cut");
}

// A narrow saw needs several places, and some seconds at each.
TEST(PlaneCut, TooLittleTimeForTheBladeIsRefusedWithTheTimeItNeeds) {
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-6, -12, -6) * kMm, Vec3(12, 12, 6) * kMm, 0.25 * kMm), {},
      phantom::box({10 * kMm, 8 * kMm, 3 * kMm}));
  const auto plane = plane_of(slab(), "cut");
  ASSERT_TRUE(plane.ok());
  const scenario::RackTool saw = *scenario::built_in_rack().get("sagittal-saw");
  Blade narrow = blade_of(saw.tool, saw.cutter, saw.lean);
  narrow.width = 1 * kMm;
  const auto path = cut_along(*bone, *plane, narrow, 10);
  ASSERT_FALSE(path.ok());
  EXPECT_NE(path.error().text.find("give more than"), std::string::npos) << path.error().text;
  const auto longer = cut_along(*bone, *plane, narrow, 120);
  ASSERT_TRUE(longer.ok());
  for (std::size_t n = 1; n < longer->points.size(); ++n)
    EXPECT_GT(longer->points[n].t, longer->points[n - 1].t);
}

// The tip of what cuts goes through the bone and a quarter of a millimetre on; a saw that stands covers
// the width in plunges, a round burr in strokes; the hand ends in free air with the foot off.
TEST(PlaneCut, EveryToolGoesThroughAndNoFarther) {
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-6, -12, -6) * kMm, Vec3(12, 12, 6) * kMm, 0.25 * kMm), {},
      phantom::box({10 * kMm, 8 * kMm, 3 * kMm}));
  const auto plane = plane_of(slab(), "cut");
  ASSERT_TRUE(plane.ok());
  const scenario::RackTool stands = *scenario::built_in_rack().get("sagittal-saw"),
                           lies = *scenario::built_in_rack().get("reciprocating-saw");
  for (const Blade& blade : {blade_of(stands.tool, stands.cutter, stands.lean),
                             blade_of(lies.tool, lies.cutter, lies.lean), round_blade(1 * kMm)}) {
    const auto path = cut_along(*bone, *plane, blade, 60);
    ASSERT_TRUE(path.ok()) << path.error().text;
    double low = 1, left = 1, right = -1;
    for (const device::PathPoint& point : path->points) {
      const math::Pose& hand = point.world_from_tool;
      const Vec3 ahead = hand.q * (blade.lies ? Vec3(-Vec3::UnitX()) : Vec3(-Vec3::UnitZ()));
      const Vec3 side = hand.q * (blade.lies ? Vec3::UnitZ() : Vec3::UnitX());
      EXPECT_TRUE(ahead.isApprox(-Vec3::UnitZ(), 1e-9));
      EXPECT_NEAR(std::abs(side.y()), 1, 1e-9) << "the blade lies in the plane";
      EXPECT_NEAR(hand.p.x(), 3 * kMm, 1e-12);
      low = std::min(low, hand.p.z() - blade.beyond);
      left = std::min(left, hand.p.y() - blade.width / 2);
      right = std::max(right, hand.p.y() + blade.width / 2);
    }
    EXPECT_NEAR(low, -3.25 * kMm, 0.2 * kMm);
    EXPECT_LT(left, -8 * kMm);
    EXPECT_GT(right, 8 * kMm);
    EXPECT_GT(path->points.front().world_from_tool.p.z() - blade.beyond, 7 * kMm);
    EXPECT_GT(path->points.back().world_from_tool.p.z() - blade.beyond, 7 * kMm);
    EXPECT_EQ(path->points.back().pedal, 0);
    EXPECT_NEAR(path->duration(), 60, 2);
  }
  EXPECT_FALSE(cut_along(*bone, *plane, round_blade(1 * kMm), 1).ok());
}

// A box 20 x 16 x 6 mm, met across: 16 x 6 mm; half of it cut away leaves half, and needs twice the time
// and a fifth more.
TEST(PlaneCut, WhatIsLeftInThePlaneSaysHowLongTheCutNeeds) {
  const auto plane = plane_of(slab(), "cut");
  ASSERT_TRUE(plane.ok());
  const auto area = [&plane](const phantom::Depth& depth) {
    return bone_in_plane(
        *phantom::bone_from_distance(
            phantom::box_grid(Vec3(-6, -12, -6) * kMm, Vec3(12, 12, 6) * kMm, 0.25 * kMm), {},
            depth),
        *plane);
  };
  const phantom::Depth box = phantom::box({10 * kMm, 8 * kMm, 3 * kMm});
  const double whole = area(box);
  EXPECT_NEAR(whole, 96 * kMm * kMm, 5 * kMm * kMm);
  // all above z = 0 is cut away along the plane, 1 mm wide
  const double half = area([&box](const Vec3& p) {
    const double kerf = std::min(0.5 * kMm - std::abs(p.x() - 3 * kMm), p.z());
    return std::min(box(p), -kerf);
  });
  EXPECT_NEAR(half / whole, 0.5, 0.05);
  EXPECT_EQ(area([&box](const Vec3& p) {
              return std::min(box(p), std::abs(p.x() - 3 * kMm) - 0.5 * kMm);
            }),
            0);
  EXPECT_EQ(seconds_needed(240, 0.5), 600);  // 576, in whole minutes
  EXPECT_EQ(seconds_needed(240, 0.1), 360);
  EXPECT_GT(seconds_needed(240, 1), 30'000) << "nothing was cut";
  EXPECT_LE(seconds_needed(36'000, 1), 36'000);
}

}  // namespace
}  // namespace burr::surgeon
