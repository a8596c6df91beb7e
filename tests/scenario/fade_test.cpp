// Guidance becomes less by a rule.
#include "burr/scenario/fade.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace burr::scenario {
namespace {

// one letter for each attempt from 1: g guided, - not
std::string attempts(const char* rule, std::uint32_t count) {
  const auto fade = fade_of(rule);
  if (!fade) return "no rule";
  std::string text;
  for (std::uint32_t n = 1; n <= count; ++n) text += guided(*fade, n) ? 'g' : '-';
  return text;
}

TEST(Fade, FullThenEverySecondThenOff) {
  EXPECT_EQ(attempts("2,alternate:4,off", 9), "gg-g-g---");
  EXPECT_EQ(attempts("1,off", 4), "g---");
  EXPECT_EQ(attempts("alternate:3,2,off", 7), "-g-gg--");
  EXPECT_EQ(attempts("0,off", 3), "---");
  EXPECT_EQ(attempts("off", 3), "---");
  EXPECT_EQ(attempts("on", 3), "ggg");
  EXPECT_EQ(attempts("alternate:2,on", 5), "-gggg");
}

TEST(Fade, TwoFallingMarksBringItBackAndAnUncountedAttemptHasIt) {
  const auto fade = fade_of("1,off");
  ASSERT_TRUE(fade);
  EXPECT_FALSE(guided(*fade, 5));
  EXPECT_TRUE(guided(*fade, 5, true));
  EXPECT_TRUE(guided(*fade, 0));
}

TEST(Fade, OtherTextsAreNoRule) {
  for (const char* bad : {"", "2", "2,", ",off", "2,alternate,off", "alternate:,off", "2,off,3",
                          "off,", "-1,off", "1001,off", "2 ,off", "slowly", "alternate:x,on"})
    EXPECT_FALSE(fade_of(bad)) << bad;
}

}  // namespace
}  // namespace burr::scenario
