#include "burr/math/pose.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "burr/math/aabb.h"

namespace burr::math {
namespace {

Pose random_pose(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Pose pose;
  pose.p = Vec3(normal(random), normal(random), normal(random));
  pose.q = Quat(normal(random), normal(random), normal(random), normal(random));
  pose.q.normalize();
  return pose;
}

TEST(Pose, TurnsThenMoves) {
  Pose world_from_tool;
  world_from_tool.p = {1, 2, 3};
  world_from_tool.q = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
  const Vec3 p = world_from_tool * Vec3(1, 0, 0);
  EXPECT_NEAR((p - Vec3(1, 3, 3)).norm(), 0, 1e-15);
}

TEST(Pose, LettersMeetWhenMultiplied) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 1000; ++i) {
    const Pose a_from_b = random_pose(random), b_from_c = random_pose(random);
    const Vec3 p_c = random_pose(random).p;
    const Vec3 p_a = a_from_b * (b_from_c * p_c);
    EXPECT_NEAR(((a_from_b * b_from_c) * p_c - p_a).norm(), 0, 1e-12);
    EXPECT_NEAR((a_from_b.inverse() * (a_from_b * p_c) - p_c).norm(), 0, 1e-12);
    const Pose same = a_from_b * a_from_b.inverse();
    EXPECT_NEAR(same.p.norm(), 0, 1e-12);
    EXPECT_NEAR(same.q.angularDistance(Quat::Identity()), 0, 1e-7);
  }
}

TEST(Pose, KnowsWhenItIsNoNumber) {
  Pose pose;
  EXPECT_TRUE(pose.finite());
  pose.p.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pose.finite());
  pose = {};
  pose.q.w() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(pose.finite());
}

TEST(Aabb, GrowsAroundPoints) {
  Aabb box;
  EXPECT_TRUE(box.empty());
  box.extend({1, 2, 3});
  EXPECT_FALSE(box.empty()) << "one point is a box";
  box.extend({-1, 5, 3});
  EXPECT_EQ(box.lo, Vec3(-1, 2, 3));
  EXPECT_EQ(box.hi, Vec3(1, 5, 3));
  EXPECT_EQ(box.centre(), Vec3(0, 3.5, 3));
  EXPECT_EQ(box.extent(), Vec3(2, 3, 0));
  EXPECT_EQ(box.inflated(1).lo, Vec3(-2, 1, 2));
  EXPECT_TRUE(box.inflated(-1).empty()) << "a box thinner than it is shrunk is gone";
}

}  // namespace
}  // namespace burr::math
