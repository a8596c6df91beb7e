// Cells over a structure, ways to a closed cavity, and a wall between two airs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "burr/math/aabb.h"
#include "burr/metrics/no_cells.h"
#include "burr/metrics/opened.h"
#include "burr/metrics/thinned.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

// K4: dura below 0, a plate of 1.2 mm, foam above up to 5 mm, and a cortex over it
test::Plan foam_over_dura() {
  test::Plan plan;
  plan.lo = {-6 * kMm, -6 * kMm, -1.5 * kMm};
  plan.hi = {6 * kMm, 6 * kMm, 7 * kMm};
  const phantom::Depth foam = phantom::common(phantom::gyroid(3 * kMm, 0.35), test::below(5 * kMm));
  const phantom::Depth plate = phantom::plate(1.2 * kMm, kUp, {0, 0, 0.6 * kMm});
  const phantom::Depth cortex = phantom::plate(1 * kMm, kUp, {0, 0, 5.5 * kMm});
  plan.bone =
      phantom::common(test::above(0), phantom::either(foam, phantom::either(plate, cortex)));
  plan.labels = {{test::below(0), test::kNerve}};
  plan.lipschitz = phantom::kGyroidSteepness;
  return plan;
}

constexpr double kGyroidVoxels[] = {0.4e-3, 0.25e-3};

TEST(NoCells, LeavesWhatWasNotRemoved) {
  const test::Plan plan = foam_over_dura();
  for (const double h : kGyroidVoxels) {
    double before = 2;
    for (const double edge : {-6.5, -2.0, 2.0, 5.2, 7.0}) {
      const phantom::Depth cavity =
          phantom::common(test::above(1.2 * kMm), phantom::slab({1, 0, 0}, {edge * kMm, 0, 0}));
      const auto bones = test::cut(plan, cavity, h);
      const auto dura = test::distance_to(*bones.before, test::kNerve);
      const auto cells = no_cells(*bones.before, *bones.after, *dura, {}, {.towards = {kUp}});
      ASSERT_TRUE(cells) << cells.reason();
      const double truth = std::clamp((6 - edge) / 12, 0.0, 1.0);
      std::printf("K4 h %.3f edge %+.1f: left %.3f of %.3f, shut %.3f, walls %.0f mm^3\n", h / kMm,
                  edge, cells->left.value, truth, cells->shut.value, cells->walls * 1e9);
      EXPECT_NEAR(cells->left.value, truth, cells->left.error);
      EXPECT_LE(cells->left.value, before);
      before = cells->left.value;
      if (edge < -6) {
        EXPECT_GT(cells->shut.value, 0.25);  // much of the foam is open to the block's sides
      }
      if (edge > 6) {
        EXPECT_EQ(cells->shut.value, 0);
        EXPECT_TRUE(cells->hidden.empty());
      }
      EXPECT_EQ(cells->met, edge > 5);
      for (const Vec3& p : cells->standing) EXPECT_GT(p.x(), edge * kMm - h);
    }
  }
}

// A distance that reaches just as far as the zone gives the same zone; a shorter one no answer.
TEST(NoCells, TheDistanceMustReachTheZonesEnd) {
  const test::Plan plan = foam_over_dura();
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  const auto air_within = [&](double reach) {
    const std::array<volume::TissueId, 1> ids = {test::kNerve};
    NoProgress quiet;
    const auto dura = volume::DistanceTo::make(*bone, ids, {.reach = reach}, quiet);
    EXPECT_TRUE(dura);
    return no_cells(*bone, *bone, *dura, {}, {.towards = {kUp}, .d = 3 * kMm});
  };
  const auto far = air_within(20 * kMm), just = air_within(3 * kMm), less = air_within(2.5 * kMm);
  ASSERT_TRUE(far && just);
  EXPECT_EQ(just->air, far->air);
  EXPECT_EQ(just->walls, far->walls);
  ASSERT_FALSE(less);
  EXPECT_NE(less.reason().find("up to 2.50 mm"), std::string::npos) << less.reason();
}

TEST(NoCells, ThickBoneIsNoWall) {
  // solid blocks of 3 mm with gaps of 1 mm: no wall of cells, though there is air
  test::Plan plan = foam_over_dura();
  const phantom::Depth block = phantom::plate(3 * kMm, {1, 0, 0}, {-2.5 * kMm, 0, 0});
  const phantom::Depth other = phantom::plate(3 * kMm, {1, 0, 0}, {2.5 * kMm, 0, 0});
  plan.bone = phantom::common(phantom::common(test::above(0), test::below(6 * kMm)),
                              phantom::either(block, other));
  plan.lipschitz = 1;
  const auto bone = test::build(plan, plan.bone, 0.25 * kMm);
  const auto dura = test::distance_to(*bone, test::kNerve);
  const auto cells = no_cells(*bone, *bone, *dura, {}, {.towards = {kUp}});
  EXPECT_TRUE(!cells || cells->walls < 3e-9);
}

TEST(NoCells, BoneWithoutCellsIsNoAnswer) {
  test::Plan plan = foam_over_dura();
  plan.bone = phantom::common(test::above(0), test::below(6 * kMm));
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  const auto dura = test::distance_to(*bone, test::kNerve);
  const auto cells = no_cells(*bone, *bone, *dura, {}, {.towards = {kUp}});
  ASSERT_FALSE(cells);
  EXPECT_NE(cells.reason().find("without cells"), std::string::npos) << cells.reason();
}

// K5: a closed cavity of 2 mm radius, and a tube to it from a dish
struct Way {
  test::Cut bones;
  VoxelSet room;
};
Way way_of(double radius, double h) {
  test::Plan plan;
  plan.lo = {-5 * kMm, -5 * kMm, -6.5 * kMm};
  plan.hi = {5 * kMm, 5 * kMm, 5 * kMm};
  const phantom::Depth room = phantom::ball(2 * kMm, {0.3 * kMm, 0.1 * kMm, -3 * kMm});
  plan.bone = phantom::without(test::below(4 * kMm), room);
  plan.labels = {{room, test::kCanal}};
  phantom::Depth cavity = phantom::ball(3.5 * kMm, {0, 0, 5 * kMm});
  if (radius > 0)
    cavity = phantom::either(cavity, phantom::capsule({0.3 * kMm, 0.1 * kMm, 4 * kMm},
                                                      {0.3 * kMm, 0.1 * kMm, -3 * kMm}, radius));
  Way way{test::cut(plan, cavity, h), {}};
  const std::array<volume::TissueId, 1> label = {test::kCanal};
  way.room = VoxelSet::of_air(*way.bones.before, label, {});
  return way;
}

TEST(Opened, FindsTheRadiusOfTheWay) {
  for (const double h : test::kVoxels)
    for (const double radius : {0.8, 1.2, 1.5}) {
      const Way way = way_of(radius * kMm, h);
      const auto open =
          opened(*way.bones.before, *way.bones.after, {.label = &way.room}, {.towards = {kUp}});
      ASSERT_TRUE(open) << open.reason();
      std::printf("K5 h %.3f rho %.1f: %+.3f mm\n", h / kMm, radius,
                  open->mark.value / kMm - radius);
      EXPECT_NEAR(open->mark.value, radius * kMm, open->mark.error);
      EXPECT_EQ(open->mark.met, radius > 1);
      EXPECT_LT(open->touch.z(), 1.5 * kMm);
    }
}

// The box holds the middle of the way alone: the walls beside it still make it narrow.
TEST(Opened, BoneBesideTheBoxIsInTheWayToo) {
  for (const double h : test::kVoxels) {
    const Way way = way_of(0.8 * kMm, h);
    math::Aabb box;
    box.extend({0 * kMm, -0.2 * kMm, -6 * kMm});
    box.extend({0.6 * kMm, 0.4 * kMm, 5 * kMm});
    const auto open = opened(*way.bones.before, *way.bones.after, {.label = &way.room},
                             {.towards = {kUp}, .rho = 0.8 * kMm, .box = box});
    ASSERT_TRUE(open) << open.reason();
    EXPECT_NEAR(open->mark.value, 0.8 * kMm, open->mark.error) << h;
  }
}

TEST(Opened, IsTheSameForAnyNumberOfThreads) {
  const Way way = way_of(1.2 * kMm, 0.25 * kMm);
  const auto open = [&](int threads) {
    return opened(*way.bones.before, *way.bones.after, {.label = &way.room},
                  {.towards = {kUp}, .threads = threads});
  };
  const auto one = open(1), three = open(3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->mark.value, three->mark.value);
  EXPECT_EQ(one->touch, three->touch);
}

TEST(Opened, AClosedRoomIsNotOpened) {
  for (const double h : test::kVoxels) {
    const Way way = way_of(0, h);
    const auto open =
        opened(*way.bones.before, *way.bones.after, {.label = &way.room}, {.towards = {kUp}});
    ASSERT_TRUE(open);
    EXPECT_FALSE(open->mark.met);
    EXPECT_EQ(open->mark.value, 0);
  }
}

// What a ball reached before the cut is not opened by the cut.
TEST(Opened, AnOldWayDoesNotCount) {
  test::Plan plan;
  plan.lo = {-5 * kMm, -5 * kMm, -6.5 * kMm};
  plan.hi = {5 * kMm, 5 * kMm, 5 * kMm};
  const phantom::Depth room = phantom::ball(2 * kMm, {0, 0, -3 * kMm});
  const phantom::Depth canal =
      phantom::capsule({-8 * kMm, 0, -3 * kMm}, {0, 0, -3 * kMm}, 1.4 * kMm);
  plan.bone = phantom::without(test::below(4 * kMm), phantom::either(room, canal));
  plan.labels = {{room, test::kCanal}};
  // a pit beside the mouth of the canal; seen from the side, where the canal opens
  const auto bones = test::cut(plan, phantom::ball(2 * kMm, {-5 * kMm, 0, -1 * kMm}), 0.25 * kMm);
  const std::array<volume::TissueId, 1> label = {test::kCanal};
  const VoxelSet target = VoxelSet::of_air(*bones.before, label, {});
  const auto open =
      opened(*bones.before, *bones.after, {.label = &target}, {.towards = {{-1, 0, 0}}});
  ASSERT_TRUE(open) << open.reason();
  EXPECT_FALSE(open->mark.met);
}

TEST(Opened, ALandmarkIsATarget) {
  const Way way = way_of(1.2 * kMm, 0.25 * kMm);
  const auto open =
      opened(*way.bones.before, *way.bones.after,
             {.centre = {0.3 * kMm, 0.1 * kMm, -3 * kMm}, .radius = 1.5 * kMm}, {.towards = {kUp}});
  ASSERT_TRUE(open);
  EXPECT_TRUE(open->mark.met);
  const auto outside = opened(*way.bones.before, *way.bones.after,
                              {.centre = {50 * kMm, 0, 0}, .radius = 1 * kMm}, {.towards = {kUp}});
  EXPECT_FALSE(outside);
}

// K6: a canal of 2 mm along z, and a cavity beside it that leaves a wall of t
test::Cut wall_of(double t, double hole, double h) {
  test::Plan plan;
  plan.lo = {-4 * kMm, -4 * kMm, -4 * kMm};
  plan.hi = {7 * kMm, 4 * kMm, 4 * kMm};
  const phantom::Depth canal = phantom::capsule({0, 0, -20 * kMm}, {0, 0, 20 * kMm}, 2 * kMm);
  plan.bone = phantom::without(phantom::slab({1, 0, 0}, {6 * kMm, 0, 0}), canal);
  plan.labels = {{canal, test::kCanal}};
  // the cavity's wall follows the canal
  phantom::Depth cavity =
      phantom::common(phantom::slab({-1, 0, 0}, {0.5 * kMm, 0, 0}),
                      [t](const Vec3& p) { return std::hypot(p.x(), p.y()) - 2 * kMm - t; });
  if (hole > 0)
    cavity = phantom::either(cavity, phantom::capsule({1 * kMm, 0, 0}, {9 * kMm, 0, 0}, hole));
  return test::cut(plan, cavity, h);
}

Assessed<Thin> wall_seen(const test::Cut& bones) {
  const std::array<volume::TissueId, 1> label = {test::kCanal};
  const VoxelSet canal = VoxelSet::of_air(*bones.before, label, {});
  return thinned(*bones.before, *bones.after, canal, nullptr,
                 in_half_space({1.2 * kMm, 0, 0}, {-1, 0, 0}), 1, {.towards = {{1, 0, 0}}});
}

TEST(Thinned, MeasuresTheWall) {
  for (const double h : test::kVoxels)
    for (const double t : {0.6, 1.0, 2.5}) {
      const auto wall = wall_seen(wall_of(t * kMm, 0, h));
      ASSERT_TRUE(wall) << wall.reason();
      std::printf("K6 h %.3f t %.1f: median %+.3f, thinnest %+.3f, thickest %+.3f\n", h / kMm, t,
                  wall->median / kMm - t, wall->thinnest / kMm - t, wall->thickest / kMm - t);
      EXPECT_NEAR(wall->median, t * kMm, std::max(0.05 * kMm, 0.2 * h));
      EXPECT_EQ(wall->even.met, t < 2);
      EXPECT_LT(wall->bare.value, 0.01);
    }
}

TEST(Thinned, SeesAHole) {
  for (const double h : test::kVoxels) {
    const auto wall = wall_seen(wall_of(1.0 * kMm, 1.5 * kMm, h));
    ASSERT_TRUE(wall) << wall.reason();
    EXPECT_GT(wall->bare.value, 0.1);
    EXPECT_FALSE(wall->bare.met);
    EXPECT_FALSE(wall->even.met);
    EXPECT_LT(std::abs(wall->thinnest_at.z()), 1.6 * kMm);
  }
}

TEST(Thinned, AnUntouchedWallIsThick) {
  test::Plan plan;
  const phantom::Depth canal = phantom::capsule({0, 0, -20 * kMm}, {0, 0, 20 * kMm}, 2 * kMm);
  plan.bone = phantom::without(phantom::slab({1, 0, 0}, {6 * kMm, 0, 0}), canal);
  plan.labels = {{canal, test::kCanal}};
  auto bones = test::cut(plan, test::above(50 * kMm), 0.4 * kMm);
  const auto wall = wall_seen(bones);
  ASSERT_TRUE(wall) << wall.reason();
  EXPECT_FALSE(wall->even.met);
  EXPECT_EQ(wall->thinnest, kUnseen);
}

}  // namespace
}  // namespace burr::metrics
