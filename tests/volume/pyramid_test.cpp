#include "burr/volume/pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "burr/phantom/build.h"
#include "burr/volume/sample.h"
#include "support/rt_guard.h"

namespace burr::volume {
namespace {

using math::Aabb;
using math::Vec3;

std::unique_ptr<Bone> some_bone(const math::Ijk& size) {
  Grid grid;
  grid.size = size;
  grid.voxel = 1;
  const phantom::Depth shape =
      phantom::either(phantom::ball(7, {14, 20, 15}), phantom::plate(2.5, {1, 2, 3}, {30, 20, 20}));
  return phantom::bone_from_distance(grid, {}, shape, 50);
}

Aabb some_box(std::mt19937_64& random, double lo, double hi, double longest) {
  std::uniform_real_distribution<double> where(lo, hi), extent(0, longest);
  Aabb box;
  for (int a = 0; a < 3; ++a) {
    box.lo[a] = where(random);
    box.hi[a] = box.lo[a] + extent(random);
  }
  return box;
}

struct Seen {
  bool air = false, bone = false, material = false;
};

// Voxels lo .. hi, one by one.
Seen look(const Bone& bone, const math::Ijk& lo, const math::Ijk& hi) {
  Seen seen;
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j)
      for (int i = lo.x(); i <= hi.x(); ++i) {
        const Field field = bone.field(i, j, k);
        (field >= kIso ? seen.bone : seen.air) = true;
        seen.material = seen.material || field > 0;
      }
  return seen;
}

void compare_with_every_voxel(const Bone& bone, const Pyramid& pyramid, std::mt19937_64& random,
                              int boxes) {
  int yes = 0;
  for (int n = 0; n < boxes; ++n) {
    const Aabb box = some_box(random, -6, 54, n % 2 == 0 ? 3 : 25);
    const math::Ijk lo = box.lo.array().floor().cast<int>(),
                    hi = box.hi.array().floor().cast<int>() + 1;
    const Seen cells = look(bone, lo, hi);
    // the same for the box widened to whole bricks of the grid
    math::Ijk first = lo, last = hi;
    bool meets = true;
    for (int a = 0; a < 3; ++a) {
      const int end = bone.grid().size[a];
      meets = meets && hi[a] >= 0 && lo[a] < end;
      first[a] = std::min(lo[a], std::max(lo[a], 0) / 8 * 8);
      last[a] = std::max(hi[a], std::min(hi[a], end - 1) / 8 * 8 + 7);
    }
    const Seen bricks = meets ? look(bone, first, last) : Seen{true, false, false};
    if (cells.air && cells.bone) {
      ASSERT_TRUE(pyramid.surface_in(box)) << "missed a surface";
    }
    ASSERT_EQ(pyramid.surface_in(box), bricks.air && bricks.bone);
    ASSERT_EQ(pyramid.material_in(box), bricks.material);
    yes += pyramid.surface_in(box) ? 1 : 0;
  }
  EXPECT_GT(yes, boxes / 10);
  EXPECT_LT(yes, boxes - boxes / 10);
}

TEST(Pyramid, SaysWhatEveryVoxelSays) {
  const std::uint64_t seed = 31;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  for (const math::Ijk& size : {math::Ijk(48, 48, 48), math::Ijk(45, 33, 41)}) {
    const auto bone = some_bone(size);
    const Pyramid pyramid(*bone);
    compare_with_every_voxel(*bone, pyramid, random, 1500);
  }
}

TEST(Pyramid, FollowsEveryWrite) {
  const std::uint64_t seed = 32;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  const auto bone = some_bone({48, 48, 48});
  Pyramid pyramid(*bone);
  for (int round = 0; round < 20; ++round) {
    for (int n = 0; n < 12; ++n) {
      const auto brick = static_cast<BrickIndex>(random() % 216);
      if (bone->ensure_slot(brick) == kNoSlot) continue;
      BrickField content{};
      const bool cut = random() % 2 == 0;
      for (Field& voxel : content.voxel) voxel = cut ? Field{0} : static_cast<Field>(random());
      bone->write_brick(brick, content);
      pyramid.update(brick);
    }
    compare_with_every_voxel(*bone, pyramid, random, 100);
  }
}

// Compared with small steps along the ray: the crossing lies between the last step in air and the
// first in bone.
TEST(Pyramid, FirstHitIsTheFirstCrossingOfTheTrilinearField) {
  const std::uint64_t seed = 33;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  const auto bone = some_bone({45, 33, 41});
  const Pyramid pyramid(*bone);
  std::uniform_real_distribution<double> where(-10, 55);
  int hits = 0;
  for (int n = 0; n < 1500; ++n) {
    const Vec3 from(where(random), where(random), where(random));
    Vec3 way = Vec3(where(random), where(random), where(random)) - from;
    if (n % 5 == 0) way[n / 5 % 3] = 0;
    if (n % 7 == 0) way = Vec3::Unit(n % 3) * (n % 2 == 0 ? 1 : -1);
    way.normalize();
    const auto hit = pyramid.first_hit(from, way, 60);
    constexpr double kStep = 0.01;
    double walked = 0;
    while (walked <= 60 && sample(*bone, from + walked * way) < kIsoShare) walked += kStep;
    if (!hit) {
      ASSERT_GT(walked, 60) << "missed";
      continue;
    }
    ++hits;
    if (*hit > 0) {
      ASSERT_NEAR(sample(*bone, from + *hit * way), kIsoShare, 1e-6);
    }
    ASSERT_LE(*hit, walked + 1e-9);
    // the steps may miss a contact shorter than a step; the pyramid never does
    if (walked - *hit > 2 * kStep) {
      ASSERT_GE(sample(*bone, from + (*hit + 1e-7) * way), kIsoShare - 1e-7);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST(Pyramid, AKnownHitAndAFreeWay) {
  const auto bone = phantom::bone_from_distance(phantom::cube_grid(64e-3, 64), {},
                                                phantom::slab({0, 0, 1}, {0, 0, 5.25e-3}));
  const Pyramid pyramid(*bone);
  const Vec3 above = bone->grid().grid_from_world({1e-3, 2e-3, 30e-3});
  const auto hit = pyramid.first_hit(above, -Vec3::UnitZ(), 100);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(*hit, 24.75, 1e-4);
  EXPECT_FALSE(pyramid.first_hit(above, Vec3::UnitZ(), 100).has_value());
  EXPECT_FALSE(pyramid.first_hit(above, -Vec3::UnitZ(), 24.7).has_value()) << "too short";
  EXPECT_EQ(pyramid.first_hit(above - 30 * Vec3::UnitZ(), Vec3::UnitX(), 1).value_or(-1), 0)
      << "begins in bone";
  EXPECT_FALSE(pyramid.first_hit(above, Vec3::Constant(std::nan("")), 100).has_value());
}

TEST(Pyramid, TouchesNoHeapAfterBuilding) {
  const auto bone = some_bone({48, 48, 48});
  Pyramid pyramid(*bone);
  BrickField content{};
  ASSERT_NE(bone->ensure_slot(7), kNoSlot);
  const test::RtGuard guard;
  bone->write_brick(7, content);
  pyramid.update(7);
  const bool any =
      pyramid.surface_in({Vec3::Constant(3), Vec3::Constant(30)}) ||
      pyramid.material_in({Vec3::Constant(3), Vec3::Constant(30)}) ||
      pyramid.first_hit(Vec3::Constant(-5), Vec3(1, 1, 1).normalized(), 80).has_value();
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace burr::volume
