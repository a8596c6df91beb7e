// The energy law of any shape: docs/understand/cutting.md, "Tools of any shape".
#include "burr/edit/laws/elements.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace burr::edit {
namespace {

using math::Vec3;

constexpr double kDt = 1e-3;

TEST(Elements, OneContactOfABallIsTheEnergyLawOfABurr) {
  const double r = 2e-3, force = 1.3, mu = 0.4, speed = 4000;
  const RemovalSettings settings;
  for (const double angle : {0.4, 1.0, 1.5}) {  // from the axis, beyond the pole's least sine
    for (const double way : {1.0, -1.0}) {
      const Vec3 normal = -Vec3(std::sin(angle), 0, std::cos(angle));  // out of the bone
      const Spin spin = {Vec3::UnitZ(), way * speed};
      const Cutting want = energy_law(force, spin, r, mu, normal, kDt, settings);
      const std::array<ElementContact, 1> contact = {{{-r * normal, normal, force, mu}}};
      const ElementCutting got =
          element_law({}, {.axis = spin.axis, .speed = spin.speed}, contact, kDt, settings);
      EXPECT_NEAR(got.power, want.power, 1e-9 * want.power);
      EXPECT_NEAR(got.torque, want.torque, 1e-9 * want.torque);
      EXPECT_NEAR((got.drag - want.drag).norm(), 0, 1e-9 * want.drag.norm());
      // the drag's moment about the axis is what brakes the spindle
      EXPECT_NEAR(std::abs(got.moment.z()), want.torque, 1e-9 * want.torque);
    }
  }
}

TEST(Elements, TheLoadSharedByManyContactsCutsAsMuchAsInOne) {
  const RemovalSettings settings;
  const Stroke stroke = {.way = Vec3::UnitX(), .speed = 0.98};
  tool::Cutter saw;
  saw.drive = tool::Drive::oscillating;
  const std::array<ElementContact, 1> one = {{{{0, 0, 0}, Vec3::UnitZ(), 3, 0.4}}};
  const std::array<ElementContact, 3> three = {{{{-4e-3, 0, 0}, Vec3::UnitZ(), 2, 0.4},
                                                {{0, 0, 0}, Vec3::UnitZ(), 0.5, 0.4},
                                                {{4e-3, 0, 0}, Vec3::UnitZ(), 0.5, 0.4}}};
  const ElementCutting a = element_law(saw, stroke, one, kDt, settings);
  const ElementCutting b = element_law(saw, stroke, three, kDt, settings);
  EXPECT_NEAR(a.power, 3 * 0.4 * 0.98, 1e-12);
  EXPECT_NEAR(a.power, b.power, 1e-12);
  EXPECT_EQ(a.drag, Vec3::Zero().eval()) << "a stroke pulls and pushes in turn";
  EXPECT_NEAR(a.ripple, 1.2, 1e-12);
}

TEST(Elements, AnEdgeCutsInItsDirectionOnly) {
  const RemovalSettings settings;
  tool::Cutter curette;
  curette.drive = tool::Drive::pushed;
  const std::array<ElementContact, 1> contact = {{{{0, 0, 0}, Vec3::UnitZ(), 2, 0.4}}};
  const auto power = [&](const Vec3& hand) {
    return element_law(curette, {.way = Vec3::UnitX(), .hand = hand}, contact, kDt, settings).power;
  };
  EXPECT_NEAR(power({0.05, 0, 0}), 2 * 0.4 * 0.05, 1e-12);
  EXPECT_EQ(power({-0.05, 0, 0}), 0);
  EXPECT_EQ(power({0, 0.05, 0}), 0);
  EXPECT_EQ(power({0, 0, 0}), 0) << "held still it cuts nothing";
}

TEST(Elements, TheMotorHasAMostPower) {
  RemovalSettings settings;
  settings.max_power = 5;
  const std::array<ElementContact, 2> contacts = {
      {{{2e-3, 0, 0}, -Vec3::UnitX(), 4, 0.4}, {{-2e-3, 0, 0}, Vec3::UnitX(), 4, 0.4}}};
  const ElementCutting cutting = element_law({}, {.speed = 4000}, contacts, kDt, settings);
  EXPECT_EQ(cutting.power, 5);
  EXPECT_NEAR(cutting.torque, 5.0 / 4000, 1e-12);
  EXPECT_NEAR(std::abs(cutting.moment.z()), 5.0 / 4000, 1e-12) << "a couple, without a force";
  EXPECT_NEAR(cutting.drag.norm(), 0, 1e-12);
}

}  // namespace
}  // namespace burr::edit
