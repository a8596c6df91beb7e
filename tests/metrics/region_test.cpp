// Regions: membership against its definition at random points, and the distance to the border where
// the header says that it is exact.
#include "burr/metrics/region.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "burr/metrics/tube_course.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;

std::uint64_t seed_of_test() {
  const char* given = std::getenv("BURR_SEED");
  return given == nullptr ? 20261126 : std::strtoull(given, nullptr, 10);
}

class RegionTest : public ::testing::Test {
 protected:
  Vec3 anywhere() {
    std::uniform_real_distribution<double> u(-6 * kMm, 6 * kMm);
    const double x = u(random_), y = u(random_);
    return {x, y, u(random_)};
  }
  std::uint64_t seed_ = seed_of_test();
  std::mt19937_64 random_{seed_};
};

TEST_F(RegionTest, HoldsWhatItsNameSays) {
  SCOPED_TRACE("BURR_SEED=" + std::to_string(seed_));
  const Region ball = in_ball({1 * kMm, 0, 0}, 2 * kMm);
  const Region capsule = in_capsule({-2 * kMm, 0, 0}, {2 * kMm, 0, 0}, 1 * kMm);
  math::Pose turned;
  turned.p = {0, 1 * kMm, 0};
  turned.q = math::Quat(Eigen::AngleAxisd(0.5, Vec3(0, 0, 1)));
  const Region box = in_box(turned, {3 * kMm, 1 * kMm, 2 * kMm});
  const Region half = in_half_space({0, 0, 1 * kMm}, {0, 0, 5});
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = anywhere();
    EXPECT_EQ(contains(ball, p), (p - Vec3(1 * kMm, 0, 0)).norm() <= 2 * kMm);
    const double beyond = std::max(0.0, std::abs(p.x()) - 2 * kMm);
    EXPECT_EQ(contains(capsule, p), Vec3(beyond, p.y(), p.z()).norm() <= 1 * kMm);
    const double c = std::cos(0.5), s = std::sin(0.5), y = p.y() - 1 * kMm;
    EXPECT_EQ(contains(box, p), std::abs(c * p.x() + s * y) <= 3 * kMm &&
                                    std::abs(c * y - s * p.x()) <= 1 * kMm &&
                                    std::abs(p.z()) <= 2 * kMm);
    EXPECT_EQ(contains(half, p), p.z() <= 1 * kMm);
    EXPECT_EQ(contains(either(ball, half), p), contains(ball, p) || contains(half, p));
    EXPECT_EQ(contains(both(ball, half), p), contains(ball, p) && contains(half, p));
    EXPECT_EQ(contains(without(ball, half), p), contains(ball, p) && !contains(half, p));
    EXPECT_TRUE(contains(Region(), p));
  }
}

TEST_F(RegionTest, DepthIsTheDistanceToTheBorder) {
  EXPECT_DOUBLE_EQ(depth_in(in_ball({0, 0, 0}, 2 * kMm), {3 * kMm, 0, 0}), -1 * kMm);
  EXPECT_DOUBLE_EQ(depth_in(in_capsule({0, 0, 0}, {0, 0, 4 * kMm}, 1 * kMm), {0, 3 * kMm, 2 * kMm}),
                   -2 * kMm);
  EXPECT_NEAR(depth_in(in_box({}, {1 * kMm, 2 * kMm, 3 * kMm}), {4 * kMm, 6 * kMm, 0}), -5 * kMm,
              1e-12);
  EXPECT_NEAR(depth_in(in_box({}, {1 * kMm, 2 * kMm, 3 * kMm}), {0.5 * kMm, 0, 0}), 0.5 * kMm,
              1e-12);
  EXPECT_NEAR(depth_in(near_line({{0, 0, 0}, {2 * kMm, 0, 0}, {2 * kMm, 2 * kMm, 0}}, 1 * kMm),
                       {3.5 * kMm, 1 * kMm, 0}),
              -0.5 * kMm, 1e-12);
}

TEST_F(RegionTest, DistancesToTissuesMakeRegions) {
  test::Plan plan;
  plan.bone = test::below(0);
  plan.labels = {{phantom::ball(1 * kMm, {-3 * kMm, 0, -3 * kMm}), test::kNerve},
                 {phantom::ball(1 * kMm, {3 * kMm, 0, -3 * kMm}), test::kHard}};
  const double h = 0.25 * kMm;
  const auto bone = test::build(plan, plan.bone, h);
  const auto nerve = test::distance_to(*bone, test::kNerve),
             hard = test::distance_to(*bone, test::kHard);
  const Region near = within(nerve, 2 * kMm), gap = between(nerve, hard, 4.5 * kMm);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = anywhere();
    const double to_nerve = (p - Vec3(-3 * kMm, 0, -3 * kMm)).norm() - 1 * kMm;
    const double to_hard = (p - Vec3(3 * kMm, 0, -3 * kMm)).norm() - 1 * kMm;
    if (std::abs(to_nerve - 2 * kMm) > 0.6 * h) {
      EXPECT_EQ(contains(near, p), to_nerve < 2 * kMm);
    }
    // inside a tissue the distance is - h / 2 and not less
    if (std::min(to_nerve, to_hard) > 0 && std::abs(to_nerve + to_hard - 4.5 * kMm) > 1.2 * h) {
      EXPECT_EQ(contains(gap, p), to_nerve + to_hard < 4.5 * kMm);
    }
  }
}

// Where the distance ends, the depth stays: it does not jump to minus infinity.
TEST_F(RegionTest, BeyondTheReachTheDepthIsCutOff) {
  test::Plan plan;
  plan.bone = test::below(0);
  plan.labels = {{phantom::ball(1 * kMm, {-5 * kMm, 0, -3 * kMm}), test::kNerve}};
  const auto bone = test::build(plan, plan.bone, 0.4 * kMm);
  const std::array<volume::TissueId, 1> ids = {test::kNerve};
  NoProgress quiet;
  auto made = volume::DistanceTo::make(*bone, ids, {.reach = 4 * kMm}, quiet);
  ASSERT_TRUE(made);
  const auto nerve = std::make_shared<const volume::DistanceTo>(std::move(*made));
  EXPECT_NEAR(depth_in(within(nerve, 1 * kMm), {7 * kMm, 0, 0}), -3 * kMm, 1e-12);
  EXPECT_FALSE(contains(within(nerve, 5 * kMm), {7 * kMm, 0, 0}));  // not known to be so near
  EXPECT_FALSE(contains(within(std::make_shared<const volume::DistanceTo>(), 1 * kMm), {0, 0, 0}));
}

TEST_F(RegionTest, TheCourseMeasuresAlongItself) {
  EXPECT_NEAR((Course{{{0, 0, 0}, {3 * kMm, 0, 0}, {3 * kMm, 4 * kMm, 0}}}.direction(
                   {2 * kMm, 3 * kMm, 0}) -
               Vec3(0, 1, 0))
                  .norm(),
              0, 1e-12);
  const Course course = {{{0, 0, 0}, {3 * kMm, 0, 0}, {3 * kMm, 4 * kMm, 0}}};
  EXPECT_DOUBLE_EQ(course.along({1 * kMm, -1 * kMm, 1 * kMm}), 1 * kMm);
  EXPECT_DOUBLE_EQ(course.along({5 * kMm, 3 * kMm, 0}), 6 * kMm);
  EXPECT_DOUBLE_EQ(course.along({-5 * kMm, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(course.along({3 * kMm, 9 * kMm, 0}), 7 * kMm);
  EXPECT_DOUBLE_EQ(course.distance({1 * kMm, -1 * kMm, 0}), 1 * kMm);
  EXPECT_TRUE(std::isinf(Course{}.distance({0, 0, 0})));
}

}  // namespace
}  // namespace burr::metrics
