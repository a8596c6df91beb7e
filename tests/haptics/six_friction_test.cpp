// Friction of a tool of several parts against closed forms: slope, spin, both at once, a shaft.
#include "burr/haptics/six/six_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "burr/haptics/six/six_proxy.h"
#include "burr/math/rotation.h"
#include "burr/math/turn.h"
#include "burr/rt/simd.h"
#include "support/rt_guard.h"
#include "tools.h"
#include "touch_scene.h"

namespace burr::haptics {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
using test::one_part;
using test::TouchScene;
using test::turn_about;
using tool::Role;
using tool::ShapeKind;

constexpr double kMm = 1e-3;
const double kLever = std::sqrt(300e-6);  // 1 N/mm and 0.3 N m/rad

tool::Tool box() { return one_part({ShapeKind::box, 2.2 * kMm, 1.7 * kMm, 0.7 * kMm, 0.3 * kMm}); }
tool::Tool disc(double flat) {
  return one_part({ShapeKind::cylinder, flat, 0, 0.7 * kMm, 0.3 * kMm});
}

// Presses a tool from 2 mm above straight down and holds it.
void press(SixProxy& proxy, const Pose& to, const Vec3& up) {
  proxy.place({to.p + 2 * kMm * up, to.q});
  for (int n = 0; n <= 250; ++n)
    static_cast<void>(proxy.step({to.p + std::max(0.0, 1 - n / 200.0) * 2 * kMm * up, to.q}));
}

// ---- the set of all friction

// One place: the cone of the proxy of three unknowns, to rounding.
TEST(SixFriction, OnePlaceHoldsLikeACone) {
  const auto pressed = std::make_unique<Pressed>();
  pressed->count = 1;
  pressed->a[0] = {0, 0, 1, 0, 0, 0};
  for (auto& arm : pressed->arm) arm[0] = 0;
  pressed->share[0] = 2;
  const Friction friction{0.5, 0.4};
  // inside the cone of sticking it is held whole, but for what lifts it off
  const Grip stuck = hold(*pressed, friction, {0.6, -0.7, 0.3, 0, 0, 0}, {.stuck = true});
  EXPECT_TRUE(stuck.stuck);
  EXPECT_NEAR(stuck.f[0], 0.6, 1e-7);
  EXPECT_NEAR(stuck.f[1], -0.7, 1e-7);
  EXPECT_NEAR(stuck.f[2], 0, 1e-8);
  // outside it is shortened to the cone of sliding
  const Grip slides = hold(*pressed, friction, {0.9, -1.2, 0.1, 0, 0, 0}, {.stuck = true});
  EXPECT_FALSE(slides.stuck);
  EXPECT_NEAR(slides.f[0], 0.6 * 0.8, 1e-6);
  EXPECT_NEAR(slides.f[1], -0.8 * 0.8, 1e-6);
  EXPECT_NEAR(slides.f[2], 0, 1e-6);
  // one that slides sticks again only well inside
  EXPECT_FALSE(hold(*pressed, friction, {0.5, 0, 0, 0, 0, 0}, {}).stuck);
  EXPECT_TRUE(hold(*pressed, friction, {0.47, 0, 0, 0, 0, 0}, {}).stuck);
}

// A ring of places: f nearest to the trial, found by brute force over the directions of the slide.
// Whatever the trial, f is in the set: f . d <= h(d) for all d, and equal in the direction of the slide.
TEST(SixFriction, WhatItHoldsIsInTheSetAndOpposesTheSlide) {
  const auto pressed = std::make_unique<Pressed>();
  constexpr int kPlaces = 24;
  pressed->count = kPlaces;
  for (std::size_t j = 0; j < kPlaces; ++j) {
    const double angle = 2 * M_PI * static_cast<double>(j) / kPlaces,
                 r = 0.1 + 0.05 * static_cast<double>(j % 5);
    const double x = r * std::cos(angle), y = r * std::sin(angle);
    pressed->a[j] = {0, 0, 1, y, -x, 0};
    pressed->arm[0][j] = x;
    pressed->arm[1][j] = y;
    pressed->arm[2][j] = 0;
    pressed->share[j] = 0.1 * (1 + static_cast<double>(j % 3));
  }
  const auto most = [&](double x, double y, double turn) {  // h for mu = 1
    double sum = 0;
    for (std::size_t j = 0; j < kPlaces; ++j)
      sum += pressed->share[j] *
             std::hypot(x - turn * pressed->arm[1][j], y + turn * pressed->arm[0][j]);
    return sum;
  };
  const double mu = 0.3;
  for (int n = 0; n < 40; ++n) {
    const Six trial = {2.5 * std::sin(1.7 * n),    2.5 * std::cos(2.3 * n), 0, 0, 0,
                       0.9 * std::sin(0.9 * n + 1)};
    const Grip held = hold(*pressed, {mu, mu}, trial, {});
    if (held.stuck) continue;
    const double dx = held.f[0] - trial[0], dy = held.f[1] - trial[1], dt = held.f[5] - trial[5];
    EXPECT_NEAR(held.f[2], 0, 1e-6);
    // against the slide it takes as much as there is
    const double taken = -(held.f[0] * dx + held.f[1] * dy + held.f[5] * dt);
    EXPECT_NEAR(taken / (mu * most(dx, dy, dt)), 1, 0.02) << n;
    for (int way = 0; way < 200; ++way) {
      const double a = 0.31 * way, b = std::cos(0.7 * way);
      const double x = std::cos(a), y = std::sin(a), t = 6 * b;
      EXPECT_LE(held.f[0] * x + held.f[1] * y + held.f[5] * t, 1.04 * mu * most(x, y, t) + 1e-9)
          << n << ' ' << way;
    }
  }
}

// ---- closed forms

// A box on a slope, its load straight down: it slides if and only if tan > mu, within 2 %.
TEST(SixFriction, ABoxSlidesOnASlopeIfItIsSteeperThanMu) {
  for (const double mu : {0.2, 0.5})
    for (const double share : {0.98, 1.02}) {
      const double slope = std::atan(share * mu);
      const Vec3 up(std::sin(slope), 0, std::cos(slope));
      const TouchScene scene(phantom::slab(up), 0.25, 9);
      const Quat along = math::shortest_rotation(Vec3::UnitZ(), up);
      SixProxy proxy(scene.surface, box(), {.lever = kLever}, {});
      proxy.set_friction({mu, mu});
      press(proxy, {1 * kMm * up, along}, up);
      const Vec3 rest = proxy.pose().p;
      for (int n = 0; n < 3000; ++n)
        static_cast<void>(
            proxy.step({proxy.pose().p - Vec3(0, 0, 0.5 * kMm * std::min(1.0, n / 500.0)), along}));
      const double went = (proxy.pose().p - rest).norm();
      if (share < 1)
        EXPECT_LT(went, 0.02 * kMm) << mu;
      else
        EXPECT_GT(went, 0.1 * kMm) << mu;
    }
}

// A disc pressed flat and spun about its normal: M = 2 mu N R / 3 where it begins to slide, and while
// it slides. A ring, on which a rigid face rests, would hold half as much again.
TEST(SixFriction, ADiscSpunFlatHoldsTwoThirdsOfARing) {
  const Vec3 up = Vec3(0.2, 0.3, 1).normalized();
  const TouchScene scene(phantom::slab(up), 0.25, 9);
  const Quat along = math::shortest_rotation(Vec3::UnitZ(), up);
  for (const double radius : {2 * kMm, 3.5 * kMm}) {
    SixProxy proxy(scene.surface, disc(radius), {.lever = kLever}, {});
    const double mu = 0.3, kinetic = 0.27, delta = 1 * kMm;
    proxy.set_friction({mu, kinetic});
    const Pose at{(1 * kMm - delta) * up, along};
    press(proxy, at, up);
    double held = 0, began = 0, slides = 0;
    int sum = 0;
    for (int n = 0; n < 4000; ++n) {
      const double turn = 4e-6 * n;
      const SixTouch touch = proxy.step({at.p, math::product(turn_about(up, turn), along)});
      const double torque = -kLever * kLever * touch.turn.dot(up);  // over k_t
      if (began == 0 && !touch.stuck) began = held;
      held = torque;
      if (n >= 3000) {
        slides += torque;
        ++sum;
      }
      EXPECT_NEAR(touch.stretch.dot(up), delta, 0.01 * delta);
    }
    slides /= sum;
    const double truth = 2 * mu * delta * radius / 3;
    RecordProperty("began_over_truth", std::to_string(began / truth));
    EXPECT_NEAR(began / truth, 1, 0.05) << radius;
    EXPECT_NEAR(slides / (0.9 * truth), 1, 0.05) << radius;
  }
}

// On a slope that would draw it down by 0.2 mm, held below its limit: it stays where it is for ten seconds
// under a trembling hand.
TEST(SixFriction, WhatSticksDoesNotCreep) {
  const Vec3 up = Vec3(0.3, 0.15, 1).normalized();
  const TouchScene scene(phantom::slab(up), 0.25, 9);
  const Quat along = math::shortest_rotation(Vec3::UnitZ(), up);
  SixProxy proxy(scene.surface, box(), {.lever = kLever}, {});
  proxy.set_friction({0.5, 0.45});
  press(proxy, {1 * kMm * up, along}, up);
  const Vec3 at = proxy.pose().p, hand = at - Vec3(0, 0, 0.7 * kMm);
  for (int n = 0; n <= 400; ++n)
    static_cast<void>(proxy.step({at + std::min(1.0, n / 300.0) * (hand - at), along}));
  const Vec3 rest = proxy.pose().p;
  double worst = 0, pulled = 0;
  for (int n = 0; n < 10'000; ++n) {
    const double t = 1e-3 * n;
    const SixTouch touch =
        proxy.step({hand + Vec3(20e-6 * std::sin(57 * t), 20e-6 * std::sin(46 * t), 0), along});
    worst = std::max(worst, (proxy.pose().p - rest).norm());
    pulled = std::max(pulled, touch.held.norm());
  }
  EXPECT_GT(pulled, 0.15 * kMm) << "friction has something to hold";
  EXPECT_LT(worst, 2e-3 * kMm);
}

// Whatever the hand does in a slot that jams the blade: finite, and never pulled into the bone.
TEST(SixFriction, AJammedBladeStaysFiniteAndOutsideOfTheBone) {
  const double wide = 0.8 * kMm;
  const TouchScene scene([wide](const Vec3& p) { return std::min(std::abs(p.x()) - wide, -p.z()); },
                         0.25, 9);
  tool::Tool tool = one_part({ShapeKind::box, 0.3 * kMm, 4 * kMm, 3 * kMm, 0.2 * kMm});
  SixProxy proxy(scene.surface, tool, {}, {{0, 0, 8 * kMm}, Quat::Identity()});
  proxy.set_friction({0.3, 0.27});
  int touched = 0;
  for (int n = 0; n < 4000; ++n) {
    const double t = 1e-3 * n, down = std::min(1.0, n / 400.0);
    const SixTouch touch = proxy.step(
        {{0.8 * kMm * std::sin(40 * t), 4 * kMm * std::sin(20 * t), (8 - 9 * down) * kMm},
         turn_about({std::sin(3 * t), 1, 0.5}, 0.25 * std::sin(12 * t))});
    touched += touch.active > 0 ? 1 : 0;
    ASSERT_LT(touch.stretch.norm(), 0.05) << n;
    ASSERT_LT(touch.turn.norm(), 2) << n;
    // it holds no more than mu times twice the springs' length, as in a wedge; the ellipsoid is a little
    // larger than the set
    const double lever = SixSettings{}.lever;
    const Vec3 place = touch.stretch - touch.held, turned = touch.turn - touch.held_turn;
    const double length = std::hypot(place.norm(), lever * turned.norm());
    ASSERT_LE(std::hypot(touch.held.norm(), lever * touch.held_turn.norm()),
              1.5 * 0.3 * 2 * length + 0.05 * kMm)
        << n;
  }
  EXPECT_GT(touched, 2000);
}

TEST(SixFriction, GivesTheSameBitsOnEveryInstructionSetAndTakesNoMemory) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const rt::Simd best = rt::simd();
  std::vector<double> first;
  for (const rt::Simd simd : {rt::Simd::scalar, best}) {
    rt::force_simd(simd);
    SixProxy proxy(scene.surface, box(), {.lever = kLever}, {{0, 0, 30 * kMm}, Quat::Identity()});
    proxy.set_friction({0.4, 0.3});
    const burr::test::RtGuard guard;
    double sum = 0;
    for (int n = 0; n < 800; ++n) {
      const double t = 1e-3 * n, down = std::min(1.0, n / 300.0);
      const SixTouch touch = proxy.step(
          {{3 * kMm * std::sin(9 * t), 2 * kMm * std::sin(7 * t), (30 - 27 * down) * kMm},
           turn_about({1, 0.3, 0.2}, 0.3 * std::sin(8 * t))});
      sum += touch.stretch.x() + 3 * touch.stretch.y() + touch.turn.z();
    }
    EXPECT_EQ(guard.allocations(), 0);
    first.push_back(sum);
  }
  rt::force_simd(best);
  EXPECT_EQ(first[0], first[1]);
}

}  // namespace
}  // namespace burr::haptics
