// The energy of a tool that turns: of a hand that is not turned by the contact, and of one that is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "burr/haptics/safety/energy_guard.h"
#include "burr/haptics/six/six_proxy.h"
#include "burr/phantom/shapes.h"
#include "burr/tool/tool.h"
#include "haptics/touch_scene.h"

namespace burr::haptics {
namespace {

using burr::test::TouchScene;
using math::Pose;
using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3, kTick = 1e-3;
constexpr double kStiffness = 1000, kTurning = 0.3;

// A thin rod with a ball at its end stands beside a wall; the ball is `kLever` from where it is held.
constexpr double kLever = 12 * kMm;
tool::Tool rod() {
  tool::Tool tool;
  EXPECT_TRUE(tool::add_part(tool, {{tool::ShapeKind::ball, 0, 0, 0, 1 * kMm},
                                    {{0, 0, kLever}, Quat::Identity()},
                                    tool::Role::rubs}));
  return tool;
}

struct Turner {
  TouchScene scene{phantom::slab(Vec3::UnitX(), Vec3::Zero()), 0.25, 16};  // bone below x = 0
  double lever = std::sqrt(kTurning / kStiffness);
  SixProxy proxy{scene.surface, rod(), {.lever = lever}, {}};
  EnergyGuard guard;
  bool turned = false;                               // the torque is sent too
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // of the contact
  double stored = 0;

  explicit Turner(bool sends)
      : guard({.largest_force = 100, .largest_torque = sends ? 10.0 : 0.0}), turned(sends) {}
  void at(const Pose& hand) {
    const SixTouch touch = proxy.step(hand);
    SpringState now;
    now.hand = hand.p;
    now.stretch = touch.stretch;
    now.stiffness = kStiffness;
    now.force = force = kStiffness * touch.stretch;
    now.hand_turn = hand.q;
    now.torque = torque = kTurning * touch.turn;
    now.turn_stiffness = kTurning;
    const Vec3 sent = guard.step(now, kTick);
    share = force.norm() > 0 ? sent.norm() / force.norm() : 1;
    guard.sent(sent, turned ? torque : Vec3(Vec3::Zero()));
    stored = 0.5 * (kStiffness * touch.stretch.squaredNorm() + kTurning * touch.turn.squaredNorm());
  }
  double share = 1;
};

Pose held(double x, double angle) {  // the end of the rod goes to x + sin(angle) lever
  return {{x, 0.03 * kMm, -6 * kMm}, Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()))};
}

constexpr double kBeta = 0.05;
// Turned into the wall by kBeta, pushed out, turned back, and slowly to the wall again.
void go_round(Turner& turner, double touches, int ticks = 400) {
  for (int n = 1; n <= ticks; ++n) turner.at(held(touches, -kBeta * n / ticks));
  for (int n = 1; n <= ticks; ++n) turner.at(held(touches + kLever * kBeta * n / ticks, -kBeta));
  for (int n = 1; n <= ticks; ++n)
    turner.at(held(touches + kLever * kBeta, -kBeta + kBeta * n / ticks));
  for (int n = 1; n <= ticks; ++n)
    turner.at(held(touches + kLever * kBeta * (ticks - n) / ticks, 0));
}

// Where the rod, upright, just touches.
double touching_place(Turner& turner) {
  turner.proxy.place(held(4 * kMm, 0));
  double x = 4 * kMm;
  do {
    x -= 0.002 * kMm;
    turner.at(held(x, 0));
  } while (turner.force.norm() == 0);
  const double stretch = turner.force.norm() / kStiffness;
  return x + stretch * (1 + kLever * kLever / (turner.lever * turner.lever));
}

// E = k(l) (l beta)^2 / 2 each time round,  k(l) = 1 / (1/k_t + l^2/k_r)
TEST(TurnEnergy, ATurnIntoAWallIsFreeForAHandThatIsOnlyPushed) {
  Turner turner(false);
  const double touches = touching_place(turner);
  for (int n = 0; n < 50; ++n) turner.at(held(touches, 0));
  const double before = turner.guard.turned_in();
  go_round(turner, touches);
  const double k = 1 / (1 / kStiffness + kLever * kLever / kTurning);
  const double truth = 0.5 * k * std::pow(kLever * kBeta, 2);
  EXPECT_NEAR(truth, 0.122e-3, 0.002e-3);
  EXPECT_NEAR(turner.guard.turned_in() - before, truth, 0.03 * truth);
  EXPECT_EQ(turner.share, 1) << "two strokes a second are let pass";
}

TEST(TurnEnergy, AStoreOfTwoMillijoulesPaysForItAndThenTheForceFades) {
  Turner turner(false);
  const double touches = touching_place(turner);
  double least = 1, given = 0, seconds = 0;
  int rounds = 0;
  for (; rounds < 60; ++rounds) {
    // 20 ms of each: far faster than anybody works
    const double before = turner.guard.work_in();
    go_round(turner, touches, 20);
    given -= turner.guard.work_in() - before;
    seconds += 0.08;
    least = std::min(least, turner.guard.turn_left());
  }
  EXPECT_LT(least, 0.3e-3) << "the store runs low";
  EXPECT_LT(given, 2e-3 + 0.5e-3 * seconds + 0.1e-3);
  EXPECT_GT(given, 1.5e-3);
  // and it comes back by itself
  for (int n = 0; n < 4000; ++n) turner.at(held(touches + 2 * kMm, 0));
  EXPECT_NEAR(turner.guard.turn_left(), 2e-3, 1e-9);
}

// A hand that feels the torque pays for the turn: round and round, nothing is owed.
TEST(TurnEnergy, AHandThatIsTurnedPaysForItsTurns) {
  Turner turner(true);
  const double touches = touching_place(turner);
  for (int n = 0; n < 50; ++n) turner.at(held(touches, 0));
  const double truth =
      0.5 / (1 / kStiffness + kLever * kLever / kTurning) * std::pow(kLever * kBeta, 2);
  const double before = turner.guard.work_in();
  for (int n = 1; n <= 400; ++n) turner.at(held(touches, -kBeta * n / 400));
  EXPECT_NEAR(turner.guard.work_in() - before, truth, 0.03 * truth) << "the work of tau.dtheta";
  EXPECT_NEAR(turner.stored, truth, 0.03 * truth);
  EXPECT_NEAR(turner.guard.stored(), turner.stored, 1e-12);
  EXPECT_LT(turner.guard.deficit(), 0.02 * truth);
  for (int n = 1; n <= 400; ++n) turner.at(held(touches, -kBeta + kBeta * n / 400));
  EXPECT_NEAR(turner.guard.work_in() - before, 0, 0.02 * truth);
  EXPECT_EQ(turner.guard.turned_in(), 0);
  EXPECT_EQ(turner.guard.turn_left(), 2e-3);
}

// Beyond the limit of either, one factor limits both, and less comes back.
TEST(TurnEnergy, WhatIsMoreThanIsEverSentIsNotOwed) {
  EnergyGuard guard({.largest_force = 2, .largest_torque = 0.1});
  SpringState now;
  now.stiffness = 1000;
  now.turn_stiffness = 0.5;
  now.stretch = {1e-3, 0, 0};
  now.force = 1000 * now.stretch;
  now.torque = {0, 0, 0.4};  // four times the limit
  static_cast<void>(guard.step(now, kTick));
  const double whole = 0.5 * (1000 * 1e-6 + 0.4 * 0.4 / 0.5);
  // the integral of u min(1, 1/(4 u)) over the way back
  EXPECT_NEAR(guard.stored(), 2 * whole * (0.25 - 0.25 * 0.25 / 2), 1e-12);
}

}  // namespace
}  // namespace burr::haptics
