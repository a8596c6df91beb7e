// The baselines do what their authors wrote, and fail where predicted:
// docs/understand/touch_methods.md, "The eight methods".
#include <gtest/gtest.h>

#include <cmath>

#include "burr/haptics/baselines/voxel_springs.h"
#include "burr/haptics/force_law.h"
#include "burr/haptics/touch_method.h"
#include "haptics/touch_scene.h"
#include "support/rt_guard.h"

namespace burr::haptics {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

struct Scene : test::TouchScene {
  using test::TouchScene::TouchScene;
  [[nodiscard]] std::unique_ptr<TouchMethod> method(Method which, double r, const Vec3& hand) {
    return make_method(which, surface, {.radius = r}, hand);
  }
};

// Moves from `from` to `to` at a constant speed, then rests; returns the last touch.
Touch press(TouchMethod& method, const Vec3& from, const Vec3& to, int ticks = 400) {
  Touch touch;
  for (int n = 0; n <= ticks; ++n)
    touch = method.step(from + (to - from) * (double{1.0} * n / ticks));
  for (int n = 0; n < 100; ++n) touch = method.step(to);
  return touch;
}

TEST(Methods, HaveNamesThatAreUnderstood) {
  for (int n = 0; n < kMethods; ++n) {
    const auto method = static_cast<Method>(n);
    EXPECT_EQ(method_named(name(method)), method);
  }
  EXPECT_FALSE(method_named("springs").has_value());
}

TEST(Methods, NoneOfThemTakesMemoryInATick) {
  Scene scene(phantom::ball(4 * kMm), 0.5);
  for (int n = 0; n < kMethods; ++n) {
    const auto method = scene.method(static_cast<Method>(n), 1.5 * kMm, {0, 0, 7 * kMm});
    const test::RtGuard guard;
    for (int t = 0; t < 100; ++t) (void)method->step({1e-5 * t, 0, (7 - 0.03 * t) * kMm});
    EXPECT_EQ(guard.allocations(), 0) << kMethodNames[static_cast<std::size_t>(n)];
    EXPECT_EQ(guard.locks(), 0);
  }
}

// ---- voxel springs: the closed form of docs/understand/touch_methods.md, "Voxel springs"

double half_space(double a, double r, double h) {  // for 1 N/m per voxel
  return M_PI / (h * h * h) *
         (std::pow(r, 4) / 12 - a * a * r * r / 2 + 2 * r * std::pow(std::abs(a), 3) / 3 -
          std::pow(a, 4) / 4);
}

TEST(VoxelSprings, GiveTheForceOfAHalfSpace) {
  const double r = 3 * kMm;
  for (const double h_mm : {0.5, 0.25}) {
    Scene scene(phantom::slab(), h_mm);
    const auto method = scene.method(Method::voxel_springs, r, {0, 0, 6 * kMm});
    for (double a_mm = -2; a_mm <= 2; a_mm += 0.25) {
      const double a = a_mm * kMm + 0.031 * kMm;
      const Touch touch = method->step({0.07 * kMm, 0.11 * kMm, a});
      const double felt = touch.depth * touch.normal.z() / VoxelSprings::kShare;
      EXPECT_NEAR(felt, half_space(a, r, scene.h), 0.03 * half_space(0, r, scene.h)) << a_mm;
      if (std::abs(a_mm) < 1.6) {
        EXPECT_NEAR(felt / half_space(a, r, scene.h), 1, 0.03) << a_mm;
      }
    }
  }
}

TEST(VoxelSprings, AreEightTimesAsStiffWithVoxelsHalfAsLarge) {
  double force[2] = {};
  int n = 0;
  for (const double h_mm : {0.5, 0.25}) {
    Scene scene(phantom::slab(), h_mm);
    const auto method = scene.method(Method::voxel_springs, 3 * kMm, {0, 0, 6 * kMm});
    force[n++] = method->step({0, 0, 1 * kMm}).depth;
  }
  EXPECT_NEAR(force[1] / force[0], 8, 0.3);
}

TEST(VoxelSprings, SoftenBeyondHalfImmersionAndGiveNothingInside) {
  const double r = 2 * kMm;
  Scene scene(phantom::slab(), 0.25);
  const auto method = scene.method(Method::voxel_springs, r, {0, 0, 6 * kMm});
  const double half = method->step({0, 0, 0}).depth, deeper = method->step({0, 0, -1 * kMm}).depth,
               inside = method->step({0, 0, -2.6 * kMm}).depth;
  EXPECT_LT(deeper, 0.8 * half);
  EXPECT_LT(inside, 0.01 * half);
}

// ---- the thesis

TEST(Thesis, IsExactOnAPlaneAndOnABall) {
  const double r = 1.5 * kMm;
  {
    const Vec3 n = Vec3(0.3, -0.5, 0.8).normalized();
    Scene scene(phantom::slab(n), 0.25);
    const auto method = scene.method(Method::thesis, r, 3 * kMm * n);
    const Vec3 hand = -0.3 * kMm * n + 0.7 * kMm * n.unitOrthogonal();
    const Touch touch = press(*method, hand + 1 * kMm * n, hand);
    ASSERT_TRUE(touch.touching);
    EXPECT_LT((touch.proxy - (hand + (r + 0.3 * kMm) * n)).norm(), 0.02 * kMm);
    EXPECT_NEAR(touch.depth, 0.3 * kMm, 0.02 * kMm);
  }
  {
    const double R = 5 * kMm;
    Scene scene(phantom::ball(R), 0.25);
    const auto method = scene.method(Method::thesis, r, {0, 0, 6 * kMm});
    const Vec3 out = Vec3(0.2, 0.3, 0.9).normalized();
    const Touch touch = press(*method, (R + 0.5 * kMm) * out, (R - 0.3 * kMm) * out);
    EXPECT_LT((touch.proxy - (R + r) * out).norm(), 0.05 * kMm);
  }
}

TEST(Thesis, StandsInTheOtherWallOfAGroove) {
  const double r = 1.5 * kMm;
  Scene scene(phantom::groove(M_PI / 4), 0.25);
  // pressed against the left wall near the bottom of the groove
  double worst = 0;
  for (const double down : {1.5, 1.0, 0.5, 0.2}) {
    const auto method = scene.method(Method::thesis, r, {0, 0, 6 * kMm});
    const Touch touch = press(*method, {0, 0, 3 * kMm}, {-0.6 * kMm, 0, down * kMm - 0.6 * kMm});
    const double right = r / std::sin(M_PI / 4);  // where both walls are touched
    if (touch.touching) worst = std::max(worst, right - touch.proxy.z());
  }
  EXPECT_GT(worst, 0.5 * kMm) << "the burr should be buried";
}

TEST(Thesis, AsItIsWrittenTheForceLeapsAtContact) {
  const double r = 1.5 * kMm;
  Scene scene(phantom::slab(), 0.25);
  for (const Method which : {Method::thesis, Method::thesis_literal}) {
    const auto method = scene.method(which, r, {0, 0, 1 * kMm});
    double leap = 0;
    Vec3 last = Vec3::Zero();
    for (int n = 0; n < 200; ++n) {
      const Touch touch = method->step({0, 0, 1 * kMm - 0.01 * kMm * n});
      const Vec3 force = force_law(touch, Vec3::Zero(), {1000, 0});
      leap = std::max(leap, (force - last).norm());
      last = force;
    }
    if (which == Method::thesis) {
      EXPECT_LT(leap, 0.02);
    } else {
      EXPECT_NEAR(leap, 1000 * r, 0.05);  // k r
    }
  }
}

// ---- samples

TEST(Samples, RestOnAPlaneAndStayInsideForEverRoundACorner) {
  const double r = 1 * kMm;
  {
    Scene scene(phantom::slab(), 0.25);
    const auto method = scene.method(Method::samples, r, {0, 0, 3 * kMm});
    const Touch touch = press(*method, {0, 0, 3 * kMm}, {0.3 * kMm, 0, 0.7 * kMm});
    ASSERT_TRUE(touch.touching);
    EXPECT_NEAR(touch.proxy.z(), r, 0.1 * kMm);
  }
  // Fig. 11: along a floor into a wall. At half a metre per second the burr sinks in up to its far
  // side; at three millimetres per tick one step takes all its points into bone, and it stays
  // there.
  for (const int ticks : {20, 3})
    for (const Method which : {Method::samples, Method::constraint}) {
      Scene scene(
          phantom::without(phantom::slab({0, 0, 1}, {0, 0, 6 * kMm}),
                           phantom::placed(phantom::box(Vec3(4, 8, 8) * kMm),
                                           {math::Vec3(-4, 0, 8) * kMm, math::Quat::Identity()})),
          0.25);
      const auto method = scene.method(which, r, {-4 * kMm, 0, 3 * kMm});
      const Vec3 floor(-4 * kMm, 0, 0.6 * kMm), wall(6 * kMm, 0, 0.6 * kMm);
      const Vec3 air(-4 * kMm, 0, 3 * kMm);
      (void)press(*method, air, floor);
      const double sunk = press(*method, floor, wall, ticks).proxy.x() + r;
      const double away = (press(*method, wall, air).proxy - air).norm();
      if (which == Method::samples) {
        EXPECT_GT(sunk, 1.8 * r);
        if (ticks == 3) {
          EXPECT_GT(away, 2 * kMm) << "it came out again";
        }
      } else {
        EXPECT_LT(sunk, 0.05 * r);
        EXPECT_LT(away, 1e-9);
      }
    }
}

// ---- the independent check

TEST(Penalty, AgreesWithOursInShallowContact) {
  const double r = 1.5 * kMm;
  struct Case {
    const char* what;
    phantom::Depth depth;
    Vec3 from, to;
  };
  const Vec3 out = Vec3(0.2, 0.3, 0.9).normalized();
  const Case cases[] = {
      {"plane", phantom::slab(), {0, 0, 3 * kMm}, {0.3 * kMm, 0, r - 0.1 * kMm}},
      {"ball", phantom::ball(4 * kMm), 7 * kMm * out, (4 * kMm + r - 0.1 * kMm) * out},
      {"groove",
       phantom::groove(M_PI / 4),
       {0, 0, 5 * kMm},
       {0.05 * kMm, 0, r * std::sqrt(2.0) - 0.1 * kMm}},
      {"bowl", phantom::bowl(4 * kMm), Vec3::Zero(), (4 * kMm - r + 0.1 * kMm) * out}};
  for (const Case& one : cases) {
    Scene scene(one.depth, 0.25);
    const auto ours = scene.method(Method::constraint, r, one.from),
               judge = scene.method(Method::penalty, r, one.from);
    const Touch a = press(*ours, one.from, one.to), b = press(*judge, one.from, one.to);
    ASSERT_TRUE(a.touching && b.touching) << one.what;
    EXPECT_LT((a.proxy - b.proxy).norm(), 0.15 * scene.h) << one.what;
    EXPECT_GT(a.normal.dot(b.normal), std::cos(5 * M_PI / 180)) << one.what;
  }
}

}  // namespace
}  // namespace burr::haptics
