// The proxy on bones with known answers: docs/understand/touch_truths.md, "Ground truths".
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "burr/haptics/force_law.h"
#include "burr/haptics/proxy.h"
#include "burr/volume/iso_vertices.h"
#include "haptics/touch_scene.h"
#include "support/rt_guard.h"

namespace burr::haptics {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

struct Scene : test::TouchScene {
  using test::TouchScene::TouchScene;
  // docs/understand/touch_truths.md, "Ground truths": max(0.02 mm, 0.1 h); 0.15 h at h = 0.5 mm
  [[nodiscard]] double tolerance() const {
    return std::max(0.02 * kMm, (h > 0.4 * kMm ? 0.15 : 0.1) * h);
  }
};

double angle_deg(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / M_PI;
}

// Moves a hand along `path` (s in 0..1) at about 50 mm/s and compares every tick with the true
// place of the proxy.
struct Worst {
  double place = 0, direction_deg = 0;
  int touched = 0;
};
Worst stroke(Scene& scene, double r, const Vec3& start, const std::function<Vec3(double)>& hand,
             const std::function<Vec3(const Vec3&)>& truth, int ticks = 2000,
             bool check_direction = true) {
  Proxy proxy(scene.surface, {.radius = r}, start);
  Worst worst;
  for (int n = 0; n < 400; ++n) (void)proxy.step(start + (hand(0) - start) * (n / 400.0));
  for (int n = 0; n < 20; ++n) (void)proxy.step(hand(0));
  for (int n = 0; n <= ticks; ++n) {
    const Vec3 x = hand(static_cast<double>(n) / ticks);
    const Touch touch = proxy.step(x);
    if (!touch.touching) continue;
    ++worst.touched;
    const Vec3 c = truth(x);
    worst.place = std::max(worst.place, (touch.proxy - c).norm());
    if (check_direction && (c - x).norm() > 0.1 * kMm)
      worst.direction_deg = std::max(worst.direction_deg,
                                     angle_deg(force_law(touch, Vec3::Zero(), {1000, 0}), c - x));
  }
  return worst;
}

class Truth : public testing::TestWithParam<double> {};  // voxel size [mm]

TEST_P(Truth, RestsOneRadiusAboveAnObliquePlane) {
  const Vec3 n = Vec3(0.3, -0.5, 0.8).normalized();
  Scene scene(phantom::slab(n), GetParam());
  const double r = 1.5 * kMm, deep = 0.3 * kMm;
  const Vec3 along = n.unitOrthogonal();
  const Worst worst = stroke(
      scene, r, (r + 3 * kMm) * n,
      [&](double s) { return Vec3((r - deep) * n + (8 * s - 4) * kMm * along); },
      [&](const Vec3& x) { return Vec3(x + (r - n.dot(x)) * n); });
  EXPECT_GT(worst.touched, 1990);
  EXPECT_LT(worst.place, scene.tolerance());
  EXPECT_LT(worst.direction_deg, 0.5);
}

TEST_P(Truth, RollsOverABallWithoutTangentialError) {
  const double R = 5 * kMm, r = 1.5 * kMm, deep = 0.3 * kMm;
  Scene scene(phantom::ball(R), GetParam());
  const Vec3 a(1, 0, 0), b = Vec3(0, 0.8, 0.6);
  const auto on = [&](double s) { return Vec3(std::cos(2 * s) * a + std::sin(2 * s) * b); };
  const Worst worst = stroke(
      scene, r, (R + r + 2 * kMm) * on(0), [&](double s) { return Vec3((R + r - deep) * on(s)); },
      [&](const Vec3& x) { return Vec3((R + r) * x.normalized()); });
  EXPECT_GT(worst.touched, 1990);
  EXPECT_LT(worst.place, scene.tolerance());
  EXPECT_LT(worst.direction_deg, 0.5);
}

TEST_P(Truth, StaysInsideABowlAndIsPushedInward) {
  const double R = 6 * kMm, r = 1.5 * kMm, deep = 0.3 * kMm;
  Scene scene(phantom::bowl(R), GetParam());
  const Vec3 a(1, 0, 0), b = Vec3(0, 0.8, 0.6);
  const auto on = [&](double s) { return Vec3(std::cos(2 * s) * a + std::sin(2 * s) * b); };
  const Worst worst = stroke(
      scene, r, Vec3::Zero(), [&](double s) { return Vec3((R - r + deep) * on(s)); },
      [&](const Vec3& x) { return Vec3((R - r) * x.normalized()); });
  EXPECT_GT(worst.touched, 1990);
  EXPECT_LT(worst.place, scene.tolerance());
  EXPECT_LT(worst.direction_deg, 0.5);
}

TEST_P(Truth, ABallInACavityOfItsOwnSizeDoesNotMove) {
  const double r = 3 * kMm;
  Scene scene(phantom::bowl(r + 0.02 * kMm), GetParam());
  Proxy proxy(scene.surface, {.radius = r}, Vec3::Zero());
  std::mt19937 random(7);
  std::normal_distribution<double> push(0, 1 * kMm);
  for (int n = 0; n < 500; ++n) {
    const Touch touch = proxy.step({push(random), push(random), push(random)});
    ASSERT_LT(touch.proxy.norm(), scene.tolerance() + 0.1 * scene.h) << n;
  }
}

// A field represents a sharp edge only where voxels lie on it: here faces go through voxel centres.
// Between voxel centres the edge is chamfered by up to a third of a voxel, see
// AnEdgeBetweenVoxelsIsChamferedByLessThanOne.
TEST_P(Truth, TurnsRoundTheEdgeOfABoxContinuously) {
  const double b = 5 * kMm + GetParam() / 2 * kMm, r = 1.5 * kMm, deep = 0.3 * kMm;
  Scene scene(phantom::box(Vec3::Constant(b)), GetParam());
  // from the top face over the edge x = z = b and down the side, 0.3 mm inside the true rounded
  // path
  const double quarter = M_PI / 2 * r, total = 4 * kMm + quarter + 4 * kMm;
  const auto way = [&](double s, double radius) {
    const double at = s * total;
    if (at < 4 * kMm) return Vec3(b - 4 * kMm + at, 0.4 * kMm, b + radius);
    if (at < 4 * kMm + quarter) {
      const double turn = (at - 4 * kMm) / r;
      return Vec3(b + radius * std::sin(turn), 0.4 * kMm, b + radius * std::cos(turn));
    }
    return Vec3(b + radius, 0.4 * kMm, b - (at - 4 * kMm - quarter));
  };
  const auto truth = [&](const Vec3& x) {
    const Vec3 foot(std::min(x.x(), b), x.y(), std::min(x.z(), b));
    return Vec3(foot + r * (x - foot).normalized());
  };
  Proxy proxy(scene.surface, {.radius = r}, way(0, r + 2 * kMm));
  for (int n = 0; n <= 200; ++n)
    (void)proxy.step(way(0, r + 2 * kMm) + (way(0, r - deep) - way(0, r + 2 * kMm)) * (n / 200.0));
  double worst_place = 0, worst_turn = 0;
  Vec3 last(0, 0, 1);
  for (int n = 0; n <= 4000; ++n) {
    const Vec3 x = way(n / 4000.0, r - deep);
    const Touch touch = proxy.step(x);
    ASSERT_TRUE(touch.touching);
    worst_place = std::max(worst_place, (touch.proxy - truth(x)).norm());
    worst_turn = std::max(worst_turn, angle_deg(touch.normal, last));
    last = touch.normal;
  }
  EXPECT_LT(worst_place, scene.tolerance());
  EXPECT_LT(worst_turn, 2 * scene.h / r * 180 / M_PI)
      << "degrees in one tick: two voxels seen from the burr's centre";
  EXPECT_LT(angle_deg(last, {1, 0, 0}), 0.5);
}

TEST_P(Truth, AnEdgeBetweenVoxelsIsChamferedByLessThanOne) {
  const double r = 1.5 * kMm;
  for (const double shift : {0.0, 0.125, 0.25, 0.375}) {
    const double b = 5 * kMm + shift * GetParam() * kMm;
    Scene scene(phantom::box(Vec3::Constant(b)), GetParam());
    const Vec3 u = Vec3(1, 0, 1).normalized(), edge(b, 0.3 * kMm, b);
    Proxy proxy(scene.surface, {.radius = r}, edge + (r + 1 * kMm) * u);
    Touch touch;
    for (int n = 0; n < 300; ++n)
      touch = proxy.step(edge + (r + 1 * kMm - 1.5 * kMm * std::min(1.0, n / 200.0)) * u);
    ASSERT_TRUE(touch.touching);
    EXPECT_LT((touch.proxy - (edge + r * u)).norm(), 0.75 * scene.h) << "shift " << shift;
  }
}

TEST_P(Truth, RestsOnTheCornerOfABox) {
  const double b = 5 * kMm + GetParam() / 2 * kMm, r = 1.5 * kMm;
  Scene scene(phantom::box(Vec3::Constant(b)), GetParam());
  const Vec3 u = Vec3(1, 1, 1).normalized(), corner = Vec3::Constant(b);
  Proxy proxy(scene.surface, {.radius = r}, corner + (r + 1 * kMm) * u);
  Touch touch;
  for (int n = 0; n < 300; ++n)
    touch = proxy.step(corner + (r + 1 * kMm - 1.5 * kMm * std::min(1.0, n / 200.0)) * u);
  ASSERT_TRUE(touch.touching);
  EXPECT_LT((touch.proxy - (corner + r * u)).norm(), scene.tolerance());
}

TEST_P(Truth, RestsInANinetyDegreeGroove) {
  const double r = 1.5 * kMm;
  Scene scene(phantom::groove(M_PI / 4), GetParam());
  const auto truth = [&](const Vec3& x) { return Vec3(0, x.y(), r / std::sin(M_PI / 4)); };
  const Worst worst = stroke(
      scene, r, Vec3(0, -4 * kMm, 6 * kMm),
      [&](double s) { return Vec3(0, (8 * s - 4) * kMm, r / std::sin(M_PI / 4) - 0.3 * kMm); },
      truth);
  EXPECT_GT(worst.touched, 1990);
  EXPECT_LT(worst.place, scene.tolerance());
  EXPECT_LT(worst.direction_deg, 0.5);
}

TEST_P(Truth, StrokesATorus) {
  const double ring = 6 * kMm, tube = 2 * kMm, r = 1.5 * kMm, deep = 0.3 * kMm;
  Scene scene(phantom::torus(ring, tube), GetParam());
  const auto centre_line = [&](const Vec3& x) {
    const Vec3 flat(x.x(), x.y(), 0);
    return Vec3(ring * flat.normalized());
  };
  const auto hand = [&](double s) {
    const double around = 1.2 * s, up = 0.5 + 1.0 * s;  // along the ring and over the tube
    const Vec3 out(std::cos(around), std::sin(around), 0);
    return Vec3(ring * out +
                (tube + r - deep) * (std::cos(up) * out + std::sin(up) * Vec3::UnitZ()));
  };
  const Worst worst =
      stroke(scene, r, hand(0) + 2 * kMm * (hand(0) - centre_line(hand(0))).normalized(), hand,
             [&](const Vec3& x) {
               const Vec3 q = centre_line(x);
               return Vec3(q + (tube + r) * (x - q).normalized());
             });
  EXPECT_GT(worst.touched, 1990);
  EXPECT_LT(worst.place, scene.tolerance());
  EXPECT_LT(worst.direction_deg, 0.5);
}

TEST_P(Truth, RestsInTheHoleOfATorus) {
  const double ring = 4 * kMm, tube = 2 * kMm, r = 3 * kMm;
  Scene scene(phantom::torus(ring, tube), GetParam());
  Proxy proxy(scene.surface, {.radius = r}, {0, 0, 8 * kMm});
  Touch touch;
  for (int n = 0; n < 600; ++n)
    touch = proxy.step({0, 0, 8 * kMm - 6 * kMm * std::min(1.0, n / 400.0)});
  const double z = std::sqrt((tube + r) * (tube + r) - ring * ring);
  EXPECT_LT((touch.proxy - Vec3(0, 0, z)).norm(),
            2 * scene.tolerance());  // flat walls: the error of the radius, times 1/sin
}

TEST_P(Truth, SitsBetweenTwoBallsSymmetrically) {
  const double rho = 3 * kMm, D = 3.5 * kMm, r = 1.5 * kMm;
  Scene scene(phantom::two_balls(rho, D), GetParam());
  Proxy proxy(scene.surface, {.radius = r}, {0, 0, 8 * kMm});
  Touch touch;
  for (int n = 0; n < 600; ++n)
    touch = proxy.step({0, 0, 8 * kMm - 6.5 * kMm * std::min(1.0, n / 400.0)});
  const double z = std::sqrt((rho + r) * (rho + r) - D * D);
  ASSERT_TRUE(touch.touching);
  EXPECT_NEAR(touch.proxy.x(), 0, scene.tolerance());
  EXPECT_NEAR(touch.proxy.z(), z, 2 * scene.tolerance());
}

// A deep push amplifies the facets on which the proxy itself rests; the force is that of the smooth
// surface.
TEST_P(Truth, TheForceOfADeepPushPullsToTheExactPlace) {
  const double R = 5 * kMm, r = 1.5 * kMm, deep = 1 * kMm;
  Scene scene(phantom::ball(R), GetParam());
  Proxy proxy(scene.surface, {.radius = r}, {0, 0, 8 * kMm});
  double worst = 0, worst_proxy = 0;
  for (int n = 0; n <= 2000; ++n) {
    const double sunk = std::min(deep, deep * n / 400.0);
    const Vec3 out =
        Vec3(std::sin(5e-4 * n), 0.2 * std::sin(7e-4 * n), std::cos(5e-4 * n)).normalized();
    const Vec3 x = (R + r - sunk) * out;
    const Touch touch = proxy.step(x);
    if (n < 500) continue;
    worst = std::max(worst, (x + touch.depth * touch.normal - (R + r) * out).norm());
    worst_proxy = std::max(worst_proxy, (touch.proxy - (R + r) * out).norm());
  }
  EXPECT_LT(worst, scene.tolerance());
  EXPECT_LT(worst_proxy, 0.5 * scene.h);  // half the distance between two vertices
}

INSTANTIATE_TEST_SUITE_P(VoxelMm, Truth, testing::Values(0.5, 0.25, 0.125), [](const auto& voxel) {
  return std::to_string(static_cast<int>(1000 * voxel.param)) + "um";
});

// ---- never through

TEST(Proxy, AMillionTicksAtUpToTenMillimetresNeverCrossAThinPlate) {
  constexpr unsigned kSeed = 20260817;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const Vec3 n = Vec3(0.2, 0.3, 1).normalized();
  Scene scene(phantom::plate(0.6 * kMm, n), 0.3);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> speed(0, 10 * kMm), side(-7 * kMm, 7 * kMm);
  std::normal_distribution<double> turn(0, 1);
  const double r = 0.9 * kMm;
  Proxy proxy(scene.surface, {.radius = r}, 4 * kMm * n);
  Vec3 hand = 4 * kMm * n;
  int wrong = 0, touched = 0;
  for (int tick = 0; tick < 1'000'000; ++tick) {
    const Vec3 goal(side(random), side(random), side(random));
    Vec3 step = goal - hand;
    const double most = speed(random);
    if (step.norm() > most) step *= most / step.norm();
    hand += step;
    const Touch touch = proxy.step(hand);
    touched += touch.touching ? 1 : 0;
    wrong += n.dot(touch.proxy) < 0.3 * kMm + r - 0.3 * scene.h ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(touched, 300'000);
}

TEST(Proxy, WandersOverPorousBoneAndIsNeverInside) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Scene scene(phantom::gyroid(4 * kMm), 0.2, 8);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> stray(0, 0.4 * kMm);
  const double r = 0.6 * kMm;
  // a free place to begin
  std::unique_ptr<Proxy> proxy;
  Vec3 hand;
  for (int n = 0; n < 5000 && !proxy; ++n) {
    hand = Vec3(stray(random), stray(random), stray(random)) * 10;
    proxy = std::make_unique<Proxy>(scene.surface, ProxySettings{.radius = r}, hand);
    if (!proxy->is_free(hand)) proxy.reset();
  }
  ASSERT_NE(proxy, nullptr);
  Proxy judge(scene.surface, {.radius = r - 0.05 * scene.h},
              hand);  // slightly smaller: tolerance of the last tick
  for (int tick = 0; tick < 50'000; ++tick) {
    hand = hand * 0.999 + Vec3(stray(random), stray(random), stray(random));
    const Touch touch = proxy->step(hand);
    if (touch.proxy.cwiseAbs().maxCoeff() > 7 * kMm) continue;  // beyond the border of the volume
    ASSERT_TRUE(judge.is_free(touch.proxy)) << "tick " << tick;
  }
}

TEST(Proxy, FollowsAFastHandThroughFreeAirWithoutForce) {
  Scene scene(phantom::slab(), 0.5);
  Proxy proxy(scene.surface, {.radius = 1 * kMm}, {0, 0, 9 * kMm});
  for (int n = 0; n < 100; ++n) {
    const Vec3 hand(10 * kMm * (n % 2), 0, 9 * kMm);
    const Touch touch = proxy.step(hand);
    ASSERT_FALSE(touch.touching);
    ASSERT_FALSE(touch.lagging);
    ASSERT_LT((touch.proxy - hand).norm(), 1e-9);
  }
}

// ---- friction (Harwin & Melder 2002): docs/understand/touch.md, "Friction"

class Friction : public testing::Test {
 protected:
  static constexpr double r = 1.5 * kMm, deep = 0.4 * kMm;
  Scene scene{phantom::slab(), 0.25};
  [[nodiscard]] Proxy& pressed(double mu_s, double mu_k) {
    proxy_.emplace(scene.surface,
                   ProxySettings{.radius = r, .friction_static = mu_s, .friction_kinetic = mu_k},
                   Vec3(0, 0, 3 * kMm));
    for (int n = 0; n <= 200; ++n)
      (void)proxy_->step({0, 0, 3 * kMm + (r - deep - 3 * kMm) * (n / 200.0)});
    return *proxy_;
  }

 private:
  std::optional<Proxy> proxy_;
};

TEST_F(Friction, SticksUntilTheConeIsReachedWithinOnePercent) {
  for (const double mu : {0.1, 0.3, 0.8}) {
    Proxy& proxy = pressed(mu, 0.9 * mu);
    double slipped_at = 0;
    for (int n = 0; n < 4000 && slipped_at == 0; ++n) {
      const double x = n * 0.1e-6;
      const Touch touch = proxy.step({x, 0, r - deep});
      if (!touch.stuck) slipped_at = x;
    }
    EXPECT_NEAR(slipped_at / deep, mu, 0.01 * mu + 0.001) << "mu " << mu;
  }
}

TEST_F(Friction, SlidingLagIsMuTimesDepth) {
  for (const double mu : {0.1, 0.3, 0.5, 0.8, 1.0}) {
    Proxy& proxy = pressed(mu, mu);
    Touch touch;
    double x = 0;
    for (int n = 0; n < 4000; ++n) touch = proxy.step({x += 1e-6, 0, r - deep});
    const Vec3 hand(x, 0, r - deep);
    const double length = (touch.depth * touch.normal + touch.tangential).norm();
    EXPECT_NEAR(length / deep, std::sqrt(1 + mu * mu), 0.01 * std::sqrt(1 + mu * mu))
        << "the thesis' cases, mu " << mu;
  }
}

TEST_F(Friction, DoesNotDriftInAMinuteOfSticking) {
  Proxy& proxy = pressed(0.5, 0.45);
  const Vec3 hand(0.1 * kMm, 0.05 * kMm, r - deep);
  for (int n = 0; n < 100; ++n)
    (void)proxy.step(hand * (n / 100.0) + Vec3(0, 0, (r - deep) * (1 - n / 100.0)));
  const Vec3 before = proxy.step(hand).proxy;
  for (int n = 0; n < 60'000; ++n) (void)proxy.step(hand);
  EXPECT_LT((proxy.step(hand).proxy - before).norm(), 1e-9);
}

TEST_F(Friction, AGrooveHoldsHarder) {  // |F_t| <= mu sum N_i = mu F / sin A
  Scene groove(phantom::groove(M_PI / 4), 0.25);
  const double mu = 0.3, z = r / std::sin(M_PI / 4);
  Proxy proxy(groove.surface, {.radius = r, .friction_static = mu, .friction_kinetic = mu},
              {0, 0, 6 * kMm});
  for (int n = 0; n <= 400; ++n)
    (void)proxy.step({0, 0, 6 * kMm + (z - deep - 6 * kMm) * (n / 400.0)});
  Touch touch;
  double y = 0;
  for (int n = 0; n < 4000; ++n) touch = proxy.step({0, y += 1e-6, z - deep});
  const double lag = y - touch.proxy.y();
  EXPECT_NEAR(lag / deep, mu / std::sin(M_PI / 4), 0.03 * mu / std::sin(M_PI / 4));
}

// Between walls that are nearly parallel the load of both is 11 times the push (half-angle 5
// degrees) and changes with every grain of the walls: friction counts twice the push at the most.
TEST_F(Friction, AWedgeHoldsNoHarderThanTwiceThePush) {
  const double half = 5 * M_PI / 180, mu = 0.3, z = r / std::sin(half);
  Scene wedge(phantom::groove(half), 0.25, z / kMm + 3);
  for (const double limit : {2.0, 0.0}) {
    Proxy proxy(wedge.surface,
                {.radius = r, .friction_static = mu, .friction_kinetic = mu, .wedge = limit},
                {0, 0, z + kMm});
    for (int n = 0; n <= 400; ++n) (void)proxy.step({0, 0, z + kMm - (deep + kMm) * (n / 400.0)});
    Touch touch;
    double y = 0;
    for (int n = 0; n < 6000; ++n) touch = proxy.step({0, y += 1e-6, z - deep});
    const double lag = (y - touch.proxy.y()) / deep;
    if (limit > 0)
      EXPECT_NEAR(lag, limit * mu, 0.03 * limit * mu);
    else
      EXPECT_GT(lag, 3.5 * mu);
  }
}

// ---- slips

Vec3 stretch_of(const Touch& touch) {
  return touch.touching ? Vec3(touch.depth * touch.normal + touch.tangential) : Vec3::Zero();
}

// A hand that is drawn to and fro over rough bone slips off again and again. The stretch, and with
// it the force, changes by the hand's own move and the allowed part; without a limit it leaps.
TEST(Slip, NeverChangesTheStretchFasterThanAllowed) {
  constexpr double kSlip = 30e-6;  // 30 mm/s at 1 kHz
  const Scene scene(phantom::gyroid(6 * kMm), 0.3, 9);
  for (const double slip : {kSlip, 0.0}) {
    Proxy proxy(scene.surface,
                {.radius = 1 * kMm, .friction_static = 0.4, .friction_kinetic = 0.36, .slip = slip},
                {0, 0, 14 * kMm});
    Vec3 hand(0, 0, 14 * kMm), last = Vec3::Zero();
    double most = 0;
    int touching = 0;
    for (int n = 0; n < 20'000; ++n) {
      const double t = n * 1e-3;
      const Vec3 next = n < 400 ? Vec3(0, 0, (14 - 6.5 * n / 400) * kMm)
                                : Vec3(5 * std::sin(4 * t), 5 * std::sin(2.7 * t), 7.5) * kMm;
      const Touch touch = proxy.step(next);
      const Vec3 stretch = stretch_of(touch);
      if (n > 0) most = std::max(most, (stretch - last).norm() - (next - hand).norm());
      touching += touch.touching ? 1 : 0;
      hand = next;
      last = stretch;
    }
    EXPECT_GT(touching, 2000);
    if (slip > 0)
      EXPECT_LE(most, kSlip * (1 + 1e-9));
    else
      EXPECT_GT(most, 10 * kSlip);
  }
}

// On a ball of radius R the place of a burr of radius r moves less than twice as far as a hand that is
// less than (R + r) / 2 deep, so the limit has nothing to do; slips over the facets of the voxels are
// left. The burr itself is never held back.
TEST(Slip, HardlyAnythingChangesOnABall) {
  const Scene scene(phantom::ball(6 * kMm), 0.3);
  Proxy limited(scene.surface, {.radius = 1.5 * kMm, .slip = 30e-6}, {0, 0, 10 * kMm}),
      free(scene.surface, {.radius = 1.5 * kMm}, {0, 0, 10 * kMm});
  double sum = 0, most = 0;
  for (int n = 0; n < 4000; ++n) {
    const double t = n * 1e-3;
    const Vec3 way(std::sin(3 * t), std::sin(2 * t), 1);
    const Vec3 hand = (7.2 + 0.9 * std::cos(5 * t)) * kMm * way.normalized();
    const Touch a = limited.step(hand), b = free.step(hand);
    const double apart = (stretch_of(a) - stretch_of(b)).norm();
    most = std::max(most, apart);
    sum += apart;
    ASSERT_EQ(a.proxy, b.proxy);
  }
  EXPECT_LT(sum / 4000, 0.5e-6);
  EXPECT_LT(most, 0.03e-3);
}

// Round a small ball the burr leaps to a hand that is far behind it: the force fades at the allowed
// speed, says that it presses on nothing, and then is exactly 0. A new place begins without memory of
// the old one.
TEST(Slip, FadesAfterASlipAndForgetsWithANewPlace) {
  constexpr double kSlip = 30e-6;
  const Scene scene(phantom::ball(1 * kMm), 0.25);
  Proxy proxy(scene.surface, {.radius = 1 * kMm, .slip = kSlip}, {0, 0, 4 * kMm});
  Touch touch;
  int pressed = 0, follows = 0;
  double last = 0;
  for (int n = 0; n <= 2000; ++n) {
    const double down = std::min(1.0, n / 400.0);
    touch = proxy.step({std::max(0, n - 400) * 2e-6, 0, (4 - 7 * down) * kMm});
    const double length = stretch_of(touch).norm();
    if (touch.active > 0) {
      EXPECT_FALSE(touch.slipping) << n;
      ++pressed;
    } else if (touch.touching) {
      EXPECT_TRUE(touch.slipping) << n;
      EXPECT_LE(length, last) << n;
      ++follows;
    }
    last = length;
  }
  EXPECT_GT(pressed, 100);
  EXPECT_GT(follows, 20);
  EXPECT_FALSE(touch.touching);
  proxy.place({0, 0, 8 * kMm});
  touch = proxy.step({0, 0, 8 * kMm});
  EXPECT_FALSE(touch.touching);
  EXPECT_EQ(stretch_of(touch), Vec3(Vec3::Zero()));
}

// ---- real-time rules of the tick

TEST(Proxy, TakesNeitherMemoryNorLock) {
  Scene scene(phantom::ball(5 * kMm), 0.25);
  Proxy proxy(scene.surface,
              {.radius = 1.5 * kMm, .friction_static = 0.3, .friction_kinetic = 0.25},
              {0, 0, 8 * kMm});
  const test::RtGuard guard;
  for (int n = 0; n < 3000; ++n) (void)proxy.step({3 * kMm * std::sin(0.01 * n), 0, 5 * kMm});
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

}  // namespace
}  // namespace burr::haptics
