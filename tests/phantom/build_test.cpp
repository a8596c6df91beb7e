#include "burr/phantom/build.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "burr/volume/volume_of.h"

namespace burr::phantom {
namespace {

constexpr double kMm = 1e-3;
constexpr double kPi = std::numbers::pi;

TEST(Build, EveryVoxelIsWhatTheFormulaSaysSkippedOrNot) {
  volume::Grid grid = cube_grid(20 * kMm, 83, {1 * kMm, 0, 2 * kMm});
  grid.frame.q = math::Quat(Eigen::AngleAxisd(0.4, Vec3(1, 1, 0).normalized()));
  const Depth shape = either(torus(6 * kMm, 2.5 * kMm), ball(3 * kMm, {5 * kMm, 5 * kMm, 9 * kMm}));
  const auto bone = bone_from_distance(grid, {}, shape);
  for (int k = 0; k < 83; ++k)
    for (int j = 0; j < 83; ++j)
      for (int i = 0; i < 83; ++i) {
        const Vec3 p = grid.world_from_grid(math::Ijk(i, j, k).cast<double>());
        const volume::Field field = volume::field_from_depth(shape(p) / grid.voxel);
        ASSERT_EQ(bone->field(i, j, k), field) << i << ' ' << j << ' ' << k;
        ASSERT_EQ(bone->tissue(i, j, k), field != 0 ? 1 : 0);
      }
}

// A brick reaches beyond a grid whose size is not a multiple of eight; the voxels there must be
// air.
TEST(Build, WhatLiesOutsideTheGridIsAir) {
  const volume::Grid grid = box_grid(Vec3::Constant(-1.5 * kMm), Vec3(1.5, 1.5, 9.5) * kMm, kMm);
  const auto bone = bone_from_distance(grid, {}, box(Vec3::Constant(1)));  // a metre: solid
  for (volume::BrickIndex brick = 0; brick < bone->brick_count(); ++brick) {
    const math::Ijk first = bone->brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const math::Ijk at = first + math::Ijk(v % 8, v / 8 % 8, v / 64);
      const bool inside = (at.array() < grid.size.array()).all();
      ASSERT_EQ(bone->brick_field(brick)[v], inside ? volume::kSolid : 0) << v;
      ASSERT_EQ(bone->brick_tissue(brick)[v], inside ? 1 : 0) << v;
    }
  }
}

TEST(Build, TheNumberOfThreadsDoesNotMatter) {
  const Depth shape = gyroid(4 * kMm);
  const volume::Grid grid = cube_grid(16 * kMm, 70);
  const auto one = bone_from_distance(grid, {}, shape, 0, 1, kGyroidSteepness);
  const auto three = bone_from_distance(grid, {}, shape, 0, 3, kGyroidSteepness);
  EXPECT_EQ(one->content_hash(), three->content_hash());
  EXPECT_EQ(one->used_slots(), three->used_slots());
}

TEST(Build, OnlyBricksThatHoldSomethingTakeRoom) {
  const auto bone = bone_from_distance(cube_grid(64 * kMm, 64), {}, ball(4 * kMm), 10);
  EXPECT_EQ(bone->used_slots(), 8U) << "a ball of 4 voxels in the middle of 8 bricks";
  EXPECT_EQ(bone->free_slots(), 10U);
}

TEST(Build, SoftTissueIsKeptWhereThereIsNoBone) {
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "nerve", .kind = volume::TissueKind::soft});
  Formula formula;
  formula.depth = without(ball(8 * kMm), ball(3 * kMm));
  formula.soft = ball(2 * kMm);
  formula.tissue = [&](const Vec3& p, double) {
    return p.norm() < 2 * kMm ? volume::TissueId{2} : volume::TissueId{1};
  };
  NoProgress nobody;
  auto bone = bone_from_formula(cube_grid(64 * kMm, 192), tissues, formula, 0, 2, nobody);
  ASSERT_TRUE(bone.ok());
  const math::Ijk middle(96, 96, 96);
  EXPECT_EQ((*bone)->field(96, 96, 96), 0);
  EXPECT_EQ((*bone)->tissue(96, 96, 96), 2);
  EXPECT_EQ((*bone)->tissue(96 + 15, 96, 96), 1);
  EXPECT_EQ((*bone)->field(96 + 15, 96, 96), volume::kSolid);
}

class Impatient final : public Progress {
 public:
  void report(double, std::string_view) override {}
  [[nodiscard]] bool cancelled() const override { return true; }
};

TEST(Build, CanBeStopped) {
  Impatient user;
  Formula formula;
  formula.depth = ball(8 * kMm);
  const auto bone = bone_from_formula(cube_grid(20 * kMm, 64), {}, formula, 0, 2, user);
  ASSERT_FALSE(bone.ok());
  EXPECT_EQ(bone.error().trouble, Trouble::interrupted);
}

TEST(Build, ACubeGridIsCentredAndFilled) {
  const volume::Grid grid = cube_grid(10 * kMm, 20, {1 * kMm, 2 * kMm, 3 * kMm});
  EXPECT_DOUBLE_EQ(grid.voxel, 0.5 * kMm);
  const Vec3 middle = grid.world_from_grid(Vec3::Constant(9.5));
  EXPECT_LT((middle - Vec3(1 * kMm, 2 * kMm, 3 * kMm)).norm(), 1e-15);
  const volume::Grid box = box_grid({-1 * kMm, 0, 0}, {1 * kMm, 3 * kMm, 0.7 * kMm}, 0.5 * kMm);
  EXPECT_EQ(box.size, math::Ijk(4, 6, 2));
  EXPECT_LT((box.world_from_grid(Vec3(1.5, 2.5, 0.5)) - Vec3(0, 1.5 * kMm, 0.35 * kMm)).norm(),
            1e-15);
}

// ---- the field holds the formula's volume: balls of R >= 3 h and plates of t >= 2 h within 1 %

TEST(FieldToVolume, OfBalls) {
  const std::uint64_t seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  for (const double radius : {3.0, 3.1, 3.2, 3.3, 3.5, 4.0, 6.0, 10.0, 20.0}) {  // [voxel]
    for (int n = 0; n < 20; ++n) {
      const Vec3 centre = Vec3(u(random), u(random), u(random)) * kMm;
      const auto bone = bone_from_distance(cube_grid(50 * kMm, 50), {}, ball(radius * kMm, centre));
      const double truth = 4.0 / 3.0 * kPi * std::pow(radius * kMm, 3);
      EXPECT_NEAR(volume::volume_of(*bone) / truth, 1, 0.008) << "R = " << radius << " h";
    }
  }
}

// Share of a plate's true volume that the field holds, weighted by a window that falls smoothly to
// zero, so that its edge does not matter; in voxels.
double share_of_plate(double thickness, const Vec3& normal, double offset) {
  constexpr double kWindow = 20;
  const auto bone = bone_from_distance(cube_grid(48 * kMm, 48), {},
                                       plate(thickness * kMm, normal, offset * kMm * normal));
  double found = 0, truth = 0;
  for (int k = 3; k < 45; ++k)
    for (int j = 3; j < 45; ++j)
      for (int i = 3; i < 45; ++i) {
        const Vec3 p = math::Ijk(i, j, k).cast<double>() - Vec3::Constant(23.5);
        const double inside = 1 - p.squaredNorm() / (kWindow * kWindow);
        if (inside <= 0) continue;
        found += inside * inside * inside * volume::volume_units(bone->field(i, j, k)) /
                 static_cast<double>(volume::kVoxelUnits);
      }
  // the window's integral over a disc at this height is pi/4 W^2 (1 - height^2/W^2)^4
  constexpr int kSteps = 500;
  for (int s = 0; s < kSteps; ++s) {
    const double height = offset + thickness * ((s + 0.5) / kSteps - 0.5);
    const double inside = 1 - height * height / (kWindow * kWindow);
    truth += kPi / 4 * std::pow(inside, 4) * kWindow * kWindow * thickness / kSteps;
  }
  return found / truth;
}

TEST(FieldToVolume, OfPlates) {
  const std::uint64_t seed = 12;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  for (const double thickness : {2.0, 2.1, 2.3, 2.6, 3.0, 5.0})  // [voxel]
    for (int n = 0; n < 15; ++n) {
      const Vec3 any(gauss(random), gauss(random), gauss(random));
      const Vec3 normal = n < 6 ? Vec3(Vec3::Unit(n % 3)) : Vec3(any.normalized());
      EXPECT_NEAR(share_of_plate(thickness, normal, u(random)), 1, 0.01)
          << "t = " << thickness << " h, normal " << normal.transpose();
    }
}

// Along a diagonal of the grid all voxels of a layer have the same error: the worst case.
TEST(FieldToVolume, OfPlatesAlongTheDiagonals) {
  const std::uint64_t seed = 13;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  for (const double thickness : {2.0, 2.1, 2.3, 2.6, 3.0})
    for (const Vec3& normal : {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(2, 1, 0), Vec3(2, 1, 1)})
      for (int n = 0; n < 6; ++n)
        EXPECT_NEAR(share_of_plate(thickness, normal.normalized(), u(random)), 1, 0.014)
            << "t = " << thickness << " h, normal " << normal.transpose();
}

TEST(FieldToVolume, FullIsFullAndEmptyIsEmpty) {
  EXPECT_EQ(volume::volume_units(0), 0);
  EXPECT_EQ(volume::volume_units(volume::kIso), volume::kVoxelUnits / 2);
  EXPECT_EQ(volume::volume_units(volume::kSolid), volume::kVoxelUnits);
  for (int field = 0; field < 65536; ++field) {
    ASSERT_GE(volume::volume_units(field), -0.07 * volume::kVoxelUnits);
    ASSERT_LE(volume::volume_units(field), 1.07 * volume::kVoxelUnits);
  }
}

}  // namespace
}  // namespace burr::phantom
