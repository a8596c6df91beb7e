// The thickness of bone along a line: plates and balls with known answers, also while the bone is
// cut.
#include "burr/volume/thickness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"

namespace burr::volume {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;

std::unique_ptr<Bone> bone_of(const phantom::Depth& depth) {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), kVoxel), {}, depth);
}

TEST(Thickness, OfAPlateIsThePlatesStraightAndSlanted) {
  for (const double thick : {1.3 * kMm, 4 * kMm}) {
    const Vec3 normal = Vec3(1, 2, 3).normalized();
    const auto bone = bone_of(phantom::plate(thick, normal, {0.2 * kMm, 0, -0.1 * kMm}));
    const Vec3 from = 5 * kMm * normal;
    const auto straight = thickness(*bone, from, -normal, 6 * kMm);
    ASSERT_TRUE(straight);
    EXPECT_NEAR(straight->length(), thick, 0.05 * kVoxel);
    EXPECT_NEAR((straight->in - Vec3(0.2 * kMm, 0, -0.1 * kMm)).dot(normal), thick / 2,
                0.05 * kVoxel);
    const Vec3 slanted = (-normal + 0.3 * normal.unitOrthogonal()).normalized();
    const auto aslant = thickness(*bone, from, slanted, 6 * kMm);
    ASSERT_TRUE(aslant);
    EXPECT_NEAR(aslant->length(), thick / -slanted.dot(normal), 0.05 * kVoxel);
  }
}

TEST(Thickness, OfABallIsTheChord) {
  const double r = 5 * kMm;
  const auto bone = bone_of(phantom::ball(r));
  for (const double aside : {0.0, 1.1 * kMm, 3 * kMm}) {
    const auto chord = thickness(*bone, {aside, 0.07 * kMm, 7 * kMm}, {0, 0, -1}, 5 * kMm);
    ASSERT_TRUE(chord);
    EXPECT_NEAR(chord->length(), 2 * std::sqrt(r * r - aside * aside - 0.0049 * kMm * kMm),
                0.1 * kVoxel);
  }
}

TEST(Thickness, EndsAtTheNextAirAndAtTheEdgeOfTheGrid) {
  // a hollow ball: the wall is measured, not the whole ball
  const auto hollow =
      bone_of([](const Vec3& p) { return std::min(6 * kMm - p.norm(), p.norm() - 4 * kMm); });
  const auto wall = thickness(*hollow, {0, 0, 7 * kMm}, {0, 0, -1}, 3 * kMm);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->length(), 2 * kMm, 0.1 * kVoxel);
  // bone that continues beyond the grid ends half-way to the first voxel outside
  const auto slab = bone_of(phantom::slab());
  const auto all = thickness(*slab, {0, 0, 1 * kMm}, {0, 0, -1}, 3 * kMm);
  ASSERT_TRUE(all);
  EXPECT_NEAR(all->length(), 8 * kMm, kVoxel);
}

TEST(Thickness, IsNothingWhereNoBoneIsNearOrNoNumberIsGiven) {
  const auto bone = bone_of(phantom::ball(5 * kMm));
  EXPECT_FALSE(thickness(*bone, {0, 0, 7 * kMm}, {0, 0, 1}, 5 * kMm)) << "away from it";
  EXPECT_FALSE(thickness(*bone, {0, 0, 7 * kMm}, {0, 0, -1}, 1 * kMm)) << "too far";
  EXPECT_FALSE(thickness(*bone, {0, 0, 7 * kMm}, {0, 0, 0}, 5 * kMm));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(thickness(*bone, {nan, 0, 0}, {0, 0, -1}, 5 * kMm));
  EXPECT_FALSE(thickness(*bone, {0, 0, 7 * kMm}, {0, nan, -1}, 5 * kMm));
  EXPECT_FALSE(thickness(*bone, {0, 0, 7 * kMm}, {0, 0, -1}, nan));
}

}  // namespace
}  // namespace burr::volume
