// The chips law compared with its own integrals, computed again finely and in another way, and with
// measurements on bone.
#include "burr/edit/laws/chip_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "support/rt_guard.h"

namespace burr::edit {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kRpm = 2 * M_PI / 60;
constexpr double kDt = 1e-3;

std::unique_ptr<volume::Bone> bone_of(const phantom::Depth& depth, double h_mm = 0.2,
                                      const volume::TissueTable& tissues = {}) {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-5 * kMm), Vec3::Constant(5 * kMm), h_mm * kMm), tissues,
      depth);
}
const phantom::Depth kEverywhere = [](const Vec3&) { return 4 * kMm; };
const volume::CuttingForce kForce = volume::Tissue{}.force;

// The same integral by azimuth around the shaft and height along it, where a piece of the ball is
// dA = r dz dphi. The pieces in bone follow from the shape's formula: no rings, no field.
struct Fine {
  double thrust = 0, torque = 0, rate = 0, edge = 0;
  Vec3 drag = Vec3::Zero();
  std::complex<double> swing = 0;
};
Fine fine(const tool::Burr& burr, const Vec3& centre, const Vec3& normal, const Spin& spin,
          double feed, const phantom::Depth& depth, double reach, double pole) {
  constexpr int kHigh = 600, kRound = 600;
  Fine all;
  const Vec3 x = spin.axis.unitOrthogonal(), y = spin.axis.cross(x);
  const double r = burr.radius;
  for (int a = 0; a < kHigh; ++a) {
    const double z = -1 + 2 * (a + 0.5) / kHigh, rho = std::sqrt(1 - z * z);
    for (int b = 0; b < kRound; ++b) {
      const double phi = 2 * M_PI * (b + 0.5) / kRound;
      const Vec3 way = rho * (std::cos(phi) * x + std::sin(phi) * y) + z * spin.axis;
      const double cosine = -way.dot(normal);
      if (cosine <= 0) continue;
      const double in_bone = std::clamp(1 + depth(centre + r * way) / reach, 0.0, 1.0);
      const double area = in_bone * r * r * (2.0 / kHigh) * (2 * M_PI / kRound);
      const double far = std::max(rho, pole), edge = area * burr.teeth / (2 * M_PI * r * far);
      const double chip = feed * cosine, share = 1 - std::exp(-chip / kForce.edge_onset);
      const double across = kForce.chip_radial * chip + kForce.edge_radial * share,
                   along = kForce.chip_tangential * chip + kForce.edge_tangential * share;
      all.edge += edge;
      all.thrust += edge * across * cosine;
      all.torque += edge * along * r * far;
      all.rate += edge * chip * r * far * spin.speed;
      // the surface slides along w x p, with w against the axis: the bone pulls the opposite way
      all.drag += edge * along / far * spin.axis.cross(way);
      all.swing += edge * along * std::polar(1.0, burr.teeth * phi);
    }
  }
  all.drag -= all.drag.dot(normal) * normal;
  return all;
}

struct Place {
  const char* what;
  phantom::Depth depth;
  Vec3 centre, axis;
  double tolerance;
};
std::vector<Place> places() {
  const Vec3 upright(0, 0, 1), aslant = Vec3(1, 0.3, 1.2).normalized();
  return {{"wholly in bone, shaft along the push", kEverywhere, {0, 0, 0}, upright, 0.03},
          {"wholly in bone, shaft aslant", kEverywhere, {0, 0, 0}, aslant, 0.03},
          {"half in", phantom::slab(), {0.1 * kMm, 0, 0}, aslant, 0.03},
          {"a third of the radius in", phantom::slab(), {0, 0, 1 * kMm}, aslant, 0.05},
          {"just touching", phantom::slab(), {0, 0, 1.5 * kMm}, aslant, 0.12}};
}

TEST(Chips, TheThrustOfAllTeethIsThePushAndTheRestFollows) {
  const tool::Burr burr = {.radius = 1.5 * kMm};
  const RemovalSettings settings;
  const Vec3 normal(0, 0, 1);
  for (const Place& place : places()) {
    const auto bone = bone_of(place.depth, 0.1);
    Chips chips(*bone);
    for (const double push : {0.3, 1.0, 3.0}) {
      SCOPED_TRACE(testing::Message() << place.what << ", " << push << " N");
      const Spin spin = {place.axis, 40000 * kRpm};
      const Cutting cutting = chips.step(burr, place.centre, normal, push, spin, kDt, settings);
      ASSERT_GT(chips.feed_per_tooth(), 0);
      const Fine truth = fine(burr, place.centre, normal, spin, chips.feed_per_tooth(), place.depth,
                              50e-6, settings.pole);
      const double all = place.tolerance;
      EXPECT_NEAR(truth.thrust / push, 1, all);
      EXPECT_NEAR(chips.edge_length() / truth.edge, 1, all);
      EXPECT_NEAR(cutting.torque / truth.torque, 1, all);
      EXPECT_NEAR(chips.removal_rate() / truth.rate, 1, all);
      EXPECT_NEAR(cutting.energy, chips.removal_rate() * kDt * 1e9, 1e-9 * cutting.energy);
      EXPECT_NEAR(cutting.power, cutting.torque * spin.speed, 1e-12);
      EXPECT_LT((cutting.drag - truth.drag).norm(), all * push);
      EXPECT_NEAR(cutting.ripple, 2 * std::abs(truth.swing), 0.05 * push + all * cutting.ripple);
      EXPECT_NEAR(cutting.drag.dot(normal), 0, 1e-12);
    }
  }
}

// Wholly in bone, with the shaft along the push: the edge is z quarter circles, and the rate is the
// ball's projected area times z w f / 2 pi.
TEST(Chips, InTheOpenTheIntegralsAreKnownByHeart) {
  const auto bone = bone_of(kEverywhere);
  Chips chips(*bone);
  const tool::Burr burr = {.radius = 2 * kMm, .teeth = 6};
  RemovalSettings settings;
  settings.pole = 1e-3;
  const Spin spin = {Vec3::UnitZ(), 30000 * kRpm};
  const Cutting cutting = chips.step(burr, Vec3::Zero(), Vec3::UnitZ(), 2, spin, kDt, settings);
  EXPECT_NEAR(chips.edge_length(), 6 * M_PI / 2 * burr.radius, 0.01 * chips.edge_length());
  const double feed = chips.feed_per_tooth() * 6 * spin.speed / (2 * M_PI);
  EXPECT_NEAR(chips.removal_rate(), feed * M_PI * burr.radius * burr.radius,
              0.005 * chips.removal_rate());
  EXPECT_LT(cutting.drag.norm(), 1e-3) << "all around alike";
}

// The teeth turned through one pitch in steps: the ripple is the first harmonic of their force.
TEST(Chips, TheRippleIsWhatTheTeethFeelOneAfterTheOther) {
  const auto bone = bone_of(phantom::slab(), 0.1);
  const Vec3 normal(0, 0, 1), centre(0, 0, 1.2 * kMm);
  for (const int teeth : {1, 2, 4, 8}) {
    const tool::Burr burr = {.radius = 1.5 * kMm, .teeth = teeth};
    const Spin spin = {Vec3::UnitX(), 10000 * kRpm};
    Chips chips(*bone);
    const Cutting cutting = chips.step(burr, centre, normal, 1, spin, kDt, {});
    // one meridian at azimuth phi: the force on its edge, by arc length
    const Vec3 x = spin.axis.unitOrthogonal(), y = spin.axis.cross(x);
    const auto of_one = [&](double phi) {
      double force = 0;
      for (int n = 0; n < 400; ++n) {
        const double theta = M_PI * (n + 0.5) / 400;
        const Vec3 way =
            std::sin(theta) * (std::cos(phi) * x + std::sin(phi) * y) + std::cos(theta) * spin.axis;
        const double chip = -way.dot(normal) * chips.feed_per_tooth();
        if (chip <= 0) continue;
        const double depth = -(centre + burr.radius * way).z();
        force += std::clamp(1 + depth / 50e-6, 0.0, 1.0) * burr.radius * M_PI / 400 *
                 (kForce.chip_tangential * chip +
                  kForce.edge_tangential * (1 - std::exp(-chip / kForce.edge_onset)));
      }
      return force;
    };
    std::complex<double> harmonic = 0;
    constexpr int kSteps = 720;
    for (int n = 0; n < kSteps; ++n) {
      const double turn = 2 * M_PI * n / kSteps;
      double all = 0;
      for (int tooth = 0; tooth < teeth; ++tooth) all += of_one(turn + 2 * M_PI * tooth / teeth);
      harmonic += all * std::polar(2.0 / kSteps, -turn * teeth);
    }
    EXPECT_NEAR(cutting.ripple / std::abs(harmonic), 1, 0.08) << teeth;
  }
}

// James et al. 2013 on bovine cortical bone, as used in docs/understand/cutting.md, "Chips": some
// 0.9 J/mm^3 for chips of 10 um and 3 for 2.5 um; speed has no effect.
TEST(Chips, ThinChipsCostMoreAsMeasuredOnBone) {
  const auto energy = [](double chip) {
    return kForce.chip_tangential +
           kForce.edge_tangential * (1 - std::exp(-chip / kForce.edge_onset)) / chip;
  };
  EXPECT_NEAR(energy(10e-6), 0.9e9, 0.1e9);
  EXPECT_NEAR(energy(2.5e-6), 3e9, 0.3e9);

  const auto bone = bone_of(phantom::slab());
  const tool::Burr burr = {.radius = 2 * kMm};
  const Vec3 centre(0, 0, 1.9 * kMm);
  double last = 1e12, torque = 0;
  for (const double push : {0.2, 1.0, 5.0, 20.0}) {
    Chips chips(*bone);
    RemovalSettings settings;
    settings.max_power = 1e6;
    const Cutting cutting =
        chips.step(burr, centre, Vec3::UnitZ(), push, {Vec3::UnitX(), 40000 * kRpm}, kDt, settings);
    const double u = cutting.power / chips.removal_rate();
    EXPECT_LT(u, last) << push;
    last = u;
    const Cutting slow =
        chips.step(burr, centre, Vec3::UnitZ(), push, {Vec3::UnitX(), 10000 * kRpm}, kDt, settings);
    EXPECT_NEAR(slow.torque, cutting.torque, 1e-9 * cutting.torque) << "speed changes no force";
    EXPECT_NEAR(slow.energy, cutting.energy / 4, 1e-9 * cutting.energy);
    EXPECT_GT(cutting.torque, torque);
    torque = cutting.torque;
  }
}

TEST(Chips, HarderBoneGivesThinnerChipsAndTissuesAreEachTheirOwn) {
  volume::TissueTable tissues;
  tissues.tissues[1].cutting_energy = 3e9;
  for (double* one :
       {&tissues.tissues[1].force.chip_tangential, &tissues.tissues[1].force.chip_radial,
        &tissues.tissues[1].force.edge_tangential, &tissues.tissues[1].force.edge_radial})
    *one *= 3;
  const auto hard = bone_of(kEverywhere, 0.2, tissues), soft = bone_of(kEverywhere);
  const tool::Burr burr = {.radius = 2 * kMm};
  Chips in_hard(*hard), in_soft(*soft);
  const Spin spin = {Vec3::UnitX(), 40000 * kRpm};
  const Cutting a = in_hard.step(burr, Vec3::Zero(), Vec3::UnitZ(), 3, spin, kDt, {});
  const Cutting b = in_soft.step(burr, Vec3::Zero(), Vec3::UnitZ(), 1, spin, kDt, {});
  // three times the constants and three times the push: the same chips, three times the energy
  EXPECT_NEAR(in_hard.feed_per_tooth(), in_soft.feed_per_tooth(), 1e-6 * in_soft.feed_per_tooth());
  EXPECT_NEAR(a.energy, 3 * b.energy, 1e-6 * a.energy);
  EXPECT_NEAR(a.torque, 3 * b.torque, 1e-6 * a.torque);
}

TEST(Chips, WithoutPushTeethSpeedOrBoneNothingIsCut) {
  const auto bone = bone_of(phantom::slab());
  Chips chips(*bone);
  tool::Burr burr = {.radius = 2 * kMm};
  const Vec3 at(0, 0, 1.9 * kMm), up(0, 0, 1);
  const Spin spin = {Vec3::UnitX(), 40000 * kRpm};
  const auto cuts = [&](const tool::Burr& with, const Vec3& where, double push, const Spin& as) {
    const Cutting cutting = chips.step(with, where, up, push, as, kDt, {});
    return cutting.energy > 0 || cutting.torque > 0 || cutting.drag.norm() > 0;
  };
  EXPECT_TRUE(cuts(burr, at, 1, spin));
  EXPECT_FALSE(cuts(burr, at, 0, spin));
  EXPECT_FALSE(cuts(burr, at, NAN, spin));
  EXPECT_FALSE(cuts(burr, at, 1, {Vec3::UnitX(), 0}));
  EXPECT_FALSE(cuts(burr, at, 1, {Vec3::UnitX(), -100})) << "flutes do not cut backwards";
  EXPECT_FALSE(cuts(burr, {0, 0, 3 * kMm}, 1, spin)) << "in the air";
  EXPECT_FALSE(cuts(burr, {50 * kMm, 0, 0}, 1, spin)) << "outside the grid";
  burr.teeth = 0;
  EXPECT_FALSE(cuts(burr, at, 1, spin));
  burr = {.radius = 2 * kMm, .kind = tool::BurrKind::diamond};
  EXPECT_FALSE(cuts(burr, at, 1, spin)) << "grains are not teeth";
}

TEST(Chips, TheMotorsPowerIsTheLimit) {
  const auto bone = bone_of(kEverywhere);
  Chips chips(*bone);
  RemovalSettings settings;
  settings.max_power = 5;
  const Cutting cutting = chips.step({.radius = 2 * kMm}, Vec3::Zero(), Vec3::UnitZ(), 30,
                                     {Vec3::UnitX(), 80000 * kRpm}, kDt, settings);
  EXPECT_NEAR(cutting.power, 5, 1e-6);
}

TEST(Chips, TakeNoMemory) {
  const auto bone = bone_of(phantom::slab());
  Chips chips(*bone);
  const test::RtGuard guard;
  for (int n = 0; n < 50; ++n)
    static_cast<void>(chips.step({.radius = 2 * kMm}, {0, 0, (2 - 0.01 * n) * kMm}, Vec3::UnitZ(),
                                 1, {Vec3::UnitX(), 4000}, kDt, {}));
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

// ---- level 1: forces of the bone on the burr

constexpr double kFriction = 0.35;

TEST(EnergyLaw, TheDragIsFrictionAgainstTheWayTheSurfaceSlides) {
  const RemovalSettings settings;
  const Vec3 normal(0, 0, 1);
  // the shaft along x: forward, the rotation is along -x, and the burr's underside slides along
  // (-x) x (-z) = -y: it is pulled along +y
  const Spin spin = {Vec3::UnitX(), 4000};
  const Cutting cut = energy_law(2, spin, 2 * kMm, kFriction, normal, kDt, settings);
  EXPECT_NEAR((cut.drag - Vec3(0, -1, 0) * kFriction * 2).norm() *
                  (cut.drag - Vec3(0, 1, 0) * kFriction * 2).norm(),
              0, 1e-12);
  const Vec3 w = -spin.axis * spin.speed, slides = w.cross(-normal * 2 * kMm);
  EXPECT_NEAR(cut.drag.dot(slides), -cut.power, 1e-12) << "what the motor gives, the drag takes";
  EXPECT_NEAR(cut.torque * spin.speed, cut.power, 1e-12);
  const Cutting back =
      energy_law(2, {Vec3::UnitX(), -4000}, 2 * kMm, kFriction, normal, kDt, settings);
  EXPECT_EQ(back.drag, -cut.drag);
  EXPECT_EQ(tool::cutting_efficiency(tool::BurrKind::cutting, -1), 0) << "flutes cut one way";
  EXPECT_EQ(tool::cutting_efficiency(tool::BurrKind::diamond, -1),
            tool::cutting_efficiency(tool::BurrKind::diamond, 1));
}

TEST(EnergyLaw, AtThePoleThereIsHardlyAWayToSlide) {
  const RemovalSettings settings;
  const Cutting pole =
      energy_law(1, {Vec3::UnitZ(), 4000}, 2 * kMm, kFriction, Vec3::UnitZ(), kDt, settings);
  EXPECT_EQ(pole.drag, Vec3::Zero());
  EXPECT_GT(pole.power, 0);
  double last = 0;
  for (int n = 0; n <= 20; ++n) {  // from the pole to the side: grows without a jump
    const double angle = 0.5 * M_PI * n / 20;
    const Spin spin = {Vec3(std::sin(angle), 0, std::cos(angle)), 4000};
    const double now =
        energy_law(1, spin, 2 * kMm, kFriction, Vec3::UnitZ(), kDt, settings).drag.norm();
    EXPECT_GE(now, last - 1e-12);
    EXPECT_LE(now, kFriction + 1e-12);
    last = now;
  }
  EXPECT_NEAR(last, kFriction, 1e-12);
}

}  // namespace
}  // namespace burr::edit
