// The levels' numbers, their draws, and the numbers set by name.
#include "burr/surgeon/skill.h"

#include <gtest/gtest.h>

#include <cmath>

namespace burr::surgeon {
namespace {

TEST(Skill, LevelsDifferInPerceptionHandAndEndButNotInSpeed) {
  const Skill expert = skill_of(Level::expert), average = skill_of(Level::average),
              careless = skill_of(Level::careless);
  for (const auto number : {&Skill::perception, &Skill::tremor, &Skill::drift, &Skill::stop_delay,
                            &Skill::restraint, &Skill::unfinished}) {
    EXPECT_LT(expert.*number, average.*number);
    EXPECT_LT(average.*number, careless.*number);
  }
  EXPECT_EQ(expert.speed, average.speed);
  EXPECT_EQ(expert.speed, careless.speed);
  EXPECT_EQ(expert.margin_less, 0);
  EXPECT_EQ(careless.margin_less, 0.5e-3);
}

TEST(Skill, DrawsAreLognormalByTwentyPercentAndDependOnTheSeedAlone) {
  const Skill mean = skill_of(Level::average);
  constexpr int kSeeds = 2000;
  double sum = 0, square = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Skill one = drawn(mean, seed);
    EXPECT_EQ(one.perception, drawn(mean, seed).perception);
    const double log = std::log(one.perception / mean.perception);
    sum += log;
    square += log * log;
    EXPECT_LE(one.along, 1);
    EXPECT_LE(one.clear_view, 1);
  }
  EXPECT_NEAR(sum / kSeeds, 0, 0.02);
  EXPECT_NEAR(std::sqrt(square / kSeeds), 0.2, 0.02);
  EXPECT_NE(drawn(mean, 1).perception, drawn(mean, 2).perception);
}

TEST(Skill, EveryNumberIsSetByItsNameInTheUnitOfItsName) {
  Skill skill;
  EXPECT_TRUE(set_vice(skill, "perception_mm", 1.5));
  EXPECT_DOUBLE_EQ(skill.perception, 1.5e-3);
  EXPECT_TRUE(set_vice(skill, "stop_s", 0.4));
  EXPECT_DOUBLE_EQ(skill.stop_delay, 0.4);
  EXPECT_TRUE(set_vice(skill, "burr_near", 1.2));
  EXPECT_DOUBLE_EQ(skill.burrs.near, 1.2);
  for (const std::string& name : vice_names()) EXPECT_TRUE(set_vice(skill, name, 1)) << name;
}

TEST(Skill, RefusesAnUnknownNameAndAnImpossibleValueInOneSentence) {
  Skill skill;
  const Status unknown = set_vice(skill, "haste", 1);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().text.find("`vice` haste: there is no such number; use one of "), 0U);
  const Status far = set_vice(skill, "tremor_mm", 50);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().text, "`vice` tremor_mm=50: is out of range; use 0 to 5");
  EXPECT_FALSE(set_vice(skill, "tremor_mm", NAN));
  EXPECT_EQ(skill.tremor, Skill{}.tremor);
}

TEST(Skill, WordsOfLevelsComeBack) {
  for (const std::string& word : level_words()) {
    ASSERT_TRUE(level_of(word));
    EXPECT_EQ(word_of(*level_of(word)), word);
  }
  EXPECT_FALSE(level_of("good"));
}

}  // namespace
}  // namespace burr::surgeon
