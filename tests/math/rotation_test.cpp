#include "burr/math/rotation.h"

#include <gtest/gtest.h>

#include <random>

namespace burr::math {
namespace {

TEST(ShortestTurn, TakesOneDirectionToTheOtherAboutTheAxisAcross) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from = any(), to = any();
    const Quat turn = shortest_rotation(from, to);
    EXPECT_NEAR(turn.norm(), 1, 1e-12);
    EXPECT_NEAR((turn * from.normalized() - to.normalized()).norm(), 0, 1e-10);
    // the rotation is no larger than the angle between them
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    EXPECT_NEAR(2 * std::atan2(turn.vec().norm(), turn.w()), angle, 1e-7);
  }
}

TEST(ShortestTurn, OfNearlyOppositeDirectionsIsStillARotation) {
  for (const double short_of : {0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {  // less than half a turn [rad]
    const Vec3 from(0.3, -0.4, 1.2);
    const Vec3 across = from.unitOrthogonal();
    const Vec3 to =
        from.norm() * (std::sin(short_of) * across - std::cos(short_of) * from.normalized());
    const Quat turn = shortest_rotation(from, to);
    EXPECT_NEAR(turn.norm(), 1, 1e-14) << short_of;
    EXPECT_NEAR((turn * from - to).norm(), 0, 1e-14 / short_of + 1e-14) << short_of;
  }
}

TEST(ShortestTurn, OfTheSameDirectionIsNone) {
  EXPECT_EQ(shortest_rotation({0, 0, 2}, {0, 0, 5}).coeffs(), Quat::Identity().coeffs());
}

TEST(ShortestTurn, OfOppositeDirectionsIsHalfATurn) {
  for (const Vec3& from : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-2, 3, 0.5)}) {
    const Quat turn = shortest_rotation(from, -from);
    EXPECT_NEAR(turn.norm(), 1, 1e-12);
    EXPECT_NEAR((turn * from + from).norm(), 0, 1e-12);
  }
}

}  // namespace
}  // namespace burr::math
