// The arithmetic of a score, on made-up outcomes.
#include "burr/scoring/outcome.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "burr/metrics/measured.h"
#include "burr/scoring/measure.h"

namespace burr::scoring {
namespace {

struct Made {
  Rubric rubric;
  std::vector<Outcome> outcomes;

  Made& add(const std::string& id, Part part, double weight, Verdict verdict,
            const std::string& needs = "") {
    Item item;
    item.id = id;
    item.part = part;
    item.weight = weight;
    item.needs = needs;
    rubric.items.push_back(item);
    Outcome outcome;
    outcome.id = id;
    outcome.verdict = verdict;
    outcomes.push_back(outcome);
    return *this;
  }
  [[nodiscard]] Total total(Part part) const { return total_of(rubric, outcomes, part); }
};

constexpr Part kProduct = Part::product, kProcess = Part::process;
constexpr Verdict kMet = Verdict::met, kUnmet = Verdict::unmet, kOpen = Verdict::not_assessable;

TEST(Outcome, ATotalIsByWeightAndByPart) {
  Made made;
  made.add("a", kProduct, 3, kMet).add("b", kProduct, 1, kUnmet).add("c", kProcess, 5, kMet);
  ASSERT_TRUE(made.total(kProduct).points);
  EXPECT_DOUBLE_EQ(*made.total(kProduct).points, 75);
  EXPECT_EQ(made.total(kProduct).met, 1U);
  EXPECT_EQ(made.total(kProduct).items, 2U);
  EXPECT_DOUBLE_EQ(*made.total(kProcess).points, 100);
}

TEST(Outcome, AGradedItemEarnsAPartByItsValue) {
  Item item;
  item.grade = {2e-3, 0};  // at most
  Outcome outcome;
  const auto credit = [&](double value, Verdict verdict) {
    outcome.value = value;
    outcome.verdict = verdict;
    return credit_of(item, outcome);
  };
  EXPECT_DOUBLE_EQ(credit(0, kMet), 1);
  EXPECT_DOUBLE_EQ(credit(0.5e-3, kMet), 0.75);
  EXPECT_DOUBLE_EQ(credit(1.5e-3, kUnmet), 0.25);
  EXPECT_DOUBLE_EQ(credit(3e-3, kUnmet), 0);
  item.grade = {0.6, 1};  // at least
  EXPECT_DOUBLE_EQ(credit(0.5, kUnmet), 0);
  EXPECT_DOUBLE_EQ(credit(0.9, kMet), 0.75);
  EXPECT_DOUBLE_EQ(credit(1.5, kMet), 1);
  // unmet because of what it requires, or for want of work
  outcome.reason = "it requires \"a\", which is not met";
  EXPECT_DOUBLE_EQ(credit(0.9, kUnmet), 0);
  outcome.reason.clear();
  outcome.earned = false;
  EXPECT_DOUBLE_EQ(credit(0.9, kUnmet), 0);
  // without a grade, the verdict
  item.grade.reset();
  outcome.earned = true;
  EXPECT_DOUBLE_EQ(credit(0.9, kUnmet), 0);
  EXPECT_DOUBLE_EQ(credit(0.1, kMet), 1);
}

TEST(Outcome, AGradeThatContradictsItsThresholdIsNotAssessable) {
  Item item;
  item.how = measure_named("removed");
  ASSERT_NE(item.how, nullptr);
  const auto verdict = [&](double none, double full, bool at_least) {
    item.grade = {none, full};
    return decided(item, {.met = true, .value = 0.9, .threshold = 0.8}, "share removed", at_least)
        .verdict;
  };
  EXPECT_EQ(verdict(0.6, 1, true), kMet);
  EXPECT_EQ(verdict(0.6, 0.8, true), kMet);
  EXPECT_EQ(verdict(1, 0, true), kOpen) << "rises where it should fall";
  EXPECT_EQ(verdict(0.85, 1, true), kOpen) << "what meets the threshold earns nothing";
  EXPECT_EQ(verdict(0.2, 0.7, true), kOpen) << "what misses the threshold earns everything";
  EXPECT_EQ(verdict(1, 0, false), kMet);
  EXPECT_EQ(verdict(0, 1, false), kOpen);
}

TEST(Outcome, ATotalCountsGradesByWeight) {
  Made made;
  made.add("a", kProduct, 3, kMet).add("b", kProduct, 1, kUnmet);
  made.rubric.items[0].grade = {1, 0};
  made.outcomes[0].value = 0.4;
  EXPECT_DOUBLE_EQ(*made.total(kProduct).points, 45);
  EXPECT_EQ(made.total(kProduct).met, 1U);
}

TEST(Outcome, WhatIsNotAssessableLeavesTheDenominator) {
  Made made;
  made.add("a", kProduct, 2, kMet).add("b", kProduct, 2, kUnmet).add("c", kProduct, 1, kOpen);
  const Total fifth = made.total(kProduct);  // exactly a fifth
  ASSERT_TRUE(fifth.points);
  EXPECT_DOUBLE_EQ(*fifth.points, 50);
  EXPECT_EQ(fifth.assessable, 2U);
  made.add("d", kProduct, 0.1, kOpen);
  EXPECT_FALSE(made.total(kProduct).points);
  EXPECT_EQ(made.total(kProduct).met, 1U);
  EXPECT_FALSE(made.total(kProcess).points);  // there is no item of it
}

TEST(Outcome, AGateLeavesTheTotal) {
  Made made;
  made.add("a", kProduct, 1, kMet).add("gate", kProduct, 1, kUnmet);
  made.rubric.items[1].gate = true;
  EXPECT_DOUBLE_EQ(*made.total(kProduct).points, 50);
}

TEST(Outcome, RequiresFollowsTheChain) {
  Made made;  // the last one needs the middle one, which needs the first
  made.add("c", kProduct, 1, kMet, "b").add("b", kProduct, 1, kMet, "a");
  made.add("a", kProduct, 1, kUnmet);
  apply_requires(made.rubric, made.outcomes);
  EXPECT_EQ(made.outcomes[0].verdict, kUnmet);
  EXPECT_EQ(made.outcomes[1].verdict, kUnmet);
  EXPECT_EQ(made.outcomes[1].reason, "it requires \"a\", which is not met");
  EXPECT_DOUBLE_EQ(*made.total(kProduct).points, 0);
}

TEST(Outcome, RequiresFollowsAChainOfAllItems) {
  Made made;
  made.add("0", kProduct, 1, kUnmet);
  for (int n = 1; n < 500; ++n)
    made.add(std::to_string(n), kProduct, 1, kMet, std::to_string(n - 1));
  apply_requires(made.rubric, made.outcomes);
  for (const Outcome& one : made.outcomes) EXPECT_EQ(one.verdict, kUnmet) << one.id;
}

TEST(Outcome, RequiresOfWhatIsNotAssessable) {
  Made made;
  made.add("b", kProduct, 1, kMet, "a").add("a", kProduct, 1, kOpen);
  made.add("d", kProduct, 1, kUnmet, "a").add("e", kProduct, 1, kMet, "f");
  made.add("f", kProduct, 1, kMet);
  apply_requires(made.rubric, made.outcomes);
  EXPECT_EQ(made.outcomes[0].verdict, kOpen);
  EXPECT_EQ(made.outcomes[2].verdict, kUnmet);  // it is so without the other
  EXPECT_EQ(made.outcomes[3].verdict, kMet);
}

TEST(Outcome, RequiresHandsOnThatItWasNotEarned) {
  Made made;
  made.add("b", kProduct, 1, kMet, "a").add("a", kProduct, 1, kUnmet);
  made.outcomes[1].earned = false;
  apply_requires(made.rubric, made.outcomes);
  EXPECT_EQ(made.outcomes[0].verdict, kUnmet);
  EXPECT_FALSE(made.outcomes[0].earned);
}

TEST(Outcome, PeopleAreToldOneOfThreeOutcomes) {
  Made made;
  made.add("met", kProduct, 1, kMet)
      .add("not", kProduct, 1, kUnmet)
      .add("idle", kProduct, 1, kUnmet);
  made.add("none", kProduct, 1, kOpen);
  made.outcomes[2].earned = false;
  const Standing expected[] = {Standing::met, Standing::not_met, Standing::too_early,
                               Standing::not_assessable};
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(standing_of(made.outcomes[n]), expected[n]) << n;
  const Total total = made.total(kProduct);
  EXPECT_EQ(total.met, 1U);
  EXPECT_EQ(total.too_early, 1U);
  EXPECT_EQ(total.assessable, 3U) << "it stays in the denominator: who does nothing loses no items";
}

// What judges that something stayed as it was did harm where it is not met; what was merely not reached did not.
TEST(Outcome, HarmIsWhatHadToStay) {
  Item item;
  Outcome outcome;
  outcome.verdict = kUnmet;
  for (const Measure& measure : measures()) {
    item.how = &measure;
    const std::string name = measure.name;
    const bool stays =
        name.starts_with("intact_") || name == "kept" || name == "untouched" || name == "clearance";
    EXPECT_EQ(did_harm(item, outcome), stays) << name;
    item.gate = true;
    EXPECT_TRUE(did_harm(item, outcome)) << name;
    outcome.earned = false;
    EXPECT_FALSE(did_harm(item, outcome)) << name << ": too early to say";
    outcome.earned = true;
    item.gate = false;
  }
}

TEST(Outcome, BorderlineIsNearerThanItsError) {
  Item item;
  item.how = measure_named("identified");
  const Outcome near = decided(item, {true, true, 0.31, 0.3, 0.02}, "share", true);
  EXPECT_EQ(near.verdict, kMet);
  EXPECT_TRUE(near.borderline);
  EXPECT_FALSE(decided(item, {true, true, 0.33, 0.3, 0.02}, "share", true).borderline);
}

TEST(Outcome, WhatIsHurtIsNotMerelyUnearned) {
  Item item;
  item.how = measure_named("intact_soft");
  const Outcome idle = decided(item, metrics::intact_mark(0, 0.5e-3, 1e-4, 0.1), "depth", false);
  EXPECT_EQ(idle.verdict, kUnmet);
  EXPECT_FALSE(idle.earned);
  EXPECT_EQ(idle.reason, "too little was removed to say");
  const Outcome hurt = decided(item, metrics::intact_mark(1e-3, 0.5e-3, 1e-4, 0.1), "depth", false);
  EXPECT_EQ(hurt.verdict, kUnmet);
  EXPECT_TRUE(hurt.earned);
  EXPECT_EQ(hurt.reason, "");
}

}  // namespace
}  // namespace burr::scoring
