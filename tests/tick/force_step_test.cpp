// What a hand feels from one tick to the next while bone goes away under the burr: 0.01 N at the
// most at about 1 N of push, in slides, slots and pockets (the bar; without the soft layer 0.025 N
// in this pocket).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "burr/device/simulated_hand.h"
#include "burr/math/rotation.h"
#include "burr/phantom/build.h"
#include "burr/tick/servo.h"

namespace burr::tick {
namespace {

using math::Vec3;

enum class Motion { slide, slot, pocket };

struct Felt {
  double most = 0;  // largest step from one tick to the next [N]
  double mean = 0;  // [N]
  double removed_mm3 = 0;
};

// A rigid hand over the ball of the benches, 1 kN/m, a 6 mm burr.
Felt felt(Motion motion, int ticks, bool guarded = false) {
  constexpr double kDt = 1e-3, kRadius = 3e-3;
  constexpr int kComing = 300;
  device::HandPath path;
  double angle = 0;
  for (int n = 0; n < kComing + ticks; ++n) {
    const double t = std::max(0, n - kComing) * kDt;
    const double above = n < kComing ? 3e-3 * (1 - static_cast<double>(n) / kComing) : 0;
    double sunk = std::min(0.5e-3, 1e-3 * t), speed = 20e-3 * std::min(1.0, t / 0.1);
    if (motion == Motion::slot) {
      sunk = std::min(1e-3, 6e-3 * t);
      speed = 20e-3 * std::clamp((t - 0.5) / 0.1, 0.0, 1.0);
    } else if (motion == Motion::pocket) {
      sunk = std::min(3e-3, 3e-3 * t);
      speed = 0;
    }
    angle += speed * kDt / (phantom::kPeersBall + kRadius);
    const Vec3 at = (phantom::kPeersBall + kRadius - sunk + above) *
                    Vec3(std::cos(angle), 0.8 * std::sin(angle), 0.6 * std::sin(angle));
    device::PathPoint point{
        n * kDt, {at, math::shortest_rotation(Vec3::UnitZ(), Vec3(0, -0.6, 0.8))}, 1};
    point.pedal = 1;
    path.points.push_back(point);
  }
  NoProgress quiet;
  const auto bone = phantom::peers_bone(256);
  volume::IsoVertices surface(*bone, {}, 2, quiet);
  device::SimulatedHand hand(path, {.stiffness = INFINITY},
                             {.peak_force = 50, .continuous_force = 50, .max_stiffness = 1e5});
  EXPECT_TRUE(hand.open());
  ServoSettings settings;
  settings.burr.radius = kRadius;
  settings.spindle_rad_s = 8.4 / kRadius;
  settings.force = {1000, 0};
  settings.guarded = guarded;
  settings.limit.user_force = 50;
  settings.limit.slew = settings.limit.ramp_slew = 1e9;
  settings.friction_scale = settings.friction_turning = 0;
  Servo servo(*bone, surface, hand, settings);
  Felt seen;
  Vec3 last = Vec3::Zero();
  for (int n = 0; n < kComing + ticks; ++n) {
    const TickRow& row = servo.tick(false);
    servo.publish();
    if (n > kComing) seen.most = std::max(seen.most, (row.contact.force - last).norm());
    if (n > kComing) seen.mean += row.contact.force.norm() / ticks;
    last = row.contact.force;
    seen.removed_mm3 = 1e9 * row.ledger.removed;
  }
  return seen;
}

TEST(ForceStep, IsSmallInASlide) {
  const Felt seen = felt(Motion::slide, 1500);
  EXPECT_LT(seen.most, 0.01);
  EXPECT_GT(seen.mean, 0.2);
  EXPECT_GT(seen.removed_mm3, 0.5);
}

TEST(ForceStep, IsSmallInAPocketThatFitsTheBurr) {
  const Felt seen = felt(Motion::pocket, 1800);
  EXPECT_LT(seen.most, 0.01);
  EXPECT_GT(seen.mean, 1);
  EXPECT_GT(seen.removed_mm3, 5);
}

// A hand that gathers speed against a wall adds k v T = 0.02 N a tick on its own.
TEST(ForceStep, IsNoLargerInASlotThanTheHandMakesItItself) {
  const Felt seen = felt(Motion::slot, 1800);
  EXPECT_LT(seen.most, 0.02);
  EXPECT_GT(seen.mean, 0.5);
  EXPECT_GT(seen.removed_mm3, 2);
}

// The guard lets the microjoules of a cut pass: it used to brake in blows of up to 0.27 N.
TEST(ForceStep, TheEnergyGuardAddsNone) {
  for (const Motion motion : {Motion::slide, Motion::pocket, Motion::slot}) {
    const Felt without = felt(motion, 1500), with = felt(motion, 1500, true);
    EXPECT_LT(with.most, without.most + 0.002) << static_cast<int>(motion);
    EXPECT_NEAR(with.mean, without.mean, 0.02 * without.mean);
  }
}

}  // namespace
}  // namespace burr::tick
