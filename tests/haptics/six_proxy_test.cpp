// The proxy of six unknowns against closed forms, and against the proxy of three unknowns.
#include "burr/haptics/six/six_proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "burr/haptics/proxy.h"
#include "burr/math/rotation.h"
#include "burr/math/turn.h"
#include "burr/rt/simd.h"
#include "support/mesh.h"
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

tool::Tool burr(double radius) {
  tool::Burr head;
  head.radius = radius;
  return tool::burr_with_shaft(head);
}

SixTouch settle(SixProxy& proxy, const Pose& from, const Pose& to, int ticks = 200) {
  SixTouch touch;
  for (int n = 0; n <= ticks + 60; ++n) {
    const double s = std::min(1.0, 1.0 * n / ticks);
    const Vec3 way = math::rotation_vector(math::product(to.q, from.q.conjugate()));
    touch =
        proxy.step({from.p + s * (to.p - from.p),
                    math::product(turn_about(way + Vec3(0, 0, 1e-15), s * way.norm()), from.q)});
  }
  return touch;
}

// ---- the solver

// A random set of rows: z is allowed, every push is above zero, z is where the pushes say, and every
// row that pushes is met exactly: the conditions of Karush, Kuhn and Tucker, which only the nearest
// allowed z meets.
TEST(LeastTwist, MeetsTheConditionsOfTheNearestAllowedMove) {
  constexpr unsigned kSeed = 31;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> any(0, 1);
  const auto rows = std::make_unique<Rows>();
  int most_active = 0;
  for (int round = 0; round < 2000; ++round) {
    rows->count = 1 + round % 60;
    for (int j = 0; j < rows->count; ++j) {
      const Vec3 n = Vec3(any(random), any(random), any(random)).normalized();
      for (int k = 0; k < 3; ++k) {
        rows->n[k][j] = static_cast<float>(n[k]);
        rows->m[k][j] = static_cast<float>(any(random));
      }
      rows->gap[j] = static_cast<float>(0.3 * std::abs(any(random)));
    }
    Six wanted;
    for (double& one : wanted) one = any(random);
    const LeastTwist twist = least_twist(*rows, wanted, row_kernel().worst);
    ASSERT_TRUE(twist.solved);
    Six sum = wanted;
    const auto at = [&](int j) {
      double value = static_cast<double>(rows->gap[j]);
      for (std::size_t k = 0; k < 3; ++k)
        value += static_cast<double>(rows->n[k][j]) * twist.z[k] +
                 static_cast<double>(rows->m[k][j]) * twist.z[k + 3];
      return value;
    };
    for (int a = 0; a < twist.active; ++a) {
      const int j = twist.index[a];
      EXPECT_GE(twist.push[a], 0);
      EXPECT_NEAR(at(j), 0, 1e-5);
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += twist.push[a] * static_cast<double>(rows->n[k][j]);
        sum[k + 3] += twist.push[a] * static_cast<double>(rows->m[k][j]);
      }
    }
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(sum[k], twist.z[k], 1e-9);
    for (int j = 0; j < rows->count; ++j) EXPECT_GT(at(j), -1e-5);
    most_active = std::max(most_active, twist.active);
  }
  EXPECT_EQ(most_active, 6);
}

// ---- against the proxy of three unknowns

TEST(SixProxy, ABallAloneRestsWhereTheProxyOfThreeUnknownsRestsWithoutTorque) {
  for (const bool groove : {false, true}) {
    const TouchScene scene(groove ? phantom::groove(M_PI / 4) : phantom::ball(5 * kMm), 0.25);
    const double r = 1.5 * kMm;
    const Vec3 start(0, 0, groove ? 6 * kMm : 8 * kMm);
    const Quat q = turn_about({1, 2, 3}, 0.4);
    Proxy three(scene.surface, {.radius = r}, start);
    SixProxy six(scene.surface, one_part({ShapeKind::ball, 0, 0, 0, r}), {}, {start, q});
    double worst = 0;
    for (int place = 0; place < 20; ++place) {
      const Vec3 goal(0.1 * kMm * place, 0.06 * kMm * place, groove ? 1.8 * kMm : 6 * kMm);
      SixTouch touch;
      for (int n = 0; n < 60; ++n) {
        static_cast<void>(three.step(goal));
        touch = six.step({goal, q});
        ASSERT_EQ(touch.turn.norm() < 1e-12, true) << touch.turn.norm();
      }
      EXPECT_GT(touch.active, 0);
      worst = std::max(worst, (touch.world_from_tool.p - three.position()).norm());
    }
    // both work with floats; three discs that are nearly parallel turn their rounding into nanometres
    EXPECT_LT(worst, 1e-8);  // 1e-5 mm
  }
}

// ---- sharp edges

// Force and torque of a sharp tool that a hand draws over smooth bone, as burr bench tool has it: 20 mm/s and 0.6 rad/s,
// half a millimetre pressed in. 99 of 100 second differences from tick to tick are below:  [N], [N mm]
struct Roughness {
  double force, torque;
};
Roughness roughness(const tool::Tool& tool, const phantom::Depth& depth, double below,
                    bool planes) {
  const TouchScene scene(depth, 0.25);
  SixProxy proxy(scene.surface, tool, {.lever = std::sqrt(300e-6), .planes = planes},
                 {{0, 0, 8 * kMm}, Quat::Identity()});
  std::vector<double> force, torque;
  Vec3 f[2] = {Vec3::Zero(), Vec3::Zero()}, m[2] = {Vec3::Zero(), Vec3::Zero()};
  constexpr int kDown = 300, kTicks = 2000;
  for (int n = 0; n < kDown + kTicks; ++n) {
    const double t = 1e-3 * std::max(0, n - kDown), wide = 3 * kMm;
    const double above = n < kDown ? 8 * kMm * (1 - 1.0 * n / kDown) : 0;
    const Vec3 at(wide * std::sin(0.02 / wide * t), wide * std::sin(0.83 * 0.02 / wide * t),
                  above + below - 0.5 * kMm);
    const Vec3 turn = 0.25 * Vec3(std::sin(2.4 * t), std::sin(1.85 * t), std::sin(1.42 * t));
    const SixTouch touch = proxy.step({at, turn_about(turn + Vec3(0, 0, 1e-15), turn.norm())});
    const Vec3 now = 1e3 * touch.stretch, moment = 300 * touch.turn;
    if (n >= kDown) {
      force.push_back((now - 2 * f[0] + f[1]).norm());
      torque.push_back((moment - 2 * m[0] + m[1]).norm());
    }
    f[1] = std::exchange(f[0], now);
    m[1] = std::exchange(m[0], moment);
  }
  const auto p99 = [](std::vector<double>& of) {
    std::sort(of.begin(), of.end());
    return of[of.size() * 99 / 100];
  };
  return {p99(force), p99(torque)};
}

// On planes of the discs a chisel and a blade slide; on the points alone they hop from one to the next.
TEST(SixProxy, ASharpEdgeSlidesOverSmoothBoneWithoutHopping) {
  const tool::Tool chisel = one_part({ShapeKind::wedge, 1 * kMm, 3 * kMm, 6 * kMm, 0.05 * kMm}),
                   blade = one_part({ShapeKind::box, 0.2 * kMm, 3 * kMm, 3 * kMm, 0.05 * kMm});
  const phantom::Depth slab = phantom::slab(Vec3(0.1, 0.2, 1));
  for (const auto& [tool, below] : {std::pair{&chisel, 0.0}, {&blade, 3.05 * kMm}}) {
    const Roughness slides = roughness(*tool, slab, below, true),
                    hops = roughness(*tool, slab, below, false);
    EXPECT_LT(slides.force, 0.03);
    EXPECT_LT(slides.torque, 0.6);
    EXPECT_GT(hops.force, 5 * slides.force);
  }
}

// The tip of a flame rests on the plane, not between its points.
TEST(SixProxy, ASharpTipDoesNotSinkBetweenThePointsOfAPlane) {
  const Vec3 up = Vec3(0.1, 0.2, 1).normalized();
  const TouchScene scene(phantom::slab(up), 0.25);
  const double rho = 0.1 * kMm, deep = 0.3 * kMm;
  const tool::Tool tip = one_part({ShapeKind::vesica, 1 * kMm, 0, 4 * kMm, rho});
  const Quat standing = math::shortest_rotation(Vec3::UnitZ(), up);
  double deepest = 0, aside = 0;
  for (int place = 0; place < 12; ++place) {
    const Vec3 at = Vec3(0.071, 0.043, 0) * kMm * place;
    const Vec3 on_plane = at - up * up.dot(at);
    SixProxy proxy(scene.surface, tip, {.lever = 60 * kMm}, {on_plane + 7 * kMm * up, standing});
    const SixTouch touch = settle(proxy, {on_plane + 7 * kMm * up, standing},
                                  {on_plane + (4 * kMm + rho - deep) * up, standing});
    const double high = up.dot(touch.world_from_tool.p) - 4 * kMm - rho;
    deepest = std::max(deepest, -high);
    aside = std::max(aside, (touch.stretch - up * up.dot(touch.stretch)).norm());
  }
  EXPECT_LT(deepest, 0.005 * kMm);
  EXPECT_LT(aside, 0.01 * kMm) << "the force is along the normal";
}

// ---- closed forms

TEST(SixProxy, ACylinderLyingOnAPlaneIsPushedStraightBackWithoutTorque) {
  const TouchScene scene(phantom::slab(Vec3(0.1, 0.2, 1)), 0.25);
  const Vec3 up = Vec3(0.1, 0.2, 1).normalized();
  const double a = 3 * kMm, deep = 0.5 * kMm;
  SixProxy proxy(scene.surface, one_part({ShapeKind::cylinder, 2.7 * kMm, 0, 3 * kMm, 0.3 * kMm}),
                 {.lever = std::sqrt(300e-6)}, {});
  const Quat lying = math::shortest_rotation(Vec3::UnitZ(), up.unitOrthogonal());
  proxy.place({up * 5 * kMm, lying});
  const SixTouch touch = settle(proxy, {up * 5 * kMm, lying}, {up * (a - deep), lying});
  EXPECT_FALSE(touch.lagging);
  EXPECT_NEAR((touch.stretch - deep * up).norm() / deep, 0, 0.02);
}

// A tool from a mesh rests where the same tool by formula rests: on a plane, in a groove, on a ball. Its
// edges are rounder than it is pressed in: on a sharp one any tool slides from point to point of bone.
TEST(SixProxy, AMeshIsPushedAsTheBodyThatItIs) {
  const tool::Shape truth = {ShapeKind::cylinder, 1.4 * kMm, 0, 3.4 * kMm, 0.6 * kMm};
  std::vector<std::pair<double, double>> profile = {{0, -4 * kMm}};
  for (const double end : {-1.0, 1.0})
    for (int n = 0; n <= 16; ++n) {
      const double angle = end < 0 ? M_PI / 2 * (n / 16.0 - 1) : M_PI / 2 * (n / 16.0);
      profile.emplace_back((1.4 + 0.6 * std::cos(angle)) * kMm,
                           (3.4 * end + 0.6 * std::sin(angle)) * kMm);
    }
  profile.emplace_back(0, 4 * kMm);
  const auto grid = tool::grid_of(test::turned(profile, 128), 0.15 * kMm);
  ASSERT_TRUE(grid.ok());
  const tool::Shape mesh = test::grid_shape(*grid);
  const phantom::Depth bones[] = {phantom::slab(Vec3(0.1, 0.2, 1)), phantom::groove(M_PI / 4),
                                  phantom::ball(5 * kMm)};
  // a mesh touches points and no planes
  const SixSettings settings = {.lever = std::sqrt(300e-6), .planes = false};
  for (const phantom::Depth& bone : bones) {
    const TouchScene scene(bone, 0.25);
    for (const double tilt : {0.4, 1.2}) {
      const Pose from{{0.2 * kMm, 0.1 * kMm, 11 * kMm}, turn_about({1, 0.4, 0}, tilt)};
      Pose to = from;
      SixProxy first(scene.surface, one_part(truth), settings, from);
      while (to.p.z() > 0 && first.step(to).active == 0) to.p.z() -= 0.02 * kMm;
      to.p.z() -= 0.4 * kMm;
      SixTouch touch[2];
      for (int n = 0; n < 2; ++n) {
        SixProxy proxy(scene.surface, one_part(n == 0 ? truth : mesh), settings, from);
        touch[n] = settle(proxy, from, to);
        EXPECT_GT(touch[n].active, 0);
        EXPECT_GT(touch[n].stretch.norm(), 0.15 * kMm);
        EXPECT_FALSE(touch[n].lagging);
      }
      EXPECT_NEAR((touch[1].stretch - touch[0].stretch).norm(), 0, 0.03 * kMm)
          << tilt << " of " << 1e3 * touch[0].stretch.norm() << " mm";
      EXPECT_NEAR((touch[1].turn - touch[0].turn).norm(), 0, 0.006) << tilt;
    }
  }
}

// One contact at the lever l from c: N = delta / (1/k_t + l^2/k_r), torque N l.
TEST(SixProxy, AShaftAcrossAnEdgeGivesWayAsLeverAndStiffnessSay) {
  const TouchScene scene(
      phantom::capsule({0, -30 * kMm, -4 * kMm}, {0, 30 * kMm, 4 * kMm}, 1 * kMm), 0.25, 12);
  const double lever = std::sqrt(300e-6), delta = 0.5 * kMm, a = 1.2 * kMm;
  const Vec3 up = Vec3(0, -4, 30).normalized();  // the ridge is tilted against the lattice
  const Vec3 axis = Vec3::UnitX().cross(up);
  for (const double l : {0.0, 5 * kMm, 8 * kMm}) {
    SixProxy proxy(scene.surface, one_part({ShapeKind::capsule, 0, 0, 12 * kMm, a}),
                   {.lever = lever}, {});
    const Quat along_x = math::shortest_rotation(Vec3::UnitZ(), Vec3::UnitX());
    const Pose from{5 * kMm * up - l * Vec3::UnitX(), along_x},
        to{(1 * kMm + a - delta) * up - l * Vec3::UnitX(), along_x};
    proxy.place(from);
    const SixTouch touch = settle(proxy, from, to);
    const double truth = delta / (1 + l * l / (lever * lever));
    const double error = 0.06 * scene.h;  // of the ridge's own place
    EXPECT_NEAR(touch.stretch.dot(up), truth, error) << l;
    // the normal on a ridge of four voxels is off by up to 2 degrees, and with it the lever
    EXPECT_NEAR(lever * lever * touch.turn.dot(axis), truth * l, error * l + truth * a * 0.04) << l;
  }
}

// Force and torque on the hand are the sums of the contacts', in every tick that has come to rest.
TEST(SixProxy, TheWrenchIsTheSumOfTheContacts) {
  const TouchScene scene(phantom::groove(M_PI / 5), 0.25);
  const double lever = 17 * kMm;
  SixProxy proxy(scene.surface, burr(1.5 * kMm), {.lever = lever},
                 {{0, 0, 9 * kMm}, Quat::Identity()});
  int compared = 0;
  for (int n = 0; n < 1500; ++n) {
    const double t = n * 1e-3, down = std::min(1.0, n / 300.0);
    const Pose hand{
        {0.5 * kMm * std::sin(7 * t), 2 * kMm * std::sin(3 * t), (9 - 7.2 * down) * kMm},
        turn_about({1, 0.3, 0}, 0.5 * std::sin(4 * t))};
    const SixTouch touch = proxy.step(hand);
    if (touch.active == 0 || touch.lagging || touch.moves >= 12) continue;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (int a = 0; a < touch.active; ++a) {
      const SixContact& contact = touch.contacts[static_cast<std::size_t>(a)];
      force += contact.load * contact.normal;
      torque += contact.load * contact.lever;
    }
    ++compared;
    EXPECT_NEAR((force - touch.stretch).norm(), 0, 1e-4 * touch.stretch.norm() + 2e-9) << n;
    EXPECT_NEAR((torque - lever * lever * touch.turn).norm(), 0,
                1e-4 * torque.norm() + 2e-9 * lever)
        << n;
  }
  EXPECT_GT(compared, 800);
}

// A plate of 0.6 mm between hand and tool: the tool stays on its side, whatever the hand does.
TEST(SixProxy, NoPartEverCrossesAThinPlate) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const Vec3 up = Vec3(0.2, 0.3, 1).normalized();
  const TouchScene scene(phantom::plate(0.6 * kMm, up), 0.3, 9);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> side(-5 * kMm, 5 * kMm), angle(-0.9, 0.9);
  tool::Tool tool = one_part({ShapeKind::box, 0.2 * kMm, 2 * kMm, 2 * kMm, 0.15 * kMm});
  ASSERT_TRUE(tool::add_part(tool, {{ShapeKind::vesica, 1 * kMm, 0, 3 * kMm, 0.3 * kMm},
                                    {{0, 0, 4 * kMm}, Quat::Identity()},
                                    Role::rubs}));
  SixProxy proxy(scene.surface, tool, {}, {8 * kMm * up, Quat::Identity()});
  Pose hand{8 * kMm * up, Quat::Identity()};
  int wrong = 0, touched = 0;
  double deepest = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    if (tick % 40 == 0)
      hand = {Vec3(side(random), side(random), side(random)),
              turn_about({angle(random), angle(random), angle(random)}, angle(random))};
    const SixTouch touch = proxy.step(hand);
    touched += touch.active > 0 ? 1 : 0;
    const Pose& at = touch.world_from_tool;
    for (int n = 0; n < tool.count; ++n) {
      const tool::Part& part = tool.parts[static_cast<std::size_t>(n)];
      const Quat back = math::product(at.q, part.tool_from_part.q).conjugate();
      const double lowest =
          up.dot(at * part.tool_from_part.p) - tool::support(part.shape, back * -up);
      deepest = std::min(deepest, lowest - 0.3 * kMm);
      wrong += lowest < 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(deepest, -0.2 * kMm);  // points are a voxel apart, and a thin edge sinks between them
  EXPECT_GT(touched, 2000);
}

// At a held hand, V never rises from one move to the next.
TEST(SixProxy, EnergyFallsWhileTheHandIsStill) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const double lever = 17 * kMm;
  SixProxy proxy(scene.surface, burr(1 * kMm), {.lever = lever, .max_moves = 1},
                 {{0, 0, 30 * kMm}, Quat::Identity()});
  const Pose hand{{0, 0, 3 * kMm}, turn_about({1, 0, 0}, 0.3)};
  double last = 1e9;
  for (int n = 0; n < 400; ++n) {
    const SixTouch touch = proxy.step(hand);
    const double v = touch.stretch.squaredNorm() + lever * lever * touch.turn.squaredNorm();
    EXPECT_LE(v, last + 1e-12) << n;  // 1e-6 mm^2
    last = v;
  }
}

// A replay must give the same bits on every processor.
TEST(SixProxy, GivesTheSameBitsOnEveryInstructionSet) {
  const TouchScene scene(phantom::gyroid(8 * kMm), 0.3, 9);
  const rt::Simd best = rt::simd();
  std::vector<SixTouch> first;
  for (const rt::Simd set : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(set);
    SixProxy proxy(scene.surface, burr(1 * kMm), {}, {{0, 0, 30 * kMm}, Quat::Identity()});
    for (std::size_t n = 0; n < 300; ++n) {
      const double t = 0.01 * static_cast<double>(n);
      const SixTouch touch = proxy.step({{2 * kMm * std::sin(t), 0, (12 - 3 * t) * kMm},
                                         turn_about({1, 0.4, 0}, 0.5 * std::sin(2 * t))});
      if (set == rt::Simd::scalar) {
        first.push_back(touch);
        continue;
      }
      ASSERT_EQ(touch.stretch, first[n].stretch) << n;
      ASSERT_EQ(touch.turn, first[n].turn) << n;
      ASSERT_EQ(touch.candidates, first[n].candidates) << n;
    }
  }
  rt::force_simd(best);
  EXPECT_GT(first.back().active, 0);
}

TEST(SixProxy, TakesNeitherMemoryNorLock) {
  const TouchScene scene(phantom::ball(5 * kMm), 0.25);
  SixProxy proxy(scene.surface, burr(1.5 * kMm), {}, {{0, 0, 8 * kMm}, Quat::Identity()});
  const test::RtGuard guard;
  for (int n = 0; n < 500; ++n)
    static_cast<void>(proxy.step(
        {{3 * kMm * std::sin(0.01 * n), 0, 5 * kMm}, turn_about({0, 1, 0}, std::sin(0.02 * n))}));
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

TEST(SixProxy, KnowsWhetherEveryPartIsFree) {
  const TouchScene scene(phantom::without(phantom::slab(), phantom::cylinder(4 * kMm, 20 * kMm)),
                         0.25);
  SixProxy proxy(scene.surface, burr(1.5 * kMm), {}, {{0, 0, 9 * kMm}, Quat::Identity()});
  EXPECT_TRUE(proxy.is_free({{0, 0, -4 * kMm}, Quat::Identity()}));
  EXPECT_FALSE(proxy.is_free({{3 * kMm, 0, -4 * kMm}, Quat::Identity()}));      // the head
  EXPECT_FALSE(proxy.is_free({{0, 0, -4 * kMm}, turn_about({0, 1, 0}, 0.9)}));  // the shaft
  EXPECT_FALSE(proxy.is_free({{9 * kMm, 0, -6 * kMm}, Quat::Identity()}));      // in bone
}

}  // namespace
}  // namespace burr::haptics
