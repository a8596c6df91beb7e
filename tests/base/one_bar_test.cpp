// One bar for many stages: it only grows, ends full, and its number is that of the step.
#include "burr/base/one_bar.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace burr::base {
namespace {

class Heard final : public Progress {
 public:
  void report(double fraction, std::string_view stage) override {
    all.emplace_back(fraction, stage);
  }
  [[nodiscard]] bool cancelled() const override { return stop; }
  std::vector<std::pair<double, std::string>> all;
  bool stop = false;
};

const std::vector<OneBar::Step>& steps() {
  static const std::vector<OneBar::Step> all = {{{"reading", "straightening"}, 1},
                                                {{"smoothing"}, 1},
                                                {{"looking", "finding"}, 2},
                                                {{"finding", "making"}, 4}};
  return all;
}

TEST(OneBar, NumbersTheStepsAndAddsTheirShares) {
  Heard heard;
  OneBar bar(heard, steps());
  for (const auto& [fraction, stage, told, text] :
       {std::tuple{0.5, "reading", 0.25 / 8, "1 of 4: reading"},
        {1.0, "reading", 0.5 / 8, "1 of 4: reading"},
        {1.0, "straightening", 1.0 / 8, "1 of 4: straightening"},
        {0.5, "smoothing", 1.5 / 8, "2 of 4: smoothing"},
        {1.0, "looking", 3.0 / 8, "3 of 4: looking"},
        {0.9, "finding", 3.9 / 8, "3 of 4: finding"},
        {0.1, "finding", 4.2 / 8, "4 of 4: finding"},  // again: of a later step
        {1.0, "making", 1.0, "4 of 4: making"}}) {
    bar.report(fraction, stage);
    ASSERT_FALSE(heard.all.empty());
    EXPECT_NEAR(heard.all.back().first, told, 1e-12) << text;
    EXPECT_EQ(heard.all.back().second, text);
    const auto numbered = numbered_stage(heard.all.back().second);
    ASSERT_TRUE(numbered);
    EXPECT_EQ(numbered->of, 4);
    EXPECT_EQ(numbered->words, stage);
  }
  heard.stop = true;
  EXPECT_TRUE(bar.cancelled());
}

TEST(OneBar, OnlyGrowsWhateverIsReported) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  const char* const stages[] = {"reading", "smoothing", "finding", "making", "unknown"};
  for (int n = 0; n < 200; ++n) {
    Heard heard;
    OneBar bar(heard, steps());
    double before = 0;
    int number = 1;
    for (int k = 0; k < 100; ++k) {
      bar.report(std::uniform_real_distribution<double>(-0.2, 1.3)(random), stages[random() % 5]);
      EXPECT_GE(heard.all.back().first, before);
      EXPECT_LE(heard.all.back().first, 1 + 1e-12);
      before = heard.all.back().first;
      const auto numbered = numbered_stage(heard.all.back().second);
      ASSERT_TRUE(numbered);
      EXPECT_GE(numbered->number, number);
      number = numbered->number;
    }
  }
}

TEST(OneBar, AddsNothingToAnotherOneAndNoNumbersToOneStep) {
  Heard heard;
  OneBar whole(heard, steps());
  OneBar part(whole, {{{"smoothing"}, 1}, {{"looking"}, 1}});
  part.report(0.5, "smoothing");
  EXPECT_EQ(heard.all.back().second, "2 of 4: smoothing");
  OneBar single(heard, {{{"reading"}, 1}});
  single.report(0.5, "reading");
  EXPECT_EQ(heard.all.back(), std::pair(0.5, std::string("reading")));
  EXPECT_FALSE(numbered_stage("3 of: smoothing"));
  EXPECT_FALSE(numbered_stage("smoothing"));
}

}  // namespace
}  // namespace burr::base
