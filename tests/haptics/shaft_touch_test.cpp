// A burr whose shaft touches: in free air to the bit the burr of before; at the rim of a hole pushed
// aside; never in bone.
#include "burr/haptics/six/shaft_touch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/rt_guard.h"
#include "touch_scene.h"

namespace burr::haptics {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
using test::TouchScene;

constexpr double kMm = 1e-3, kRadius = 1.5e-3, kSlip = 30e-6;

Quat leaning(double angle) {
  Quat q;
  q.w() = std::cos(angle / 2);
  q.vec() = Vec3(0, std::sin(angle / 2), 0);
  return q;
}

ProxySettings settings() {
  return {.radius = kRadius, .friction_static = 0.3, .friction_kinetic = 0.27, .slip = kSlip};
}

TEST(ShaftTouch, IsToTheBitTheBurrAloneWhereTheShaftTouchesNothing) {
  const TouchScene scene(phantom::ball(5 * kMm), 0.25);
  Proxy alone(scene.surface, settings(), {0, 0, 8 * kMm});
  ShaftTouch burr(scene.surface, settings(), {0, 0, 8 * kMm});
  int touching = 0;
  for (int n = 0; n < 1500; ++n) {
    const double down = std::min(1.0, n / 200.0), t = n * 1e-3;
    const Vec3 hand((2 * std::sin(3 * t)) * kMm, std::sin(2 * t) * kMm, (8 - 2.2 * down) * kMm);
    const Touch a = alone.step(hand), b = burr.step_pose({hand, leaning(0.3 * std::sin(t))});
    ASSERT_FALSE(burr.shaft().rests) << n;
    ASSERT_EQ(a.proxy, b.proxy) << n;
    ASSERT_EQ(a.depth, b.depth) << n;
    ASSERT_EQ(a.normal, b.normal) << n;
    ASSERT_EQ(a.tangential, b.tangential) << n;
    touching += b.touching ? 1 : 0;
  }
  EXPECT_GT(touching, 1000);
}

// In a hole of 4 mm radius the hand leans until the shaft meets the rim, and on: the tool gives way,
// stays out of bone, the head has none of the load, and no force leaps.
TEST(ShaftTouch, LeansAgainstTheRimOfAHole) {
  const TouchScene scene(phantom::without(phantom::slab(), phantom::cylinder(4 * kMm, 40 * kMm)),
                         0.25);
  const Vec3 deep(0, 0, -9 * kMm);
  ShaftTouch burr(scene.surface, settings(), deep);
  SixProxy judge(
      scene.surface,
      tool::burr_with_shaft({.radius = kRadius - 0.02 * kMm, .shaft_radius = 1.18 * kMm}), {},
      {deep, Quat::Identity()});
  Vec3 last = Vec3::Zero();
  int rests = 0;
  double most = 0, torque = 0;
  const test::RtGuard guard;
  for (int n = 0; n < 900; ++n) {
    const double lean = 0.6 * std::sin(M_PI * n / 900);
    const Touch touch = burr.step_pose({deep, leaning(lean)});
    const Vec3 stretch =
        touch.touching ? Vec3(touch.depth * touch.normal + touch.tangential) : Vec3(Vec3::Zero());
    if (n > 0) {
      EXPECT_LE((stretch - last).norm(), kSlip * (1 + 1e-9)) << n;
    }
    last = stretch;
    if (!burr.shaft().rests) continue;
    ++rests;
    most = std::max(most, stretch.norm());
    torque = std::max(torque, burr.shaft().torque.norm());
    EXPECT_LT(stretch.x(), 0) << n;  // away from the rim that the shaft leans on
    if (n % 50 == 0) {
      EXPECT_TRUE(judge.is_free(burr.pose())) << n;
    }
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_GT(rests, 300);
  EXPECT_GT(most, 0.3 * kMm);
  EXPECT_GT(torque, 0.3 * kMm * 4 * kMm);
  EXPECT_FALSE(burr.shaft().rests);
}

// A shaft that stands in bone when the burr is put down is felt only after it was free.
TEST(ShaftTouch, AShaftPutDownInBoneIsNotFeltUntilItIsFree) {
  const TouchScene scene(phantom::without(phantom::slab(), phantom::cylinder(4 * kMm, 40 * kMm)),
                         0.25);
  const Vec3 deep(0, 0, -9 * kMm);
  ShaftTouch burr(scene.surface, settings(), deep);
  for (int n = 0; n < 50; ++n) {
    const Touch touch = burr.step_pose({deep, leaning(0.6)});
    EXPECT_FALSE(touch.touching);
  }
  static_cast<void>(burr.step_pose({deep, leaning(0)}));
  for (int n = 0; n < 300; ++n)
    static_cast<void>(burr.step_pose({deep, leaning(0.6 * std::min(1.0, n / 200.0))}));
  EXPECT_TRUE(burr.shaft().rests);
}

}  // namespace
}  // namespace burr::haptics
