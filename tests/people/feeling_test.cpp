// An interval gives the hand the stimulus that it names, through the whole servo; and the threshold
// of an observer that feels it is found.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "burr/people/observer.h"
#include "burr/sim/feeling.h"
#include "scenes/wall.h"

namespace burr::sim {
namespace {

using people::Stimulus;

constexpr double kSeconds = 3;

TEST(Interval, StiffnessFrictionAndVibrationAreWhatWasAskedFor) {
  Wall wall(scenes::wall, {});
  for (int gesture = 0; gesture < kGestures; ++gesture) {
    for (const double k : {200.0, 400.0, 800.0})
      EXPECT_NEAR(*feel(wall, Stimulus::stiffness, k, gesture, kSeconds), k, 0.01 * k);
    for (const double mu : {0.1, 0.4, 1.0})
      EXPECT_NEAR(*feel(wall, Stimulus::friction, mu, gesture, kSeconds), mu, 0.02 * mu);
    // the strength of a band of noise of some seconds varies by this much
    for (const double a : {0.01, 0.05, 0.15})
      EXPECT_NEAR(*feel(wall, Stimulus::vibration, a, gesture, kSeconds), a, 0.08 * a);
    EXPECT_LT(*feel(wall, Stimulus::vibration, 0, gesture, kSeconds), 1e-4);
  }
}

// A hand owned by another object. If it counts as real, the session runs in real time.
class Watched final : public device::Device {
 public:
  Watched(device::Device& hand, bool real) : hand_(hand), spec_(hand.spec()) {
    spec_.simulated = !real;
    spec_.loss_timeout = 10;  // a busy machine is not the subject here
  }
  Status open() override {
    ++opened;
    return fine();
  }
  void close() override { ++closed; }
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override { return hand_.state(dt); }
  void write_force(const math::Vec3& force) BURR_RT override {
    hand_.write_force(force);
    last = force;
  }
  int opened = 0, closed = 0;
  math::Vec3 last = math::Vec3::Zero();

 private:
  device::Device& hand_;
  device::DeviceSpec spec_;
};

TEST(Interval, TheForceIsTheSpringAloneAndADrillRubsNot) {
  Wall wall(scenes::wall, {});
  device::SimulatedHand hand(gesture_for(Stimulus::stiffness, 3, wall.settings(), kSeconds), {});
  ASSERT_TRUE(hand.open().ok());
  const auto felt = wall.show(hand, {.stiffness = 400}, kSeconds, {});
  ASSERT_TRUE(felt.ok());
  for (std::size_t n = 700; n < felt->at.size(); ++n)  // while it increases or decreases
    ASSERT_NEAR(felt->force[n].z(),
                400 * std::max(0.0, wall.settings().burr_radius - felt->at[n].z()), 2e-3);
  device::SimulatedHand rubbing(gesture_for(Stimulus::friction, 1, wall.settings(), kSeconds), {});
  ASSERT_TRUE(rubbing.open().ok());
  const auto buzz = wall.show(rubbing, {.vibration = 0.05}, kSeconds, {});
  ASSERT_TRUE(buzz.ok());
  EXPECT_NEAR(sensed(Stimulus::vibration, *buzz), 0.05, 0.004);
}

TEST(Interval, BeginsAndEndsWithoutForceAndNeverExceedsTheLimits) {
  WallSettings settings;
  settings.user_force = 0.5;
  Wall wall(scenes::wall, settings);
  device::SimulatedHand hand(gesture_for(Stimulus::stiffness, 3, settings, kSeconds),
                             {.stiffness = 3000});
  ASSERT_TRUE(hand.open().ok());
  Watched watched(hand, false);
  const auto felt = wall.show(watched, {.stiffness = 900}, kSeconds, {});
  ASSERT_TRUE(felt.ok());
  EXPECT_GT(felt->force.back().norm(), 0.1);
  EXPECT_EQ(watched.last.norm(), 0);
  double most = 0, step = 0;
  for (std::size_t n = 0; n < felt->force.size(); ++n) {
    most = std::max(most, felt->force[n].norm());
    if (n > 0) step = std::max(step, felt->force[n].norm() - felt->force[n - 1].norm());
  }
  EXPECT_EQ(felt->force.front().norm(), 0);
  EXPECT_NEAR(most, 0.5, 1e-9);
  EXPECT_LE(step, 0.3 + 1e-9);
}

TEST(Interval, WhatTheDeviceCannotShowIsRefusedWithASentence) {
  Wall wall(scenes::wall, {});
  const device::DeviceSpec spec;
  EXPECT_TRUE(wall.check_device(spec, {.stiffness = 1000}).ok());
  EXPECT_FALSE(wall.check_device(spec, {.stiffness = 1001}).ok());
  EXPECT_FALSE(wall.check_device(spec, {.vibration = 0.2}).ok());
  EXPECT_FALSE(wall.check_device(spec, {.friction = 5}).ok());
}

TEST(Interval, ARealDeviceIsTickedByTheClockAndStaysOpen) {
  Wall wall(scenes::wall, {});
  device::SimulatedHand hand(gesture_for(Stimulus::stiffness, 1, wall.settings(), kSeconds), {});
  ASSERT_TRUE(hand.open().ok());
  Watched real(hand, true);
  const auto felt = wall.show(real, {.stiffness = 400}, kSeconds, {});
  ASSERT_TRUE(felt.ok());
  EXPECT_NEAR(sensed(Stimulus::stiffness, *felt), 400, 4);
  EXPECT_GT(felt->force.back().norm(), 0.1);
  EXPECT_EQ(real.last.norm(), 0);           // released at the end
  EXPECT_EQ(real.opened + real.closed, 0);  // opened and closed by its owner only
  const auto broken_off = wall.show(real, {.stiffness = 400}, 60, [] { return true; });
  ASSERT_TRUE(broken_off.ok());
  EXPECT_LT(broken_off->at.size(), 60000U);
}

// Each level is felt once with each gesture and stored; the observer's noise is new each time.
TEST(Feeling, AnObserverThatFeelsIsFoundAtItsThreshold) {
  SCOPED_TRACE("seeds from 100");
  struct Ask {
    Stimulus stimulus;
    double standard, smallest, largest, threshold;
  };
  for (const Ask& ask :
       {Ask{Stimulus::stiffness, 400, 0.01, 1, 0.12}, Ask{Stimulus::friction, 0.4, 0.01, 1.5, 0.2},
        Ask{Stimulus::vibration, 0, 0.002, 0.15, 0.03}}) {
    Wall wall(scenes::wall, {});
    std::map<std::pair<double, int>, double> known;
    const auto felt = [&](double value, int gesture) {
      const auto [at, fresh] = known.try_emplace({value, gesture}, 0);
      if (fresh) at->second = *feel(wall, ask.stimulus, value, gesture, 2);
      return at->second;
    };
    double sum = 0;
    constexpr int kRuns = 80;
    for (int n = 0; n < kRuns; ++n) {
      people::Plan plan;
      plan.stimulus = ask.stimulus;
      plan.standard = ask.standard;
      plan.smallest = ask.smallest;
      plan.largest = ask.largest;
      plan.trials = 400;
      plan.seed = 100 + static_cast<std::uint64_t>(n);
      people::Experiment experiment(plan);
      const people::FeelingObserver observer(ask.stimulus, ask.threshold, 0.02, plan.seed);
      while (!experiment.finished()) {
        const people::Trial& trial = experiment.next();
        const int gesture = trial.number % kGestures;
        experiment.answer(observer.answer(trial, felt(trial.shown(1), gesture),
                                          felt(trial.shown(2), (gesture + 1) % kGestures)));
      }
      const people::Outcome out = experiment.outcome();
      ASSERT_TRUE(out.fit.found) << out.fit.why;
      sum += std::log(out.fit.best.threshold / ask.threshold);
    }
    EXPECT_NEAR(std::exp(sum / kRuns), 1, 0.05) << people::name(ask.stimulus);
  }
}

}  // namespace
}  // namespace burr::sim
