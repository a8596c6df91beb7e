// burr verify friction - the friction cone, its effect in a groove, and that friction never gives
// energy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "burr/haptics/force_law.h"
#include "burr/haptics/proxy.h"
#include "burr/phantom/build.h"
#include "verify.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kMm = 1e-3, kRadius = 1.5 * kMm, kDeep = 0.4 * kMm;
// The hand moves from kAbove to kDown to press the burr straight down on a plane at z = 0.
const Vec3 kAbove(0, 0, 3 * kMm), kDown(0, 0, kRadius - kDeep);

struct Scene {
  explicit Scene(const phantom::Depth& depth)
      : bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-8 * kMm), Vec3::Constant(8 * kMm), 0.25 * kMm), {},
            depth)),
        surface(*bone, {}, 2, quiet) {}
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
};

std::unique_ptr<haptics::Proxy> press(const Scene& scene, double mu_static, double mu_kinetic,
                                      const Vec3& from, const Vec3& to) {
  haptics::ProxySettings settings;
  settings.radius = kRadius;
  settings.friction_static = mu_static;
  settings.friction_kinetic = mu_kinetic;
  auto proxy = std::make_unique<haptics::Proxy>(scene.surface, settings, from);
  for (int n = 0; n <= 200; ++n) (void)proxy->step(from + (to - from) * (n / 200.0));
  return proxy;
}

// The hand moves sideways by 0.1 um per tick until the burr slips.
void stick_and_slip(const Scene& plane, VerifyReport::Part& part) {
  Plot slip{
      "How far the burr trails behind the hand as this is moved aside at 0.1 mm/s: it sticks "
      "(slope 1) until the cone is reached at mu_s times the depth, then slides at mu_k.",
      1,
      {{"stick and slip", "hand aside / depth", "burr behind / depth", {}}}};
  for (const double mu : {0.1, 0.3, 0.8}) {
    const auto proxy = press(plane, mu, 0.9 * mu, kAbove, kDown);
    double slipped = 0;
    Line line{fmt::format("mu_s = {}", mu), {}, {}};
    haptics::Touch touch;
    for (int n = 0; n < 6000; ++n) {
      const double x = n * 0.1e-6;
      touch = proxy->step({x, 0, kDown.z()});
      if (slipped == 0 && !touch.stuck) slipped = x;
      if (n % 10 == 0) {
        line.x.push_back(x / kDeep);
        line.y.push_back(touch.tangential.norm() / kDeep);
      }
    }
    part.near(fmt::format("threshold.mu{}", mu), mu, slipped / kDeep, 0.01 * mu, "");
    part.near(fmt::format("sliding_lag.mu{}", mu), 0.9 * mu, touch.tangential.norm() / kDeep,
              0.01 * mu, "");
    slip.axes[0].lines.push_back(std::move(line));
  }
  part.plot(std::move(slip));
}

// Slopes just below and above the threshold, under a constant force straight down.
void slopes(VerifyReport::Part& part) {
  for (const double mu : {0.2, 0.5}) {
    for (const double share : {0.98, 1.02}) {
      const double slope = std::atan(share * mu);
      const Vec3 n(std::sin(slope), 0, std::cos(slope));
      const Scene tilted(phantom::slab(n));
      const Vec3 rest = kRadius * n;
      const auto proxy = press(tilted, mu, mu, rest + 3 * kMm * n, rest);
      Vec3 hand = rest;
      const double spring = 0.5 * kMm;  // at a constant force the hand stays this far below
      for (int t = 0; t < 4000; ++t) {
        hand = proxy->position() - Vec3(0, 0, spring * std::min(1.0, t / 500.0));
        (void)proxy->step(hand);
      }
      const double went = (proxy->position() - rest).norm();
      if (share < 1)
        part.at_most(fmt::format("slope_holds.mu{}", mu), 0.02, 1e3 * went, "mm");
      else
        part.at_least(fmt::format("slope_slides.mu{}", mu), 0.1, 1e3 * went, "mm");
    }
  }
}

// A groove presses with more than the hand's force: the threshold is mu / sin A.
void grooves(VerifyReport::Part& part) {
  for (const double half_deg : {45.0, 30.0}) {
    const double mu = 0.3, half = half_deg * M_PI / 180, z = kRadius / std::sin(half);
    const Scene groove(phantom::groove(half));
    const auto proxy = press(groove, mu, 0.9 * mu, {0, 0, z + 2 * kMm}, {0, 0, z - kDeep});
    double slipped = 0;
    for (int n = 0; n < 12000 && slipped == 0; ++n) {
      const double y = n * 0.1e-6;
      if (!proxy->step({0, y, z - kDeep}).stuck) slipped = y;
    }
    part.near(fmt::format("groove{:.0f}.holds", 2 * half_deg), mu / std::sin(half), slipped / kDeep,
              0.03 * mu / std::sin(half), "");
  }
}

// Held below the threshold for a minute, with the tremor of a hand.
void drift(const Verify& verify, const Scene& plane, VerifyReport::Part& part) {
  const auto proxy = press(plane, 0.5, 0.45, kAbove, kDown);
  const Vec3 began = proxy->position();
  const int ticks = verify.quick ? 10'000 : 60'000;
  for (int n = 0; n < ticks; ++n) {
    const double t = 1e-3 * n;
    (void)proxy->step(kDown + Vec3(0.1 * kDeep * std::sin(2 * M_PI * 9 * t),
                                   0.1 * kDeep * std::sin(2 * M_PI * 7.3 * t), 0));
  }
  part.at_most("drift", 1e-3, 1e3 * (proxy->position() - began).norm(), "mm");
}

// In circles: the energy that friction takes is never negative; without friction it is zero.
void energy(const Scene& plane, VerifyReport::Part& part) {
  for (const double mu : {0.0, 0.3}) {
    const auto proxy = press(plane, mu, mu, kAbove, kDown);
    Vec3 last(0, 0, kDown.z()), felt(0, 0, 1000 * kDeep);
    double taken = 0, lowest = 0, most = 0;
    for (int n = 0; n <= 5000; ++n) {
      const double t = 1e-3 * n, round = 2 * M_PI * t;
      const Vec3 hand((1 - std::cos(round)) * kMm, std::sin(round) * kMm,
                      kDown.z() + 0.2 * kMm * std::sin(3 * round));
      const haptics::Touch touch = proxy->step(hand);
      const Vec3 force = haptics::force_law(touch, Vec3::Zero(), {1000, 0});
      taken -= 0.5 * (force + felt).dot(hand - last);
      felt = force;
      const double stored = 500 * (touch.depth * touch.depth + touch.tangential.squaredNorm());
      lowest = std::min(lowest, taken - stored + 500 * kDeep * kDeep);
      most = std::max(most, stored);
      last = hand;
    }
    if (mu > 0)
      part.at_least("dissipated.least", -1e-3 * 1e6 * most, 1e6 * lowest, "uJ");
    else
      part.near("closed_loop_without_friction", 0, taken / most, 1e-3, "of the most stored");
  }
}

void friction(const Verify& verify, VerifyReport::Part& part) {
  const Scene plane(phantom::slab());
  stick_and_slip(plane, part);
  slopes(part);
  grooves(part);
  drift(verify, plane, part);
  energy(plane, part);
}

const VerifyPart part{40, "friction", "Friction",
                      "The friction cone (Harwin and Melder 2002) at known coefficients: when a "
                      "held burr slips, how far a sliding burr lags behind, slopes on either side "
                      "of the threshold, grooves, drift, and energy.",
                      friction};

}  // namespace
}  // namespace burr::app
