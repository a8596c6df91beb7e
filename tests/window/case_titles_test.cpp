// The titles that a case gives its structures, in the language of the user.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "burr/scenario/built_in_cases.h"
#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"
#include "burr/workshop/label_check.h"
#include "shared/word_names.h"

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
  scenario::CaseLesson lesson;
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

// Whatever a step lights has a name in the user's language.
TEST_F(CaseTitles, OfPlacesThatAStepLightsAreThereInEveryLanguage) {
  for (const std::string& name : scenario::built_in_cases()) {
    const auto work = scenario::read_case(name);
    ASSERT_TRUE(work) << work.error().text;
    auto read = scenario::lesson_of(*work);
    ASSERT_TRUE(read) << read.error().text;
    const auto lesson = scenario::place(std::move(*read), workshop::landmarks_of(*work), name);
    ASSERT_TRUE(lesson) << lesson.error().text;
    for (const scenario::Step& step : lesson->steps)
      for (const std::string& shown : step.show) {
        const auto* mark = lesson->landmark(shown);
        const auto* region = lesson->region(shown);
        const auto* structure = lesson->structure(shown);
        for (const Language& language : languages())
          EXPECT_TRUE(
              (structure != nullptr && structure->title.by_language.contains(language.code)) ||
              (region != nullptr && region->title.by_language.contains(language.code)) ||
              (mark != nullptr && mark->title.by_language.contains(language.code)))
              << name << " " << shown << " " << language.code;
      }
  }
}

TEST_F(CaseTitles, HoldForPlacesBeforeThoseOfStructures) {
  scenario::CaseLesson lesson;
  scenario::Landmark& line = lesson.landmarks.emplace_back();
  line.name = "temporal line";
  line.title.by_language = {{"sv", "linea temporalis"}};
  scenario::CaseRegion& room = lesson.regions.emplace_back();
  room.name = "antrum";
  room.title.by_language = {{"sv", "antrums rum"}};
  take_titles_of(&lesson);
  speak("sv");
  EXPECT_EQ(place_name("temporal line"), "linea temporalis");
  EXPECT_EQ(place_name("antrum"), "antrums rum");
  EXPECT_EQ(anatomy("antrum"), "antrum") << "the tissue keeps its own name";
  EXPECT_EQ(place_name("incus"), anatomy("incus"));
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
