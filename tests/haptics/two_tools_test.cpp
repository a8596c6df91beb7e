// Two tools that feel each other: the force against closed forms, and what must hold for any motion.
#include "burr/haptics/six/two_tools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "burr/haptics/six/part_gap.h"
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
using test::TouchScene;
using test::turn_about;
using tool::Role;
using tool::Shape;
using tool::ShapeKind;

constexpr double kMm = 1e-3;

// A shaft from the origin along +z.
tool::Tool shaft(double radius, double length = 40 * kMm) {
  tool::Tool tool;
  EXPECT_TRUE(tool::add_part(tool, {{ShapeKind::capsule, 0, 0, 0.5 * length, radius},
                                    {{0, 0, 0.5 * length}, Quat::Identity()},
                                    Role::cuts}));
  return tool;
}

tool::Tool ball(double radius) {
  tool::Tool tool;
  EXPECT_TRUE(tool::add_part(tool, {{ShapeKind::ball, 0, 0, 0, radius}, {}, Role::cuts}));
  return tool;
}

tool::Tool burr(double radius) {
  tool::Burr head;
  head.radius = radius;
  return tool::burr_with_shaft(head);
}

// Two tools over a scene, with hands that the test moves.
struct Pair {
  SixProxy a, b;
  double k_a, k_b;
  TwoTools two;
  SixTouch touch_a, touch_b;
  bool together = false;

  Pair(const TouchScene& scene, const tool::Tool& tool_a, const tool::Tool& tool_b,
       const Pose& at_a, const Pose& at_b, const SixSettings& of_a = {},
       const SixSettings& of_b = {}, double stiffness_a = 1000, double stiffness_b = 700)
      : a(scene.surface, tool_a, of_a, at_a),
        b(scene.surface, tool_b, of_b, at_b),
        k_a(stiffness_a),
        k_b(stiffness_b) {}
  void step(const Pose& hand_a, const Pose& hand_b) {
    const HeldTool one = {a, hand_a, k_a}, other = {b, hand_b, k_b};
    together = two.near(one, other);
    if (together) {
      two.step(one, other, touch_a, touch_b);
    } else {
      touch_a = a.step(hand_a);
      touch_b = b.step(hand_b);
    }
  }
  [[nodiscard]] double gap() const {
    double least = std::numeric_limits<double>::infinity();
    const Pose at_a = a.pose(), at_b = b.pose();
    for (int i = 0; i < a.tool().count; ++i)
      for (int j = 0; j < b.tool().count; ++j) {
        const tool::Part &one = a.tool().parts[static_cast<std::size_t>(i)],
                         &other = b.tool().parts[static_cast<std::size_t>(j)];
        least = std::min(
            least,
            part_gap({one.shape, at_a * one.tool_from_part.p, at_a.q * one.tool_from_part.q},
                     {other.shape, at_b * other.tool_from_part.p, at_b.q * other.tool_from_part.q})
                .gap);
      }
    return least;
  }
  // V of both springs  [J]
  [[nodiscard]] double energy(double lever_a, double lever_b) const {
    return 0.5 * k_a *
               (touch_a.stretch.squaredNorm() + lever_a * lever_a * touch_a.turn.squaredNorm()) +
           0.5 * k_b *
               (touch_b.stretch.squaredNorm() + lever_b * lever_b * touch_b.turn.squaredNorm());
  }
};

// In free air: the bone is far below.
TouchScene air() { return TouchScene(phantom::ball(2 * kMm), 0.5); }
const Vec3 kUp(0, 0, 60 * kMm);

// ---- closed forms

TEST(TwoTools, AShaftPressedOnAShaftPushesAsBothSpringsAndLeversSay) {
  const TouchScene scene = air();
  for (const double l_a : {5 * kMm, 20 * kMm})
    for (const double l_b : {0.0, 15 * kMm})
      for (const double lever_b : {17 * kMm, 60 * kMm}) {
        const double r_a = 1.2 * kMm, r_b = 0.8 * kMm, lever_a = 30 * kMm;
        const double delta = 0.4e-6;  // the closed form is the limit of small turns
        const Pose at_a = {kUp, Quat::Identity()};
        // b lies along x, under a in y: they cross at l_a along a, l_b along b
        const Pose at_b = {kUp + Vec3(-l_b, -(r_a + r_b), l_a),
                           math::shortest_rotation(Vec3::UnitZ(), Vec3::UnitX())};
        tool::Tool longer;  // on both sides of its origin, so that l_b = 0 is no end
        ASSERT_TRUE(
            tool::add_part(longer, {{ShapeKind::capsule, 0, 0, 40 * kMm, r_b}, {}, Role::cuts}));
        Pair pair(scene, shaft(r_a), longer, at_a, at_b, {.lever = lever_a}, {.lever = lever_b});
        Pose hand_b = at_b;
        hand_b.p.y() -= 1e-8;
        pair.step(at_a, hand_b);
        hand_b.p.y() = at_b.p.y() + delta;
        for (int n = 0; n < 60; ++n) pair.step(at_a, hand_b);
        ASSERT_TRUE(pair.touch_a.meets && pair.touch_b.meets);
        const double k_ra = pair.k_a * lever_a * lever_a, k_rb = pair.k_b * lever_b * lever_b;
        const double expected =
            delta / (1 / pair.k_a + l_a * l_a / k_ra + 1 / pair.k_b + l_b * l_b / k_rb);
        const Vec3 on_a = pair.k_a * pair.touch_a.stretch, on_b = pair.k_b * pair.touch_b.stretch;
        EXPECT_NEAR(on_a.y(), expected, 1e-6 * expected) << l_a << " " << l_b << " " << lever_b;
        EXPECT_NEAR((on_a + on_b).norm(), 0, 1e-9 * expected) << "equal and opposite";
        EXPECT_NEAR((pair.k_a * pair.touch_a.pushed - on_a).norm(), 0, 1e-6 * expected);
        // its torque is that force at its lever
        EXPECT_NEAR(k_ra * pair.touch_a.turn.x(), -l_a * expected, 1e-5 * l_a * expected);
        EXPECT_EQ(pair.touch_a.active, 0) << "no bone";
      }
}

TEST(TwoTools, BallsPushAlongTheLineOfTheirCentres) {
  const TouchScene scene = air();
  const Vec3 way = Vec3(1, 2, -0.5).normalized();
  const Pose at_a = {kUp, turn_about({1, 0, 3}, 1)}, at_b = {kUp - 3 * kMm * way, Quat::Identity()};
  Pair pair(scene, ball(2 * kMm), ball(0.99 * kMm), at_a, at_b);
  for (int n = 0; n < 60; ++n) pair.step(at_a, {at_b.p + 0.51 * kMm * way, at_b.q});
  const double expected = 0.5 * kMm / (1 / pair.k_a + 1 / pair.k_b);
  EXPECT_NEAR((pair.k_a * pair.touch_a.stretch - expected * way).norm(), 0, 1e-6 * expected);
  EXPECT_NEAR((pair.k_b * pair.touch_b.stretch + expected * way).norm(), 0, 1e-6 * expected);
  EXPECT_NEAR(pair.touch_a.turn.norm(), 0, 1e-9);
}

// Side by side they meet along a line: pressed at its middle, neither turns; pressed beyond the end of
// what they share, both do.
TEST(TwoTools, SideBySideTheyRestOnALine) {
  const TouchScene scene = air();
  const double r = 1 * kMm;
  const Pose at_a = {kUp, Quat::Identity()}, at_b = {kUp - Vec3(0, 2.01 * r, 0), at_a.q};
  tool::Tool even;
  ASSERT_TRUE(tool::add_part(even, {{ShapeKind::capsule, 0, 0, 20 * kMm, r}, {}, Role::cuts}));
  Pair pair(scene, even, even, at_a, at_b);
  for (int n = 0; n < 60; ++n) pair.step(at_a, {at_b.p + Vec3(0, 0.52 * kMm, 0), at_b.q});
  const double expected = 0.51 * kMm / (1 / pair.k_a + 1 / pair.k_b);
  EXPECT_NEAR(pair.k_a * pair.touch_a.stretch.y(), expected, 1e-4 * expected);
  EXPECT_LT(pair.touch_a.turn.norm(), 1e-7);
  // b's hand turns by 20 mrad: the line holds it back
  for (int n = 0; n < 200; ++n)
    pair.step(at_a, {at_b.p + Vec3(0, 0.52 * kMm, 0), turn_about({1, 0, 0}, 0.02)});
  EXPECT_GT(pair.touch_b.turn.norm(), 1e-3);
  EXPECT_NEAR((pair.k_a * pair.touch_a.stretch + pair.k_b * pair.touch_b.stretch).norm(), 0, 1e-9);
  EXPECT_GT(pair.gap(), -5e-6);
}

// ---- for any motion

// Hands that swing across each other, fast, over bone: whatever they do, no tool is in the other.
TEST(TwoTools, NeverGoThroughEachOther) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const Pose at_a = {{-6 * kMm, 0, 16 * kMm}, Quat::Identity()},
               at_b = {{6 * kMm, 0, 16 * kMm}, Quat::Identity()};
    Pair pair(scene, burr(1.5 * kMm), shaft(1 * kMm), at_a, at_b);
    Pose hand_a = at_a, hand_b = at_b;
    Vec3 fast_a = Vec3::Zero(), fast_b = Vec3::Zero();
    const auto within = [](const Vec3& p) {
      return Vec3(p.cwiseMin(Vec3(9, 4, 22) * kMm).cwiseMax(Vec3(-9, -4, 9) * kMm));
    };
    double deepest = 0;
    int met = 0;
    for (int n = 0; n < 4000; ++n) {
      if (n % 100 == 0) {
        fast_a = 0.1 * kMm * Vec3(0, any(random), any(random));
        fast_b = 0.1 * kMm * Vec3(0, any(random), any(random));
      }
      // towards each other and beyond, at up to 0.2 m/s
      hand_a.p = within(hand_a.p + fast_a);
      hand_b.p = within(hand_b.p + fast_b);
      hand_a.p.x() = -7 * kMm * std::cos(0.028 * n);
      hand_b.p.x() = 7 * kMm * std::cos(0.023 * n);
      hand_a.q = turn_about({1, 0.3, 0.1}, 0.5 * std::sin(0.004 * n));
      hand_b.q = turn_about({0.2, 1, 0}, 0.6 * std::sin(0.005 * n));
      pair.step(hand_a, hand_b);
      met += pair.touch_a.meets ? 1 : 0;
      deepest = std::min(deepest, pair.gap());
      ASSERT_TRUE(pair.touch_a.stretch.allFinite() && pair.touch_b.turn.allFinite());
      ASSERT_EQ(pair.touch_a.meets, pair.touch_b.meets);
      ASSERT_NEAR((pair.k_a * pair.touch_a.pushed + pair.k_b * pair.touch_b.pushed).norm(), 0,
                  1e-9);
    }
    EXPECT_GT(met, 200) << "seed " << seed;
    EXPECT_GT(deepest, -0.02 * kMm) << "seed " << seed;
  }
}

// At held hands, the springs' energy never rises from one move to the next.
TEST(TwoTools, EnergyFallsWhileTheHandsAreStill) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const double lever = 17 * kMm;
  const Pose at_a = {{-4 * kMm, 0, 20 * kMm}, Quat::Identity()},
             at_b = {{4 * kMm, 0, 20 * kMm}, Quat::Identity()};
  Pair pair(scene, burr(1.5 * kMm), shaft(1 * kMm), at_a, at_b, {.lever = lever, .max_moves = 1},
            {.lever = lever, .max_moves = 1});
  pair.step(at_a, at_b);
  const Pose hand_a = {{3 * kMm, 1 * kMm, 6 * kMm}, turn_about({1, 0, 0}, 0.3)},
             hand_b = {{-2 * kMm, 0, 6 * kMm}, turn_about({0, 1, 0}, 0.4)};
  double last = std::numeric_limits<double>::infinity(), most = 0;
  int met = 0;
  for (int n = 0; n < 500; ++n) {
    pair.step(hand_a, hand_b);
    met += pair.touch_a.meets ? 1 : 0;
    const double v = pair.energy(lever, lever);
    most = std::max(most, v - last);
    last = v;
  }
  EXPECT_LE(most, 6e-8);  // 6e-5 N mm: what a turn errs by, and is taken back
  EXPECT_GT(met, 100);
}

TEST(TwoTools, ItDoesNotMatterWhichComesFirst) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const Pose at_a = {{-4 * kMm, 0, 16 * kMm}, Quat::Identity()},
             at_b = {{4 * kMm, 0, 16 * kMm}, Quat::Identity()};
  Pair one(scene, burr(1.5 * kMm), shaft(1 * kMm), at_a, at_b);
  Pair other(scene, shaft(1 * kMm), burr(1.5 * kMm), at_b, at_a, {}, {}, 700, 1000);
  double most = 0;
  for (int n = 0; n < 400; ++n) {
    const Pose hand_a = {{(-4 + 0.02 * n) * kMm, 0.5 * kMm, 14 * kMm}, turn_about({0, 1, 0}, 0.2)},
               hand_b = {{(4 - 0.02 * n) * kMm, 0, 14 * kMm}, turn_about({1, 0, 0}, 0.1)};
    one.step(hand_a, hand_b);
    other.step(hand_b, hand_a);
    ASSERT_NEAR((one.touch_a.stretch - other.touch_b.stretch).norm(), 0, 1e-6) << n;
    ASSERT_NEAR((one.touch_b.stretch - other.touch_a.stretch).norm(), 0, 1e-6) << n;
    most = std::max(most, one.touch_a.pushed.norm());
  }
  EXPECT_GT(most, 0.5 * kMm);
}

TEST(TwoTools, FarApartEachIsAloneToTheBit) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const Pose at_a = {{-8 * kMm, 0, 16 * kMm}, Quat::Identity()},
             at_b = {{8 * kMm, 0, 30 * kMm}, Quat::Identity()};
  Pair pair(scene, burr(1.5 * kMm), shaft(1 * kMm), at_a, at_b);
  SixProxy alone(scene.surface, burr(1.5 * kMm), {}, at_a);
  for (int n = 0; n < 200; ++n) {
    const Pose hand = {{-8 * kMm, 0, (16 - 0.05 * n) * kMm}, Quat::Identity()};
    pair.step(hand, at_b);
    EXPECT_FALSE(pair.together);
    ASSERT_EQ(pair.touch_a.stretch, alone.step(hand).stretch) << n;
  }
  EXPECT_GT(pair.touch_a.active, 0);
}

TEST(TwoTools, ThatOverlapWhenTheyAreTakenUpAreFeltOnceTheyWereApart) {
  const TouchScene scene = air();
  const Pose at = {kUp, Quat::Identity()};
  Pair pair(scene, ball(2 * kMm), ball(2 * kMm), at, {kUp + Vec3(1 * kMm, 0, 0), at.q});
  pair.step(at, {kUp + Vec3(1 * kMm, 0, 0), at.q});
  EXPECT_FALSE(pair.together);
  for (int n = 0; n < 100; ++n) pair.step(at, {kUp + Vec3((1 + 0.04 * n) * kMm, 0, 0), at.q});
  for (int n = 0; n < 100; ++n) pair.step(at, {kUp + Vec3((5 - 0.04 * n) * kMm, 0, 0), at.q});
  EXPECT_TRUE(pair.touch_a.meets);
  EXPECT_NEAR(pair.gap(), 0, 1e-6);
}

// A replay must give the same bits on every processor.
TEST(TwoTools, GiveTheSameBitsOnEveryInstructionSet) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const rt::Simd best = rt::simd();
  std::vector<Vec3> first;
  bool met = false;
  for (const rt::Simd set : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(set);
    const Pose at_a = {{-5 * kMm, 0, 14 * kMm}, Quat::Identity()},
               at_b = {{5 * kMm, 0, 14 * kMm}, Quat::Identity()};
    Pair pair(scene, burr(1.5 * kMm), shaft(1 * kMm), at_a, at_b);
    for (std::size_t n = 0; n < 500; ++n) {
      const double t = 0.01 * static_cast<double>(n);
      pair.step({{(-5 + 2 * t) * kMm, 0, (14 - 2 * t) * kMm}, turn_about({1, 0.4, 0}, 0.3 * t)},
                {{(5 - 2 * t) * kMm, 0, (14 - 1.5 * t) * kMm}, turn_about({0, 1, 0}, -0.1 * t)});
      met = met || pair.touch_a.meets;
      if (set == rt::Simd::scalar) {
        for (const Vec3& one : {pair.touch_a.stretch, pair.touch_a.turn, pair.touch_b.stretch,
                                pair.touch_b.turn, pair.touch_a.pushed})
          first.push_back(one);
        continue;
      }
      ASSERT_EQ(pair.touch_a.stretch, first[5 * n]) << n;
      ASSERT_EQ(pair.touch_a.turn, first[5 * n + 1]) << n;
      ASSERT_EQ(pair.touch_b.stretch, first[5 * n + 2]) << n;
      ASSERT_EQ(pair.touch_b.turn, first[5 * n + 3]) << n;
      ASSERT_EQ(pair.touch_a.pushed, first[5 * n + 4]) << n;
    }
  }
  rt::force_simd(best);
  EXPECT_TRUE(met);
}

TEST(TwoTools, TakeNeitherMemoryNorLock) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const Pose at_a = {{-5 * kMm, 0, 14 * kMm}, Quat::Identity()},
             at_b = {{5 * kMm, 0, 14 * kMm}, Quat::Identity()};
  Pair pair(scene, burr(1.5 * kMm), shaft(1 * kMm), at_a, at_b);
  const test::RtGuard guard;
  int met = 0;
  for (int n = 0; n < 400; ++n) {
    pair.step({{(-5 + 0.02 * n) * kMm, 0, 13 * kMm}, turn_about({1, 0.4, 0}, 0.2)},
              {{(5 - 0.02 * n) * kMm, 0, 13 * kMm}, Quat::Identity()});
    met += pair.touch_a.meets ? 1 : 0;
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_GT(met, 50);
}

// ---- friction on the bone

TouchScene floor() { return TouchScene(phantom::slab(), 0.25, 12); }  // its surface is z = 0

tool::Tool box() { return test::one_part({ShapeKind::box, 2 * kMm, 2 * kMm, 1 * kMm, 0.3 * kMm}); }

// Beside a tool that it does not touch, each is held as if it were alone.
TEST(TwoTools, FrictionHoldsThemOnTheBoneAsIfEachWereAlone) {
  const TouchScene scene = floor();
  const Pose at_a = {{0, 0, 3 * kMm}, Quat::Identity()},
             at_b = {{3.4 * kMm, 0, 4 * kMm}, Quat::Identity()};
  Pair pair(scene, box(), ball(1 * kMm), at_a, at_b);
  SixProxy alone_a(scene.surface, box(), {}, at_a), alone_b(scene.surface, ball(1 * kMm), {}, at_b);
  for (SixProxy* proxy : {&pair.a, &pair.b, &alone_a, &alone_b}) proxy->set_friction({0.3, 0.27});
  int together = 0, stuck = 0, slid = 0;
  double off_stuck = 0, off_b = 0, held = 0, held_two = 0, leap = 0, leap_two = 0;
  Vec3 before = Vec3::Zero(), before_two = Vec3::Zero();
  for (int n = 0; n < 1500; ++n) {
    // down, then along: first it sticks, then it slides
    const double down = std::min(1.0, n / 300.0), along = n < 400 ? 0 : 0.6e-3 * (n - 400) * kMm;
    const Vec3 by(0.2 * along, along, -2.6 * kMm * down);
    const Pose hand_a = {at_a.p + by, at_a.q}, hand_b = {at_b.p + by, at_b.q};
    pair.step(hand_a, hand_b);
    const SixTouch a = alone_a.step(hand_a), b = alone_b.step(hand_b);
    together += pair.together ? 1 : 0;
    stuck += pair.together && a.stuck ? 1 : 0;
    slid += n > 400 && pair.together && !(a.stuck && pair.touch_a.stuck) ? 1 : 0;
    if (slid == 0 && a.stuck)
      off_stuck = std::max(off_stuck, (pair.touch_a.stretch - a.stretch).norm());
    off_b = std::max(off_b, (pair.touch_b.stretch - b.stretch).norm());
    held = std::max(held, a.held.norm());
    held_two = std::max(held_two, pair.touch_a.held.norm());
    leap = std::max(leap, (a.held - before).norm());
    leap_two = std::max(leap_two, (pair.touch_a.held - before_two).norm());
    before = a.held;
    before_two = pair.touch_a.held;
  }
  EXPECT_LT(off_stuck, 5e-6);  // the two solvers differ by rounding
  EXPECT_LT(off_b, 1e-9);
  EXPECT_NEAR(held_two / held, 1, 0.05);
  // it lets go of the rims that it leaves, and never of all that it holds
  EXPECT_LT(leap, 0.6 * held);
  EXPECT_LT(leap_two, 0.6 * held);
  EXPECT_GT(together, 1000);
  EXPECT_GT(stuck, 100);
  EXPECT_GT(slid, 100);
}

// A box rests on the bone with the load N, a ball in the other hand pushes it from the side: it does not
// move before the push is mu N, and then the push stays at that.
TEST(TwoTools, AToolOnTheBoneHoldsAgainstTheOtherUntilItsConeIsFull) {
  const TouchScene scene = floor();
  const double r = 1.2 * kMm, delta = 0.8 * kMm, mu = 0.4;
  for (const double k_b : {300.0, 3000.0}) {
    const Pose at_a = {{0, 0, 4 * kMm}, Quat::Identity()},
               at_b = {{-2.35 * kMm - r, 0, 1.3 * kMm}, Quat::Identity()};
    Pair pair(scene, box(), ball(r), at_a, at_b, {}, {}, 1000, k_b);
    pair.a.set_friction({mu, mu});
    const Pose pressed = {{0, 0, 1.3 * kMm - delta}, at_a.q};
    for (int n = 0; n <= 400; ++n)
      pair.step({pressed.p + Vec3(0, 0, std::max(0.0, 1 - n / 300.0) * 4 * kMm), at_a.q}, at_b);
    const Vec3 rest = pair.a.pose().p;
    const double most = mu * pair.k_a * delta;
    double creep = 0, began = 0;
    int slid = 0;
    for (int n = 0; n < 6000; ++n) {
      const double push = pair.k_b * pair.touch_b.stretch.norm();
      // so that the push grows by as much in either case
      const double x = 0.05 * kMm + 1.3 * n / 6000 * most / k_b;
      pair.step(pressed, {at_b.p + Vec3(x, 0, 0), at_b.q});
      const double went = (pair.a.pose().p - rest).norm();
      if (push < 0.97 * most) creep = std::max(creep, went);
      if (began == 0 && went > 5e-3 * kMm) began = push;
      if (began > 0 && went < 0.05 * kMm) {
        // it slides against friction and its own spring
        EXPECT_NEAR(
            (pair.k_b * pair.touch_b.stretch.norm() - pair.k_a * (pair.a.pose().p - rest).x()) /
                most,
            1, 0.03)
            << k_b;
        ++slid;
      }
    }
    EXPECT_LT(creep, 1e-3 * kMm) << k_b;
    EXPECT_NEAR(began / most, 1, 0.02) << k_b;
    EXPECT_GT(slid, 100);
    EXPECT_NEAR((pair.k_a * pair.touch_a.pushed + pair.k_b * pair.touch_b.pushed).norm(), 0, 1e-9);
    // the rest of its stretch is the push of the bone and of the other tool
    EXPECT_NEAR(pair.k_a * pair.touch_a.held.norm() / most, 1, 0.02);
  }
}

// Hands that go round and round, pressing both tools on the bone and on each other, and then let go:
// friction takes energy and never gives any.
TEST(TwoTools, FrictionGivesTheHandsNoEnergy) {
  const TouchScene scene = floor();
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(0.5, 1.5);
    const Pose at_a = {{-2.5 * kMm, 0, 4 * kMm}, Quat::Identity()},
               at_b = {{2.5 * kMm, 0, 4 * kMm}, Quat::Identity()};
    Pair pair(scene, ball(1.5 * kMm), box(), at_a, at_b);
    for (SixProxy* proxy : {&pair.a, &pair.b}) proxy->set_friction({0.4, 0.36});
    const double w[4] = {any(random), any(random), any(random), any(random)};
    constexpr int kTicks = 8000;
    Pose hand_a = at_a, hand_b = at_b;
    Vec3 force_a = Vec3::Zero(), force_b = Vec3::Zero();
    double work = 0, most = 0, least = 0;
    int met = 0, both = 0;
    for (int n = 0; n < kTicks; ++n) {
      const double t = 2 * M_PI * n / kTicks,
                   down = std::sin(0.5 * t) * std::sin(0.5 * t);  // 0 at both ends
      const Pose next_a = {at_a.p + down *
                                        Vec3(1.6 * std::sin(9 * w[0] * t) + 0.6,
                                             1.5 * std::sin(7 * w[1] * t), -3.2) *
                                        kMm,
                           at_a.q},
                 next_b = {at_b.p + down *
                                        Vec3(-1.2 - 0.8 * std::sin(8 * w[2] * t),
                                             1.5 * std::cos(6 * w[3] * t), -3.4) *
                                        kMm,
                           at_b.q};
      pair.step(next_a, next_b);
      const Vec3 now_a = pair.k_a * pair.touch_a.stretch, now_b = pair.k_b * pair.touch_b.stretch;
      work -= (0.5 * (now_a + force_a)).dot(next_a.p - hand_a.p) +
              (0.5 * (now_b + force_b)).dot(next_b.p - hand_b.p);
      force_a = now_a;
      force_b = now_b;
      hand_a = next_a;
      hand_b = next_b;
      const double lever = SixSettings{}.lever, stored = pair.energy(lever, lever);
      most = std::max(most, stored);
      least = std::min(least, work - stored);
      met += pair.touch_a.meets ? 1 : 0;
      both += pair.touch_a.meets && pair.touch_a.active > 0 && pair.touch_b.active > 0 ? 1 : 0;
    }
    EXPECT_GT(met, 1000) << seed;
    EXPECT_GT(both, 500) << seed;
    EXPECT_GT(work, 0.1 * most) << "friction took some";
    EXPECT_GT(least, -0.002 * most) << seed << ": the springs never hold more than the hands gave";
  }
}

// ---- the distance of two parts

// Against the least distance of many points of one core to the other shape.
TEST(PartGap, IsTheLeastDistanceOfACoreToTheOtherShape) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  const Shape others[] = {{ShapeKind::ball, 0, 0, 0, 1.5},
                          {ShapeKind::capsule, 0, 0, 6, 1},
                          {ShapeKind::cylinder, 2, 0, 3, 0.3},
                          {ShapeKind::frustum, 2, 0.5, 4, 0.2},
                          {ShapeKind::box, 3, 0.4, 6, 0.1}};
  for (const Shape& shape : others)
    for (int n = 0; n < 100; ++n) {
      const auto turn = [&] {
        return turn_about({any(random), any(random), any(random)}, 3 * any(random));
      };
      const PartPlace a = {{ShapeKind::capsule, 0, 0, 5, 0.7},
                           9 * Vec3(any(random), any(random), any(random)),
                           turn()},
                      b = {shape, Vec3(any(random), any(random), any(random)), turn()};
      const PartGap gap = part_gap(a, b), back = part_gap(b, a);
      double least = std::numeric_limits<double>::infinity();
      for (int s = 0; s <= 4000; ++s) {
        const Vec3 p = a.middle + a.turn * Vec3(0, 0, -5 + 10.0 * s / 4000);
        least = std::min(least,
                         tool::distance(shape, b.turn.conjugate() * Vec3(p - b.middle)).phi - 0.7);
      }
      if (least < -0.6) continue;  // cores that cross have no one nearest point
      EXPECT_NEAR(gap.gap, least, 1e-5) << static_cast<int>(shape.kind) << " " << n;
      EXPECT_LE(gap.gap, least + 1e-9);
      EXPECT_NEAR(gap.normal.norm(), 1, 1e-9);
      EXPECT_NEAR((gap.a - gap.b - gap.gap * gap.normal).norm(), 0, 1e-6);
      EXPECT_NEAR(back.gap, gap.gap, 1e-6);
      EXPECT_NEAR((back.normal + gap.normal).norm(), 0, 1e-3);
    }
}

}  // namespace
}  // namespace burr::haptics
