// The energy law against its formula, written down once more, and against what it must conserve.
#include "burr/edit/laws/removal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burr::edit {
namespace {

using math::Vec3;

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

// Velocity of the burr's surface where it touches. Clockwise seen from the hand is a turn about
// -axis; the bone lies along -normal from the centre.
Vec3 surface_velocity(const Vec3& normal, const Spin& spin, double radius) {
  return Vec3(-spin.speed * spin.axis).cross(Vec3(-radius * normal));
}

TEST(EnergyLaw, IsItsFormulaAndItsDragDoesExactlyItsWork) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  RemovalSettings settings;
  settings.max_power = 5;
  int full = 0, poles = 0;
  for (int round = 0; round < 2000; ++round) {
    const double push = 10 * unit(random), radius = 0.5e-3 + 3e-3 * unit(random),
                 friction = unit(random), dt = 1e-4 + 1e-3 * unit(random);
    const Spin spin = {direction(random), 8000 * (2 * unit(random) - 1)};
    const Vec3 normal = direction(random);
    const Cutting cutting = energy_law(push, spin, radius, friction, normal, dt, settings);

    const double sine = std::sin(std::acos(std::clamp(normal.dot(spin.axis), -1.0, 1.0)));
    const double effective = radius * std::max(sine, settings.pole);
    const double wanted = friction * push * std::abs(spin.speed) * effective;
    EXPECT_NEAR(cutting.power, std::min(wanted, 5.0), 1e-9);
    EXPECT_NEAR(cutting.energy, cutting.power * dt, 1e-15);
    EXPECT_NEAR(cutting.torque * std::abs(spin.speed), cutting.power, 1e-9);
    EXPECT_EQ(cutting.ripple, 0);

    // along the surface, against the way it slides
    EXPECT_NEAR(cutting.drag.dot(normal), 0, 1e-12);
    EXPECT_NEAR(cutting.drag.dot(spin.axis), 0, 1e-12);
    const Vec3 velocity = surface_velocity(normal, spin, radius);
    EXPECT_LE(cutting.drag.dot(velocity), 0);
    if (sine > settings.pole) {
      EXPECT_NEAR(-cutting.drag.dot(velocity), cutting.power, 1e-8);
    } else {
      EXPECT_LE(-cutting.drag.dot(velocity), cutting.power) << "near the pole it hardly slides";
    }
    full += wanted > 5 ? 1 : 0;
    poles += sine < settings.pole ? 1 : 0;
  }
  EXPECT_GT(full, 50);
  EXPECT_GT(poles, 2);
}

TEST(EnergyLaw, TurnsWithTheWorldAndBackwardsWithTheSpindle) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 200; ++round) {
    const Spin spin = {direction(random), 3000};
    const Vec3 normal = direction(random);
    const Cutting here = energy_law(2, spin, 2e-3, 0.3, normal, 1e-3, {});
    const Eigen::AngleAxisd turn(1 + round, direction(random));
    const Cutting there =
        energy_law(2, {turn * spin.axis, spin.speed}, 2e-3, 0.3, turn * normal, 1e-3, {});
    EXPECT_NEAR(there.energy, here.energy, 1e-12);
    EXPECT_NEAR((there.drag - turn * here.drag).norm(), 0, 1e-9);
    const Cutting back = energy_law(2, {spin.axis, -spin.speed}, 2e-3, 0.3, normal, 1e-3, {});
    EXPECT_EQ(back.energy, here.energy);
    EXPECT_EQ(back.torque, here.torque);
    EXPECT_EQ(back.drag, Vec3(-here.drag));
  }
}

TEST(EnergyLaw, CutsNothingWithoutPushSpeedOrFriction) {
  const Spin turning = {Vec3::UnitZ(), 4000}, standing = {Vec3::UnitZ(), 0};
  for (const Cutting& cutting : {energy_law(0, turning, 2e-3, 0.3, Vec3::UnitX(), 1e-3, {}),
                                 energy_law(2, standing, 2e-3, 0.3, Vec3::UnitX(), 1e-3, {}),
                                 energy_law(2, turning, 2e-3, 0, Vec3::UnitX(), 1e-3, {}),
                                 energy_law(-1, turning, 2e-3, 0.3, Vec3::UnitX(), 1e-3, {})}) {
    EXPECT_EQ(cutting.energy, 0);
    EXPECT_EQ(cutting.power, 0);
    EXPECT_EQ(cutting.torque, 0);
    EXPECT_EQ(cutting.drag, Vec3(Vec3::Zero()));
  }
}

TEST(RemovalLaw, NamesAreTheirNumbers) {
  for (int n = 0; n < kLaws; ++n)
    EXPECT_EQ(law_named(kLawNames[static_cast<std::size_t>(n)]), static_cast<RemovalLaw>(n));
  EXPECT_FALSE(law_named("").has_value());
  EXPECT_FALSE(law_named("Energy").has_value());
}

}  // namespace
}  // namespace burr::edit
