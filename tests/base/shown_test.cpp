#include "burr/base/shown.h"

#include <gtest/gtest.h>

namespace burr::base {
namespace {

TEST(Shown, LeavesPlainTextAlone) {
  EXPECT_EQ(shown("unsigned char"), "unsigned char");
  EXPECT_EQ(shown("M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\xA6\xB4"),
            "M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\xA6\xB4");
  EXPECT_EQ(shown(""), "");
}

TEST(Shown, MovesNoCursorAndBreaksNoLine) {
  EXPECT_EQ(shown("a\x1B[2Jb\nc\rd\te\x7F"), "a?[2Jb?c?d?e?");
  EXPECT_EQ(shown(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(shown("a\xC2\x9B"
                  "2Jb"),
            "a?2Jb")
      << "CSI as one character";
}

TEST(Shown, IsAlwaysUtf8) {
  EXPECT_EQ(shown("\xFF\x80\xC3"), "???");
  EXPECT_EQ(shown("\xC0\xAF"), "??") << "overlong";
  EXPECT_EQ(shown("\xED\xA0\x80"), "???") << "surrogate";
  EXPECT_EQ(shown("\xF4\x90\x80\x80"), "????") << "above the last character";
}

TEST(Shown, CutsBetweenCharacters) {
  EXPECT_EQ(shown(std::string(1000, 'x'), 10), "xxxxxxxxxx...");
  EXPECT_EQ(shown("xxxx\xE2\x82\xAC", 5), "xxxx...");
  EXPECT_EQ(shown("xxxxx", 5), "xxxxx");
}

}  // namespace
}  // namespace burr::base
