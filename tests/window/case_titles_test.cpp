// The titles that a case gives its structures, in the language of the user.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "burr/scenario/built_in.h"
#include "burr/scenario/open_lesson.h"
#include "window/shell/anatomy.h"
#include "window/shell/words.h"

namespace burr::app {
namespace {

class CaseTitles : public testing::Test {
 protected:
  void TearDown() override {
    take_titles_of(nullptr);
    speak("en");
  }
};

TEST_F(CaseTitles, HoldForStructuresAndForTissuesThatBurrDoesNotKnow) {
  scenario::Lesson lesson;
  scenario::Structure& nerve = lesson.structures.emplace_back();
  nerve.name = "n7";
  nerve.names = {"Label_12", "facial nerve"};
  nerve.title.by_language = {{"en", "seventh nerve"}, {"sv", "sjunde nerven"}};
  EXPECT_EQ(anatomy("Label_12"), "Label_12");
  take_titles_of(&lesson);
  EXPECT_EQ(anatomy("n7"), "seventh nerve");
  EXPECT_EQ(anatomy("Label_12"), "seventh nerve");
  EXPECT_EQ(anatomy("facial nerve"), "facial nerve") << "burr's own word tells tissues apart";
  speak("sv");
  EXPECT_EQ(anatomy("n7"), "sjunde nerven");
  speak("de");
  EXPECT_EQ(anatomy("n7"), "seventh nerve") << "English where the language is missing";
  take_titles_of(nullptr);
  EXPECT_EQ(anatomy("n7"), "n7");
}

TEST_F(CaseTitles, OfTheBuiltInCasesAreThereInEveryLanguageAndTellStructuresApart) {
  for (const auto& [name, text] : scenario::built_in_texts()) {
    const auto lesson = scenario::parse_lesson(text, name);
    ASSERT_TRUE(lesson) << lesson.error().text;
    for (const Language& language : languages()) {
      std::set<std::string> titles;
      for (const scenario::Structure& one : lesson->structures) {
        EXPECT_TRUE(one.title.by_language.contains(language.code)) << name << " " << one.name;
        EXPECT_TRUE(titles.insert(one.title.in(language.code)).second)
            << name << " " << one.name << " " << language.code;
      }
    }
  }
}

}  // namespace
}  // namespace burr::app
