#include "burr/phantom/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace burr::phantom {
namespace {

constexpr double kMm = 1e-3;

struct Named {
  std::string name;
  Depth depth;
  bool exact_inside = true;
};

std::vector<Named> exact_shapes() {
  Pose turned;
  turned.p = {1 * kMm, -2 * kMm, 0.5 * kMm};
  turned.q = math::Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  return {{"slab", slab({1, 2, -0.5}, {0, 0, 1 * kMm})},
          {"ball", ball(6 * kMm, {1 * kMm, 0, 0})},
          {"bowl", bowl(6 * kMm)},
          {"box", box({6 * kMm, 4 * kMm, 3 * kMm})},
          {"turned box", placed(box({6 * kMm, 4 * kMm, 3 * kMm}), turned)},
          {"cylinder", cylinder(4 * kMm, 5 * kMm)},
          {"capsule", capsule({-3 * kMm, 0, 0}, {3 * kMm, 2 * kMm, 1 * kMm}, 2 * kMm)},
          {"groove of 90 degrees", groove(std::numbers::pi / 4)},
          {"narrow groove", groove(0.3)},
          {"wedge", wedge(0.6)},
          {"torus", torus(6 * kMm, 2 * kMm)},
          {"plate", plate(0.4 * kMm, {1, -1, 2}, {0.3 * kMm, 0, 0})},
          {"two balls", two_balls(5 * kMm, 3.5 * kMm), false}};
}

Vec3 anywhere(std::mt19937_64& random, double half) {
  std::uniform_real_distribution<double> u(-half, half);
  const double x = u(random), y = u(random);
  return {x, y, u(random)};
}

Vec3 slope(const Depth& depth, const Vec3& p) {
  constexpr double e = 1e-8;
  Vec3 g;
  for (int a = 0; a < 3; ++a)
    g[a] = (depth(p + e * Vec3::Unit(a)) - depth(p - e * Vec3::Unit(a))) / (2 * e);
  return g;
}

// A function is the distance if its slope has length one, it never changes by more than the
// distance, and it is zero at the foot point that its slope points to.
TEST(Shapes, DepthIsTheExactDistanceToTheSurface) {
  const std::uint64_t seed = 2024;
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (const Named& shape : exact_shapes()) {
    SCOPED_TRACE(shape.name);
    std::mt19937_64 random(seed);
    int on_creases = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = anywhere(random, 10 * kMm), q = anywhere(random, 10 * kMm);
      const double depth = shape.depth(p);
      ASSERT_LE(std::abs(depth - shape.depth(q)), (p - q).norm() * (1 + 1e-12) + 1e-15);
      if (!shape.exact_inside && depth > 0) continue;
      const Vec3 g = slope(shape.depth, p);
      if (std::abs(g.norm() - 1) > 1e-4) {  // two foot points are equally near: no slope
        ++on_creases;
        continue;
      }
      ASSERT_NEAR(shape.depth(p - depth * g.normalized()), 0, 2e-8) << p.transpose();
    }
    EXPECT_LT(on_creases, 40);
  }
}

TEST(Shapes, AnswersKnownByHeart) {
  EXPECT_DOUBLE_EQ(slab()({5, 7, -2}), 2);
  EXPECT_DOUBLE_EQ(ball(3)({0, 4, 0}), -1);
  EXPECT_DOUBLE_EQ(bowl(3)({0, 1, 0}), -2);
  EXPECT_DOUBLE_EQ(box({1, 2, 3})({0, 0, 0}), 1);
  EXPECT_DOUBLE_EQ(box({1, 2, 3})({4, 6, 3}), -5) << "edge";
  EXPECT_DOUBLE_EQ(box({1, 2, 3})({2, 4, 5}), -3) << "corner";
  EXPECT_NEAR(groove(std::numbers::pi / 4)({0, 0, 1}), -std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(groove(std::numbers::pi / 4)({0, 9, -1}), 1, 1e-15) << "below the tip";
  EXPECT_NEAR(torus(3, 1)({3, 0, 0}), 1, 1e-15);
  EXPECT_NEAR(torus(3, 1)({0, 0, 0}), -2, 1e-15);
  EXPECT_DOUBLE_EQ(plate(2, {0, 1, 0}, {0, 5, 0})({9, 5, 9}), 1);
  EXPECT_DOUBLE_EQ(cylinder(2, 3)({0, 0, 5}), -2);
  EXPECT_DOUBLE_EQ(without(ball(3), ball(1))({0, 0, 0}), -1);
  EXPECT_DOUBLE_EQ(common(slab(), slab({1, 0, 0}))({-2, 0, -1}), 1);
}

TEST(Shapes, AGyroidHoldsItsShareOfBoneAndItsSlope) {
  const std::uint64_t seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (const double fill : {0.25, 0.5, 0.7}) {
    const Depth bone = gyroid(2 * kMm, fill);
    std::mt19937_64 random(seed);
    int solid = 0;
    constexpr int kPoints = 40000;
    for (int n = 0; n < kPoints; ++n) {
      const Vec3 p = anywhere(random, 10 * kMm), q = p + anywhere(random, 0.2 * kMm);
      const double depth = bone(p);
      solid += depth > 0 ? 1 : 0;
      ASSERT_LE(std::abs(depth - bone(q)), kGyroidSteepness * (p - q).norm());
      if (std::abs(depth) < 0.02 * kMm) {
        EXPECT_NEAR(slope(bone, p).norm(), 1, 0.15) << "near the surface";
      }
    }
    EXPECT_NEAR(static_cast<double>(solid) / kPoints, fill, 0.01);
  }
}

}  // namespace
}  // namespace burr::phantom
