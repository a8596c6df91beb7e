// Everything the window says is there in both languages, and takes the same values.
#include "window/shell/words.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace burr::app {
namespace {

// "{:.0f}" and "{}" of a text, in order
std::vector<std::string> holes(const std::string& text) {
  std::vector<std::string> all;
  for (std::size_t at = text.find('{'); at != std::string::npos; at = text.find('{', at + 1))
    all.push_back(text.substr(at, text.find('}', at) - at + 1));
  return all;
}

TEST(Words, AreThereInBothLanguagesWithTheSameHoles) {
  ASSERT_TRUE(words_in_order());
  for (int n = 0; n < static_cast<int>(Word::count_); ++n) {
    const std::string english = word(static_cast<Word>(n), Language::english);
    const std::string swedish = word(static_cast<Word>(n), Language::swedish);
    EXPECT_FALSE(english.empty()) << n;
    EXPECT_FALSE(swedish.empty()) << english;
    EXPECT_EQ(holes(english), holes(swedish)) << english;
  }
}

TEST(Words, AreSaidInTheLanguageSpokenAndFilledIn) {
  speak(Language::swedish);
  EXPECT_STREQ(word(Word::undo), "Ångra");
  EXPECT_EQ(say(Word::burr_now, 4.5), "borr på 4.5 mm");
  speak(Language::english);
  EXPECT_STREQ(word(Word::undo), "Undo");
  EXPECT_EQ(say(Word::burr_now, 4.5), "burr of 4.5 mm");
}

}  // namespace
}  // namespace burr::app
