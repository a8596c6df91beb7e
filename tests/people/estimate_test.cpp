// Staircases compared with Levitt (1971) and Kaernbach (1991); the fit and the adaptive method with
// observers whose threshold is known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "burr/people/observer.h"

namespace burr::people {
namespace {

constexpr Psychometric kTruth{0.15, 3.5, 0.5, 0.02};

// The results of runs with the seeds first, first + 1 ...
struct Study {
  int runs = 0, found = 0, covered = 0, within = 0, guessed = 0;
  double log_sum = 0, log_squares = 0, settled_sum = 0, trials = 0;
  [[nodiscard]] double bias() const { return std::exp(log_sum / found) - 1; }
  [[nodiscard]] double scatter() const {
    return std::sqrt(log_squares / found - std::pow(log_sum / found, 2));
  }
};

Study study(Plan plan, const Psychometric& truth, int runs, std::uint64_t first) {
  Study all;
  for (int n = 0; n < runs; ++n) {
    plan.seed = first + static_cast<std::uint64_t>(n);
    Experiment experiment(plan);
    const KnowingObserver observer(truth, plan.seed);
    while (!experiment.finished()) experiment.answer(observer.answer(experiment.next()));
    const Outcome out = experiment.outcome();
    ++all.runs;
    all.trials += out.trials;
    if (out.settled) all.settled_sum += std::log(*out.settled);
    if (out.fit.why.find("guessing") != std::string::npos) ++all.guessed;
    if (!out.fit.found) continue;
    ++all.found;
    const double off = std::log(out.fit.best.threshold / truth.threshold);
    all.log_sum += off;
    all.log_squares += off * off;
    all.covered += out.fit.low <= truth.threshold && truth.threshold <= out.fit.high ? 1 : 0;
    all.within += std::abs(std::exp(off) - 1) <= 0.05 ? 1 : 0;
  }
  return all;
}

TEST(Psychometric, IsHalfWayAtItsThresholdAndItsInverseLeadsBack) {
  EXPECT_NEAR(kTruth.right(kTruth.threshold), 0.5 + 0.48 / 2, 1e-12);
  for (const double share : {0.6, 0.7071, 0.75, 0.7937, 0.9})
    EXPECT_NEAR(kTruth.right(kTruth.level_for(share)), share, 1e-12);
  EXPECT_EQ((Psychometric{INFINITY, 3.5, 0.5, 0.02}).right(1), 0.5);
  // the slope has the meaning that its comment gives
  const double up = kTruth.right(0.15 * std::exp(1e-5)),
               down = kTruth.right(0.15 * std::exp(-1e-5));
  EXPECT_NEAR((up - down) / 2e-5, std::log(2.0) / 2 * 0.48 * 3.5, 1e-6);
}

TEST(Staircase, TargetsAreThoseOfTheClosedForm) {
  EXPECT_NEAR(target_of(Rule::one_up_two_down), 0.70711, 1e-5);
  EXPECT_NEAR(target_of(Rule::one_up_three_down), 0.79370, 1e-5);
  EXPECT_NEAR(target_of(Rule::weighted), 0.75, 1e-12);
}

TEST(Staircase, SettlesWhereItsRuleSays) {
  SCOPED_TRACE("seeds from 500");
  for (const Rule rule : {Rule::one_up_two_down, Rule::one_up_three_down, Rule::weighted}) {
    SCOPED_TRACE(name(rule));
    Plan plan;
    plan.method = Method::staircase;
    plan.rule = rule;
    plan.trials = 400;
    const Study all = study(plan, kTruth, 60, 500);
    const double settled = std::exp(all.settled_sum / all.runs);
    EXPECT_NEAR(settled / kTruth.level_for(target_of(rule)), 1, 0.05);
  }
}

TEST(Staircase, StepsAsItsRuleSays) {
  Staircase stairs({.rule = Rule::one_up_two_down, .start = 0.5});
  stairs.answer(true);
  EXPECT_EQ(stairs.level(), 0.5);  // one right answer is not enough
  stairs.answer(true);
  EXPECT_NEAR(stairs.level(), 0.5 / 1.5, 1e-12);
  stairs.answer(false);
  EXPECT_NEAR(stairs.level(), 0.5, 1e-12);
  for (int n = 0; n < 100; ++n) stairs.answer(false);
  EXPECT_EQ(stairs.level(), 1);  // never above the largest level
  EXPECT_FALSE(stairs.found());
}

TEST(Estimate, EveryMethodFindsTheThresholdInTheMeanOfManyRuns) {
  SCOPED_TRACE("seeds from 1000");
  for (const Method method : {Method::bayes, Method::staircase, Method::constant}) {
    SCOPED_TRACE(name(method));
    Plan plan;
    plan.method = method;
    plan.smallest = 0.03;
    const Study all = study(plan, kTruth, 60, 1000);
    EXPECT_EQ(all.found, all.runs);
    EXPECT_NEAR(all.bias(), 0, 0.05);
  }
}

TEST(Estimate, OfStiffnessFrictionAndVibrationAlikeForSmallAndLargeThresholds) {
  SCOPED_TRACE("seeds from 2000");
  for (const Stimulus stimulus : {Stimulus::stiffness, Stimulus::friction, Stimulus::vibration}) {
    for (const double threshold : {0.08, 0.23}) {
      Plan plan;
      plan.stimulus = stimulus;
      plan.standard = stimulus == Stimulus::vibration ? 0 : 400;
      const double scale = stimulus == Stimulus::vibration ? 0.1 : 1;  // newtons
      plan.smallest *= scale;
      plan.largest *= scale;
      const Study all = study(plan, {threshold * scale, 3.5, 0.5, 0.02}, 40, 2000);
      EXPECT_EQ(all.found, all.runs);
      EXPECT_NEAR(all.bias(), 0, 0.05) << name(stimulus) << " " << threshold;
    }
  }
}

TEST(Estimate, TheIntervalHoldsTheTruthNineteenTimesOfTwenty) {
  SCOPED_TRACE("seeds from 3000");
  Plan plan;
  plan.trials = 200;
  const Study all = study(plan, kTruth, 200, 3000);
  const double share = static_cast<double>(all.covered) / all.found;
  EXPECT_EQ(all.found, all.runs);
  EXPECT_NEAR(share, 0.95, 0.043);  // 2.8 standard deviations of 200 coin tosses
  // The scatter is hardly larger than necessary: with an unknown slope no design tells more about
  // the threshold than n trials at the threshold itself, where the slope does not matter.
  const double p = kTruth.right(kTruth.threshold);
  const double grows = (1 - kTruth.guess - kTruth.lapse) * std::log(2.0) / 2 * kTruth.slope;
  const double least = std::sqrt(p * (1 - p) / plan.trials) / grows;
  EXPECT_GT(all.scatter() / least, 0.9);
  EXPECT_LT(all.scatter() / least, 1.45);
}

TEST(Estimate, AskedForFivePercentItGoesOnUntilItHasThem) {
  SCOPED_TRACE("seeds from 4000");
  Plan plan;
  plan.trials = 3000;
  plan.until = 0.05;
  const Study all = study(plan, kTruth, 20, 4000);
  EXPECT_EQ(all.found, all.runs);
  EXPECT_GE(all.within, 17);
  EXPECT_LT(all.trials / all.runs, 2000);
}

TEST(Estimate, WhoGuessesHasNoThreshold) {
  SCOPED_TRACE("seeds from 5000");
  for (const Method method : {Method::bayes, Method::staircase, Method::constant}) {
    Plan plan;
    plan.method = method;
    plan.trials = 200;
    const Study all = study(plan, {INFINITY, 3.5, 0.5, 0.02}, 100, 5000);
    EXPECT_LE(all.found, 1) << name(method);
    EXPECT_GE(all.guessed, 95) << name(method);  // and reports it
  }
}

TEST(Estimate, AThresholdBeyondTheLevelsIsNotMadeUp) {
  SCOPED_TRACE("seeds from 6000");
  Plan plan;
  EXPECT_EQ(study(plan, {2.5, 3.5, 0.5, 0.02}, 20, 6000).found, 0);
  EXPECT_EQ(study(plan, {0.002, 3.5, 0.5, 0.02}, 20, 6000).found, 0);
}

TEST(Fit, AnIntervalThatLeavesWhatCouldBeShownIsNoThreshold) {
  const FitSettings settings;
  const Tally rising[] = {{0.25, 100, 52}, {0.5, 100, 60}, {1, 100, 74}};
  EXPECT_NE(fit(rising, settings).why.find("above the largest"), std::string::npos);
  const Tally easy[] = {{0.01, 100, 80}, {0.02, 100, 95}, {0.04, 100, 98}};
  EXPECT_NE(fit(easy, settings).why.find("below the smallest"), std::string::npos);
  const Tally fine[] = {{0.1, 100, 55}, {0.2, 100, 74}, {0.4, 100, 96}};
  const Fit found = fit(fine, settings);
  EXPECT_TRUE(found.found) << found.why;
  EXPECT_NEAR(found.best.threshold, 0.2, 0.01);
  EXPECT_EQ(fit({}, settings).why, "no threshold found: there are no answers");
}

TEST(Experiment, OrdersAreBalancedAndNotToBeForeseen) {
  Plan plan;
  plan.trials = 300;
  Experiment experiment(plan);
  int first = 0, changes = 0;
  bool last = false;
  while (!experiment.finished()) {
    const Trial trial = experiment.next();
    first += trial.comparison_first ? 1 : 0;
    changes += trial.comparison_first != last ? 1 : 0;
    last = trial.comparison_first;
    EXPECT_EQ(trial.shown(trial.right_answer()), trial.comparison);
    EXPECT_GT(trial.comparison, trial.standard);
    experiment.answer(1);
    if (trial.number % 10 == 0) {
      EXPECT_EQ(2 * first, trial.number);
    }
  }
  EXPECT_EQ(first, 150);
  EXPECT_GT(changes, 120);  // neither strict alternation nor long runs: 166 expected
  EXPECT_LT(changes, 210);
}

TEST(Experiment, ItsAnswersBringItToWhereItWas) {
  for (const Method method : {Method::bayes, Method::staircase, Method::constant}) {
    Plan plan;
    plan.method = method;
    plan.trials = 80;
    plan.seed = 77;
    Experiment whole(plan), again(plan);
    const KnowingObserver observer(kTruth, 5);
    while (!whole.finished()) whole.answer(observer.answer(whole.next()));
    for (int n = 0; n < 40; ++n) {
      EXPECT_EQ(again.next().level, whole.answered()[static_cast<std::size_t>(n)].trial.level);
      again.answer(whole.answered()[static_cast<std::size_t>(n)].answer);
    }
    while (!again.finished()) again.answer(observer.answer(again.next()));
    EXPECT_EQ(again.outcome().fit.best.threshold, whole.outcome().fit.best.threshold);
    EXPECT_EQ(again.outcome().said_first, whole.outcome().said_first);
  }
}

}  // namespace
}  // namespace burr::people
