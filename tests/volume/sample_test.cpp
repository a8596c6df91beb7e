#include "burr/volume/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "burr/phantom/build.h"
#include "support/rt_guard.h"

namespace burr::volume {
namespace {

using math::Vec3;

std::unique_ptr<Bone> noisy_bone(const math::Ijk& size, std::uint64_t seed) {
  Grid grid;
  grid.size = size;
  std::mt19937_64 random(seed);
  std::vector<Field> field(static_cast<std::size_t>(size.prod()));
  for (Field& voxel : field) voxel = static_cast<Field>(random());
  return bone_from_arrays(grid, {}, field, {}, {}, 0);
}

// The definition itself: weights of the eight voxels.
double by_weights(const Bone& bone, const Vec3& p) {
  double sum = 0;
  const int i = static_cast<int>(std::floor(p.x())), j = static_cast<int>(std::floor(p.y())),
            k = static_cast<int>(std::floor(p.z()));
  for (int z = k; z <= k + 1; ++z)
    for (int y = j; y <= j + 1; ++y)
      for (int x = i; x <= i + 1; ++x)
        sum += (1 - std::abs(p.x() - x)) * (1 - std::abs(p.y() - y)) * (1 - std::abs(p.z() - z)) *
               bone.field(x, y, z) / 65536.0;
  return sum;
}

TEST(Sample, IsTheWeightedMeanOfEightVoxelsAcrossBricksAndBorders) {
  const std::uint64_t seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  const auto bone = noisy_bone({19, 24, 13}, seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-3, 27);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p(u(random), u(random), u(random));
    ASSERT_NEAR(sample(*bone, p), by_weights(*bone, p), 1e-12) << p.transpose();
  }
  EXPECT_EQ(sample(*bone, Vec3(3, 4, 5)), bone->field(3, 4, 5) / 65536.0);
  EXPECT_EQ(sample(*bone, Vec3::Constant(1e300)), 0);
  EXPECT_EQ(sample(*bone, Vec3(1, std::nan(""), 1)), 0);
}

TEST(Sample, SlopeIsTheBlendOfCentralDifferences) {
  const std::uint64_t seed = 6;
  SCOPED_TRACE("seed " + std::to_string(seed));
  const auto bone = noisy_bone({19, 24, 13}, seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-3, 27);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p(u(random), u(random), u(random));
    // interpolated central differences equal the central difference of the interpolation
    Vec3 expected;
    for (int a = 0; a < 3; ++a)
      expected[a] =
          0.5 * (by_weights(*bone, p + Vec3::Unit(a)) - by_weights(*bone, p - Vec3::Unit(a)));
    ASSERT_LT((gradient(*bone, p) - expected).norm(), 1e-12) << p.transpose();
  }
}

TEST(Sample, KnowsDepthAndNormalOfATurnedSlab) {
  const std::uint64_t seed = 8;
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Vec3 outward = Vec3(1, -2, 2).normalized();
  Grid grid = phantom::cube_grid(30e-3, 60);
  grid.frame.q = math::Quat(Eigen::AngleAxisd(0.5, Vec3(0, 1, 1).normalized()));
  grid.frame.p = grid.frame.q * grid.frame.p;
  const phantom::Depth slab = phantom::slab(outward);
  const auto bone = phantom::bone_from_distance(grid, {}, slab);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-5e-3, 5e-3), height(-0.05e-3, 0.05e-3);
  for (int n = 0; n < 2000; ++n) {
    Vec3 p(u(random), u(random), u(random));
    p += (height(random) - outward.dot(p)) * outward;
    // a plane is linear, and so is the interpolation: only rounding to 16 bits remains
    ASSERT_NEAR(depth_at(*bone, p), slab(p), 1e-4 * grid.voxel);
    ASSERT_LT((normal(*bone, grid.grid_from_world(p)) - outward).norm(), 5e-3);
  }
  EXPECT_EQ(normal(*bone, Vec3::Constant(-50)), Vec3::Zero()) << "nothing about";
}

TEST(Sample, TouchesNoHeap) {
  const auto bone = noisy_bone({19, 24, 13}, 1);
  const test::RtGuard guard;
  double sum = 0;
  for (double x = -2; x < 26; x += 0.37) {
    sum += sample(*bone, Vec3(x, x, x / 2));
    sum += normal(*bone, Vec3(x, x, x / 2)).sum();
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace burr::volume
