// Springs with a lever, compared with the eigenvalues of the exact sampled system; and the limit of
// a wrench.
#include "burr/haptics/safety/lever.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "burr/haptics/safety/coupling.h"

namespace burr::haptics {
namespace {

using math::Vec3;

constexpr double kMass = 0.09, kInertia = 1e-4, kTurnStiffness = 0.3;
constexpr Wrist kWrist = {.damping = 1, .turn_damping = 1e-3, .delay = 0, .rate_hz = 1000};

// One step of the plane (place, speed, angle, rate), with the spring's force held for the tick.
Eigen::Matrix4d step_of(const Wrist& wrist, double k_t, double k_r, double lever, bool turns,
                        double inertia = kInertia) {
  const double T = 1 / wrist.rate_hz;
  Eigen::Matrix4d free = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 2> pushed = Eigen::Matrix<double, 4, 2>::Zero();
  const auto axis = [&](int at, int input, double mass, double damping) {
    const double decay = std::exp(-damping * T / mass), time = mass / damping;
    free(at, at) = 1;
    free(at, at + 1) = time * (1 - decay);
    free(at + 1, at + 1) = decay;
    pushed(at, input) = (T - time * (1 - decay)) / damping;
    pushed(at + 1, input) = (1 - decay) / damping;
  };
  axis(0, 0, kMass, wrist.damping);
  axis(2, 1, inertia, wrist.turn_damping);
  // the tip is at place + lever * angle
  Eigen::Matrix<double, 2, 4> force = Eigen::Matrix<double, 2, 4>::Zero();
  force(0, 0) = -k_t;
  force(0, 2) = -k_t * lever;
  if (turns) {
    force(1, 0) = -k_t * lever;
    force(1, 2) = -k_t * lever * lever - k_r;
  }
  return free + pushed * force;
}

// Stable, or at rest: a hand that is not turned keeps its angle for ever.
bool dies_away(const Eigen::Matrix4d& step) {
  const Eigen::Vector4cd all = Eigen::EigenSolver<Eigen::Matrix4d>(step, false).eigenvalues();
  return all.cwiseAbs().maxCoeff() <= 1 + 1e-9;
}

double border(const Wrist& wrist, double k_r, double lever, bool turns, double inertia = kInertia) {
  double low = 1, high = 20'000;
  while (high - low > 1e-3 * low) {
    const double middle = 0.5 * (low + high);
    (dies_away(step_of(wrist, middle, k_r, lever, turns, inertia)) ? low : high) = middle;
  }
  return low;
}

TEST(Lever, TheFormulaIsTheBorderOfTheSampledSystem) {
  double last = 1e9;
  for (const double lever : {0.0, 0.02, 0.05, 0.1, 0.15}) {
    const double formula = stiffest_at_lever(kWrist, kTurnStiffness, lever);
    EXPECT_NEAR(border(kWrist, kTurnStiffness, lever, true), formula, 0.02 * formula)
        << "lever " << lever;
    EXPECT_LT(formula, last);
    last = formula;
  }
  EXPECT_NEAR(stiffest_at_lever(kWrist, kTurnStiffness, 0), 2000, 1e-9);
  EXPECT_NEAR(stiffest_at_lever(kWrist, kTurnStiffness, 0.1), 157, 1);
}

TEST(Lever, WithoutActuatedTurningThereIsNone) {
  Wrist wrist = kWrist;
  wrist.turn_damping = 0;
  EXPECT_NEAR(stiffest_at_lever(wrist, kTurnStiffness, 0.1), 2000, 1e-9);
  EXPECT_NEAR(border(kWrist, kTurnStiffness, 0.1, false), 2000, 0.02 * 2000);
}

TEST(Lever, AChosenSpringKeepsItsMargin) {
  for (const double lever : {0.0, 0.05, 0.15}) {
    const LeverSprings springs = springs_at_lever(kWrist, 1e6, 1e6, lever);
    EXPECT_NEAR(springs.turn_stiffness, 2.0 / 3, 1e-9);
    EXPECT_NEAR(springs.stiffness, 0.7 * springs.border, 1e-9);
    EXPECT_TRUE(dies_away(step_of(kWrist, springs.stiffness, springs.turn_stiffness, lever, true)));
  }
  const LeverSprings soft = springs_at_lever(kWrist, 100, 0.1, 0.02);
  EXPECT_EQ(soft.stiffness, 100);
  EXPECT_EQ(soft.turn_stiffness, 0.1);
  EXPECT_EQ(stiffest_at_lever(kWrist, 3, 0.1), 0) << "stiffer than turning alone allows";
}

// What coupling.h chooses for a device is stable in the exact plane of that device.
TEST(Coupling, IsBelowTheBorderOfTheDeviceAndNoStifferThanAsked) {
  for (const double damping : {0.0, 2e-4, 1e-3})
    for (const double lever : {0.0, 0.03, 0.12}) {
      device::DeviceSpec device;
      device.peak_torque = 0.2;
      device.max_stiffness = 1000;
      device.turn_damping = damping;
      device.lever = lever;
      const Coupling springs = coupling_of(device, 5000, 1000);
      EXPECT_EQ(springs.measured, damping > 0);
      const double bears = damping > 0 ? 2 * damping * 1000 : 0.3;  // C
      EXPECT_NEAR(springs.turn_stiffness, std::min(damping > 0 ? 0.3 : 0.1, bears / 3), 1e-12);
      const Wrist wrist = {.damping = 0.5e-3 * 1000 / 0.7,
                           .turn_damping = 0.5e-3 * bears,
                           .delay = 0,
                           .rate_hz = 1000};
      // exact where inertia and damping are in proportion; any other inertia bears more
      const double even = kMass * wrist.turn_damping / wrist.damping;
      const double edge = border(wrist, springs.turn_stiffness, lever, true, even);
      for (const double times : {0.3, 3.0})
        EXPECT_GT(border(wrist, springs.turn_stiffness, lever, true, times * even), 0.98 * edge);
      EXPECT_NEAR(springs.border, edge, 0.02 * edge) << damping << " " << lever;
      EXPECT_NEAR(springs.stiffness, std::min(1000.0, 0.7 * springs.border), 1e-6);
      EXPECT_NEAR(springs.lever * springs.lever * springs.stiffness, springs.turn_stiffness, 1e-12);
      EXPECT_EQ(coupling_of(device, 5, 1000).stiffness, 5);
    }
  device::DeviceSpec table;
  table.peak_torque = 0.2;
  table.max_turn_stiffness = 0.04;
  EXPECT_EQ(coupling_of(table, 1000, 1000).turn_stiffness, 0.04);
  const Coupling pushes = coupling_of(device::DeviceSpec(), 5000, 1000);
  EXPECT_EQ(pushes.stiffness, 1000);
  EXPECT_EQ(pushes.turn_stiffness, 0);
  EXPECT_EQ(pushes.lever, 0);
}

TEST(Lever, ALimitedWrenchKeepsItsLine) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-5, 5);
  for (int n = 0; n < 1000; ++n) {
    // a force at a place: its torque about the wrist
    const Vec3 force(any(random), any(random), any(random)),
        place(0.02 * any(random), 0.02 * any(random), 0.02 * any(random));
    const Wrench contact = moved({force, Vec3::Zero()}, -place);
    ASSERT_NEAR((contact.torque - place.cross(force)).norm(), 0, 1e-12);
    const Wrench sent = limited(contact, 3.3, 0.1);
    EXPECT_LE(sent.force.norm(), 3.3 * (1 + 1e-12));
    EXPECT_LE(sent.torque.norm(), 0.1 * (1 + 1e-12));
    // about its place it still has no torque, so it still acts there
    EXPECT_NEAR(moved(sent, place).torque.norm(), 0, 1e-12);
    EXPECT_NEAR(sent.force.cross(force).norm(), 0, 1e-9);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(limited({Vec3(nan, 0, 0), Vec3::Zero()}, 1, 1).force, Vec3::Zero().eval());
}

}  // namespace
}  // namespace burr::haptics
