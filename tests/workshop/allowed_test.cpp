// What each mode offers, and above all what it never does, whatever a case says.
#include "burr/workshop/allowed.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace burr::workshop {
namespace {

using record::Mode;

const std::vector<std::string> kWords = {"step",      "target", "distance", "tone",
                                         "technique", "undo",   "colours",  "see-through"};

// every list that a case can give, and none
std::vector<scenario::Feedback> all_feedbacks() {
  std::vector<scenario::Feedback> all(1);
  for (unsigned bits = 0; bits < 1U << kWords.size(); ++bits) {
    std::vector<std::string> list;
    for (std::size_t n = 0; n < kWords.size(); ++n)
      if ((bits >> n & 1U) != 0) list.push_back(kWords[n]);
    scenario::Feedback one;
    one.learn = one.practise = one.exam = list;
    all.push_back(one);
  }
  return all;
}

TEST(Allowed, AnExamHasNoHelpWhateverTheCaseSays) {
  for (const scenario::Feedback& feedback : all_feedbacks())
    for (const bool is_guided : {false, true}) {
      Allowed one = allowed_in(Mode::exam, feedback, is_guided);
      EXPECT_EQ(one.steps, Offer::never);
      EXPECT_FALSE(one.target);
      EXPECT_FALSE(one.distance);
      EXPECT_EQ(one.tone_below, 0);
      EXPECT_FALSE(one.technique);
      EXPECT_FALSE(one.back) << "no undo, no original";
      EXPECT_FALSE(one.measure);
      EXPECT_FALSE(one.marks) << "the examiner releases them";
      EXPECT_EQ(one.injury, Injury::silent);
      one.colours = one.see_through = false;  // as the case says
      EXPECT_EQ(one, Allowed());
    }
}

TEST(Allowed, AnExamHasColoursAndSeeThroughOnlyWhereTheCaseSaysSo) {
  EXPECT_EQ(allowed_in(Mode::exam, {}, true), Allowed()) << "off by default";
  scenario::Feedback feedback;
  feedback.exam = {"colours"};
  EXPECT_TRUE(allowed_in(Mode::exam, feedback, true).colours);
  EXPECT_FALSE(allowed_in(Mode::exam, feedback, true).see_through);
  feedback.exam = {"see-through"};
  EXPECT_FALSE(allowed_in(Mode::exam, feedback, true).colours);
  EXPECT_TRUE(allowed_in(Mode::exam, feedback, true).see_through);
}

TEST(Allowed, PractisingHasAToneBelowAMillimetreAndNoDistance) {
  for (const scenario::Feedback& feedback : all_feedbacks()) {
    const Allowed one = allowed_in(Mode::practise, feedback, true);
    EXPECT_FALSE(one.distance);
    EXPECT_LE(one.tone_below, 1e-3);
    EXPECT_FALSE(one.technique);
    EXPECT_NE(one.steps, Offer::always) << "on demand, so that it is counted";
  }
  EXPECT_EQ(allowed_in(Mode::practise, {}, true).tone_below, 1e-3);
  EXPECT_TRUE(allowed_in(Mode::practise, {}, true).back);
}

TEST(Allowed, LearningHasEverythingThatTheCaseDoesNotLeaveOut) {
  const Allowed all = allowed_in(Mode::learn, {}, true);
  EXPECT_EQ(all.steps, Offer::always);
  EXPECT_TRUE(all.target && all.distance && all.technique && all.back && all.measure);
  EXPECT_TRUE(all.colours && all.see_through);
  EXPECT_EQ(all.tone_below, std::numeric_limits<double>::infinity());
  for (const std::string& word : kWords) {
    scenario::Feedback feedback;
    feedback.learn = {word};
    const Allowed one = allowed_in(Mode::learn, feedback, true);
    EXPECT_EQ(one.steps, word == "step" ? Offer::always : Offer::never) << word;
    EXPECT_EQ(one.target, word == "target") << word;
    EXPECT_EQ(one.distance, word == "distance") << word;
    EXPECT_EQ(one.tone_below > 0, word == "tone") << word;
    EXPECT_EQ(one.technique, word == "technique") << word;
    EXPECT_EQ(one.back, word == "undo") << word;
    EXPECT_EQ(one.colours, word == "colours") << word;
    EXPECT_EQ(one.see_through, word == "see-through") << word;
  }
}

record::Identity learning(std::uint32_t attempt) {
  record::Identity identity;
  identity.mode = Mode::learn;
  identity.attempt = attempt;
  return identity;
}

TEST(Allowed, GuidanceFadesByTheRuleOfTheCase) {
  scenario::Feedback feedback;
  feedback.fade = "2,alternate:4,off";
  std::string guided;
  for (std::uint32_t attempt = 1; attempt <= 8; ++attempt)
    guided += guided_in(learning(attempt), feedback) ? 'g' : '-';
  EXPECT_EQ(guided, "gg-g-g--") << "a target is not lit in every attempt";
  EXPECT_TRUE(guided_in(learning(9), {})) << "no rule";
  for (const Mode mode : {Mode::learn, Mode::practise}) {
    const Allowed one = allowed_in(mode, {}, false);
    EXPECT_FALSE(one.target || one.distance || one.technique);
    EXPECT_EQ(one.tone_below, 0);
    EXPECT_TRUE(one.back && one.colours) << "only guidance fades";
    EXPECT_NE(one.steps, Offer::never);
  }
}

TEST(Allowed, FreeWorkIsAsItWas) {
  for (const scenario::Feedback& feedback : all_feedbacks()) {
    const Allowed one = allowed_in(Mode::free, feedback, false);
    EXPECT_TRUE(one.distance && one.back && one.measure && one.colours && one.see_through);
    EXPECT_EQ(one.tone_below, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(one.technique);
  }
}

}  // namespace
}  // namespace burr::workshop
