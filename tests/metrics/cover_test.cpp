// Bone over a structure, seen through the cavity: bones in which its thickness is known, at three
// sizes of voxel.
#include "burr/metrics/cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "burr/metrics/identified.h"
#include "burr/metrics/skeletonised.h"
#include "burr/metrics/solidity.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

double accepted(double h) { return std::max(0.05 * kMm, 0.2 * h); }

// K1: a nerve along x, radius 0.85 mm, in a block whose top lies at 5 mm; a trough with a flat floor
// leaves `t` over its crown. It lies askew to the voxels.
constexpr double kNerveRadius = 0.85 * kMm;
const Vec3 kNerveAt = {0, 0.13 * kMm, -1.07 * kMm};

test::Plan nerve_in_a_block() {
  test::Plan plan;
  plan.lo = {-7 * kMm, -7 * kMm, -4 * kMm};
  plan.hi = {7 * kMm, 7 * kMm, 6.5 * kMm};
  const phantom::Depth nerve = phantom::capsule(kNerveAt - Vec3(20 * kMm, 0, 0),
                                                kNerveAt + Vec3(20 * kMm, 0, 0), kNerveRadius);
  plan.bone = phantom::without(test::below(5 * kMm), nerve);
  plan.labels = {{nerve, test::kNerve}};
  return plan;
}

phantom::Depth trough(double t) { return test::above(kNerveAt.z() + kNerveRadius + t); }

Assessed<Cover> cover_of_nerve(const test::Cut& bones, const Region& region = {},
                               const CoverSettings& settings = {.towards = {kUp}}) {
  return cover_of(*bones.before, *bones.after, test::voxels_of(*bones.before, test::kNerve), region,
                  settings);
}

double least_cover(const Cover& cover) {
  double least = kUnseen;
  for (const CoverSample& one : cover.samples) least = std::min(least, one.cover);
  return least;
}
// At the nerve's crown, where the floor is parallel to it.
double median_thickness(const Cover& cover) {
  std::vector<double> found;
  double top = 0;
  for (const CoverSample& one : cover.samples) top = std::max(top, one.surface.normal.z());
  for (const CoverSample& one : cover.samples)
    if (one.surface.normal.z() > top - 0.02) found.push_back(one.thickness);
  std::sort(found.begin(), found.end());
  return found.empty() ? kUnseen : found[found.size() / 2];
}

TEST(Cover, KnowsTheBoneOverANerve) {
  const test::Plan plan = nerve_in_a_block();
  for (const double h : test::kVoxels)
    for (const double t : {0.2, 0.5, 1.0, 1.5, 2.0}) {
      const auto cover = cover_of_nerve(test::cut(plan, trough(t * kMm), h));
      ASSERT_TRUE(cover) << cover.reason();
      const double tau = least_cover(*cover) / kMm, across = median_thickness(*cover) / kMm;
      std::printf("K1 h %.3f t %.1f: tau %+.3f  t %+.3f\n", h / kMm, t, tau - t, across - t);
      EXPECT_NEAR(tau, t, accepted(h) / kMm) << h;
      // the normal of a tube of two voxels is some 25 degrees off
      EXPECT_NEAR(across, t, accepted(h) / kMm + 0.12 * t) << h;
    }
}

// At the flank of the nerve the layer is thicker than at its crown, by a known amount.
TEST(Cover, KnowsTheBoneAtTheFlank) {
  const test::Plan plan = nerve_in_a_block();
  for (const double h : test::kVoxels) {
    const double t = 0.6 * kMm;
    const auto cover = cover_of_nerve(test::cut(plan, trough(t), h));
    ASSERT_TRUE(cover) << cover.reason();
    for (const CoverSample& one : cover->samples) {
      const double aside = std::abs(one.surface.place.y() - kNerveAt.y());
      if (aside > 0.6 * kNerveRadius) continue;
      // straight up is the longest that counts; a look through the nerve leaves it nearer to its crown
      const double up = kNerveRadius + t - std::sqrt(kNerveRadius * kNerveRadius - aside * aside);
      EXPECT_GT(one.cover, t - accepted(h)) << h << " " << aside;
      EXPECT_LT(one.cover, up + accepted(h)) << h << " " << aside;
    }
  }
}

// K15: a flat sheet whose surface lies just above the centre of a voxel. That voxel is the sample and
// stands in the surface's ramp: a ray that began there would lose a sixth of a voxel.
TEST(Cover, ARayBeginsBehindTheRampOfItsSample) {
  for (const double h : {0.4 * kMm, 0.25 * kMm})
    for (const double t : {4 * h, 5.3 * h}) {
      test::Plan plan;
      plan.lo = Vec3::Constant(-4 * kMm);
      plan.hi = Vec3::Constant(4 * kMm);
      const volume::Grid grid = phantom::box_grid(plan.lo, plan.hi, h);
      const double top = grid.world_from_grid({0, 0, 5}).z() + 0.02 * h;
      plan.bone = phantom::common(test::above(top), test::below(3.5 * kMm));
      plan.labels = {{test::below(top), test::kNerve}};
      const auto cover = cover_of_nerve(test::cut(plan, test::above(top + t), h));
      ASSERT_TRUE(cover) << cover.reason();
      for (const CoverSample& one : cover->samples) ASSERT_NEAR(one.cover, t, 0.05 * h) << h;
    }
}

// K2: a hard ball in a bowl; the layer between is as thick everywhere.
TEST(Cover, KnowsTheBoneOverABall) {
  for (const double h : test::kVoxels)
    for (const double t : {0.5, 1.0}) {
      test::Plan plan;
      plan.bone = test::below(6 * kMm);
      const Vec3 middle = {0.11 * kMm, -0.07 * kMm, -3.03 * kMm};
      plan.labels = {{phantom::ball(3 * kMm, middle), test::kHard}};
      const auto bones = test::cut(
          plan, phantom::without(test::above(-2 * kMm), phantom::ball((3 + t) * kMm, middle)), h);
      const auto cover =
          cover_of(*bones.before, *bones.after, test::voxels_of(*bones.before, test::kHard),
                   in_half_space({0, 0, -1 * kMm}, {0, 0, -1}), {.towards = {kUp}});
      ASSERT_TRUE(cover) << cover.reason();
      double sum = 0, worst = 0;
      for (const CoverSample& one : cover->samples) {
        const double off = one.thickness - t * kMm;
        sum += off;
        worst = std::max(worst, std::abs(off));
        // another look may be the shortest, aslant or through the ball; here none is much shorter
        EXPECT_LE(one.thickness, one.cover + 0.25 * h);
      }
      const double mean = sum / static_cast<double>(cover->samples.size());
      std::printf("K2 h %.3f t %.1f: mean %+.3f worst %.3f declared %.3f\n", h / kMm, t, mean / kMm,
                  worst / kMm, cover->error / kMm);
      // at the steep side a layer is looked through aslant, 30 degrees off: up to 13 % more
      EXPECT_LT(std::abs(mean), 0.4 * cover->error + 0.02 * kMm) << h;
      EXPECT_LT(worst, cover->error + 0.15 * t * kMm) << h;
    }
}

// A roof that leans by 12 degrees towards the surgeon: its normal is at 78 degrees to the way out, looks go to 50,
// so none meets it at less than 28 degrees, and a layer reads 1 / cos 28 times as thick. A threshold for
// a roof has to allow for that.
TEST(Cover, ARoofIsSeenAslant) {
  const double lean = 12 * std::numbers::pi / 180, aslant = 28 * std::numbers::pi / 180;
  const Vec3 up(std::sin(lean), 0, std::cos(lean));
  test::Plan plan;
  plan.bone = phantom::slab(up, Vec3::Zero());
  plan.labels = {{phantom::slab(-up, Vec3::Zero()), test::kNerve}};
  for (const double h : test::kVoxels)
    for (const double t : {0.7, 1.0}) {
      SCOPED_TRACE(testing::Message() << h << ", " << t);
      const auto cover = cover_of_nerve(test::cut(plan, phantom::slab(up, -t * kMm * up), h), {},
                                        {.towards = {-Vec3::UnitX()}});
      ASSERT_TRUE(cover) << cover.reason();
      std::vector<double> found;
      for (const CoverSample& one : cover->samples) found.push_back(one.cover);
      std::sort(found.begin(), found.end());
      EXPECT_NEAR(found[found.size() / 2], t * kMm / std::cos(aslant), accepted(h));
    }
}

TEST(Cover, NothingIsFoundOnAnUntouchedBone) {
  // with a cell beside the nerve: so thin a wall that the eye would count it as found
  test::Plan plan = nerve_in_a_block();
  plan.bone = phantom::without(plan.bone, phantom::ball(1.5 * kMm, {0, 0, 1.8 * kMm}));
  const auto bone = test::build(plan, plan.bone, 0.25 * kMm);
  const VoxelSet nerve = test::voxels_of(*bone, test::kNerve);
  const auto cover = cover_of(*bone, *bone, nerve, {}, {.towards = {kUp}});
  ASSERT_TRUE(cover) << cover.reason();
  for (const CoverSample& one : cover->samples) EXPECT_EQ(one.cover, kUnseen);
  const auto found = identified(*cover, {});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->mark.met);
  EXPECT_EQ(found->mark.value, 0);
  EXPECT_EQ(found->worst_cover, kUnseen);
  const auto thin = skeletonised(*cover, 0, {});
  ASSERT_TRUE(thin);
  EXPECT_FALSE(thin->even.met);
}

// Material that was added over a hole covers again.
TEST(Cover, WhatWasAddedCovers) {
  const test::Plan plan = nerve_in_a_block();
  const double h = 0.25 * kMm;
  auto bones = test::cut(plan, trough(0.2 * kMm), h);
  const phantom::Depth filled = phantom::without(
      plan.bone,
      phantom::without(trough(0.2 * kMm), test::below(kNerveAt.z() + kNerveRadius + 1.2 * kMm)));
  bones.after = test::build(plan, filled, h);
  const auto cover = cover_of_nerve(bones);
  ASSERT_TRUE(cover) << cover.reason();
  EXPECT_NEAR(least_cover(*cover), 1.2 * kMm, accepted(h));
}

// K14
TEST(Cover, WhatWasOpenFromTheStartIsNotAssessed) {
  test::Plan plan = nerve_in_a_block();
  // the nerve lies in an open groove
  const phantom::Depth groove =
      phantom::common(test::above(kNerveAt.z()), phantom::slab({1, 0, 0}, {7.5 * kMm, 0, 0}));
  plan.bone = phantom::without(plan.bone, groove);
  const auto bones = test::cut(plan, test::above(-1.5 * kMm), 0.25 * kMm);
  const auto cover = cover_of_nerve(bones);
  ASSERT_FALSE(cover);
  EXPECT_NE(cover.reason().find("open from the start"), std::string::npos) << cover.reason();

  // half of its length in the groove: that half leaves the patch, the rest counts
  test::Plan half = nerve_in_a_block();
  half.bone = phantom::without(
      half.bone, phantom::common(groove, phantom::slab({1, 0, 0}, {-1.5 * kMm, 0, 0})));
  const auto rest = cover_of_nerve(test::cut(half, trough(0.5 * kMm), 0.25 * kMm));
  ASSERT_TRUE(rest) << rest.reason();
  EXPECT_GT(rest->open_share, 0.2);
  EXPECT_LT(rest->open_share, 0.5);
  // a sample beside the end of the groove still has bone aslant, 3 mm sin 50 degrees away
  for (const CoverSample& one : rest->samples) EXPECT_GT(one.surface.place.x(), -3.9 * kMm);
}

// K13: what lies outside the grid is not judged, and too little of it is no structure
TEST(Cover, AStructureBeyondTheGridIsNotAssessed) {
  test::Plan plan = nerve_in_a_block();
  const auto bones = test::cut(plan, trough(0.5 * kMm), 0.25 * kMm);
  const auto cover = cover_of_nerve(bones);
  ASSERT_TRUE(cover);
  for (const CoverSample& one : cover->samples)
    EXPECT_LT(std::abs(one.surface.place.x()), 7 * kMm - 0.3 * kMm);
  const auto tail = cover_of_nerve(bones, in_ball(kNerveAt, 0.5 * kMm));
  ASSERT_FALSE(tail);
  EXPECT_NE(tail.reason().find("samples"), std::string::npos) << tail.reason();
  const auto none = cover_of(*bones.before, *bones.after,
                             test::voxels_of(*bones.before, test::kHard), {}, {.towards = {kUp}});
  ASSERT_FALSE(none);
  EXPECT_NE(none.reason().find("not in this bone"), std::string::npos) << none.reason();
}

// Nobody sees a nerve through a sinus, but through marrow that the case calls glass.
TEST(Cover, SoftTissueHidesUnlessItIsGlass) {
  test::Plan plan = nerve_in_a_block();
  const double crown = kNerveAt.z() + kNerveRadius;
  const phantom::Depth layer =
      phantom::common(test::above(crown + 0.5 * kMm), test::below(crown + 1.5 * kMm));
  plan.bone = phantom::without(plan.bone, layer);
  plan.labels.emplace_back(layer, test::kMarrow);
  const auto bones = test::cut(plan, trough(1.5 * kMm), 0.25 * kMm);
  const auto hidden = cover_of_nerve(bones);
  ASSERT_TRUE(hidden) << hidden.reason();
  EXPECT_NEAR(least_cover(*hidden), 1.5 * kMm, 0.2 * kMm);  // labels are whole voxels
  const auto seen = cover_of_nerve(bones, {}, {.towards = {kUp}, .glass = {test::kMarrow}});
  ASSERT_TRUE(seen) << seen.reason();
  EXPECT_NEAR(least_cover(*seen), 0.5 * kMm, 0.1 * kMm);
}

TEST(Cover, IsTheSameForAnyNumberOfThreads) {
  const auto bones = test::cut(nerve_in_a_block(), trough(0.7 * kMm), 0.25 * kMm);
  const auto one = cover_of_nerve(bones, {}, {.towards = {kUp}, .threads = 1});
  const auto three = cover_of_nerve(bones, {}, {.towards = {kUp}, .threads = 3});
  ASSERT_TRUE(one && three);
  ASSERT_EQ(one->samples.size(), three->samples.size());
  for (std::size_t n = 0; n < one->samples.size(); ++n) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(one->samples[n].cover),
              std::bit_cast<std::uint64_t>(three->samples[n].cover));
    EXPECT_EQ(one->samples[n].look, three->samples[n].look);
  }
}

// What is known of whole bricks (air, not cut, without the structure) changes no number: at random
// points it is what the fields and the labels say there.
TEST(Cover, SolidityIsThatOfFieldsAndLabels) {
  const std::uint64_t seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Plan plan = nerve_in_a_block();
  plan.labels.emplace_back(phantom::ball(2 * kMm, {3 * kMm, 3 * kMm, 1 * kMm}), test::kHard);
  const auto bones = test::cut(plan, phantom::ball(3.5 * kMm, {0.5 * kMm, 0, 3 * kMm}), 0.25 * kMm);
  const VoxelSet hard = test::voxels_of(*bones.before, test::kHard);
  const Solidity plain = Solidity::of_bone(*bones.before, *bones.after);
  const Solidity seeing(*bones.before, *bones.after, &hard, {});
  std::mt19937_64 random(seed);
  const math::Ijk size = bones.before->grid().size;
  std::size_t cut = 0, other = 0;
  for (int n = 0; n < 200000; ++n) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = std::uniform_real_distribution<double>(-2, size[a] + 1)(random);
    const Solidity::Pair is = plain.at(p);
    ASSERT_EQ(is.before, plain.before(p)) << p.transpose();
    ASSERT_EQ(is.after, plain.after(p)) << p.transpose();
    cut += is.before == is.after ? 0 : 1;
    // without a voxel of the structure around it, a point has the same solidity; labels of soft tissue
    // hide
    const math::Ijk v = p.array().round().matrix().cast<int>(),
                    low = p.array().floor().matrix().cast<int>();
    bool near = false;
    for (int c = 0; c < 8; ++c)
      near = near || hard.has(low + math::Ijk(c & 1, (c >> 1) & 1, c >> 2));
    if (near) {
      other += seeing.at(p).after == is.after ? 0 : 1;
    } else if (bones.before->tissue(v.x(), v.y(), v.z()) == test::kNerve) {
      ASSERT_EQ(seeing.at(p).after, 1);
    } else {
      ASSERT_EQ(seeing.at(p).before, is.before) << p.transpose();
      ASSERT_EQ(seeing.at(p).after, is.after) << p.transpose();
    }
  }
  EXPECT_GT(cut, 1000U);
  EXPECT_GT(other, 100U);
}

// K12: a label painted into air has no bone over it: it is not found there
TEST(Cover, ALabelInAirIsNotFound) {
  test::Plan plan = nerve_in_a_block();
  const phantom::Depth hole =
      phantom::capsule({-4 * kMm, 0, 5 * kMm}, {4 * kMm, 0, 5 * kMm}, 2 * kMm);
  plan.bone = phantom::without(test::below(5 * kMm), hole);
  plan.labels = {{hole, test::kNerve}};
  const auto bones = test::cut(plan, test::above(2 * kMm), 0.25 * kMm);
  const auto cover = cover_of_nerve(bones);
  EXPECT_FALSE(cover);
}

}  // namespace
}  // namespace burr::metrics
