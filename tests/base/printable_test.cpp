#include "burr/base/printable.h"

#include <gtest/gtest.h>

namespace burr::base {
namespace {

TEST(TEST, LeavesPlainTextAlone) {
  EXPECT_EQ(printable("unsigned char"), "unsigned char");
  EXPECT_EQ(printable("M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\xA6\xB4"),
            "M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\xA6\xB4");
  EXPECT_EQ(printable(""), "");
}

TEST(TEST, MovesNoCursorAndBreaksNoLine) {
  EXPECT_EQ(printable("a\x1B[2Jb\nc\rd\te\x7F"), "a?[2Jb?c?d?e?");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "2Jb"),
            "a?2Jb")
      << "CSI as one character";
}

TEST(TEST, IsAlwaysUtf8) {
  EXPECT_EQ(printable("\xFF\x80\xC3"), "???");
  EXPECT_EQ(printable("\xC0\xAF"), "??") << "overlong";
  EXPECT_EQ(printable("\xED\xA0\x80"), "???") << "surrogate";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "????") << "above the last character";
}

TEST(TEST, CutsBetweenCharacters) {
  EXPECT_EQ(printable(std::string(1000, 'x'), 10), "xxxxxxxxxx...");
  EXPECT_EQ(printable("xxxx\xE2\x82\xAC", 5), "xxxx...");
  EXPECT_EQ(printable("xxxxx", 5), "xxxxx");
}

}  // namespace
}  // namespace burr::base
