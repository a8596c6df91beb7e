// The texts of the window: every language has all of them, and fills in the same values.
#include "burr/words/words.h"

#include <gtest/gtest.h>

#include "burr/words/case_name.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace burr::words {
namespace {

using Strings = std::vector<std::string>;

std::string all_of(const Strings& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

// A translator sees here what is left to do, text by text.
TEST(Words, AreCompleteInEveryLanguageWithThePlaceholdersOfTheEnglishOnes) {
  ASSERT_FALSE(languages().empty());
  EXPECT_EQ(languages().front().code, "en");
  for (const Language& one : languages()) {
    EXPECT_EQ(one.texts.size(), static_cast<std::size_t>(Word::count_)) << one.code;
    EXPECT_TRUE(one.troubles.empty()) << all_of(one.troubles);
  }
}

TEST(Words, AreThereInEnglishSwedishAndGerman) {
  Strings found;
  for (const Language& one : languages()) found.push_back(one.code + " " + one.name);
  for (const char* const wanted : {"en English", "sv Svenska", "de Deutsch"})
    EXPECT_NE(std::find(found.begin(), found.end(), wanted), found.end()) << wanted;
}

TEST(Words, AreShownInTheLanguageChosenAndFilledIn) {
  speak("sv");
  EXPECT_STREQ(word(Word::undo), "Ångra");
  EXPECT_EQ(say(Word::burr_now, 4.5), "Borr: 4.5 mm");
  speak("de");
  EXPECT_EQ(say(Word::burr_now, 4.5), "Fräser: 4.5 mm");
  EXPECT_STREQ(english(Word::undo), "Undo");
  speak("klingon");
  EXPECT_EQ(spoken().code, "en");
  EXPECT_STREQ(word(Word::undo), "Undo");
}

// By POSIX: LC_ALL goes before LC_MESSAGES, and that before LANG; an empty one counts as not set.
TEST(Words, SpeakTheLanguageOfTheComputer) {
  EXPECT_EQ(language_for("", "", "sv_SE.UTF-8"), "sv");
  EXPECT_EQ(language_for("", "de_AT@euro", "sv_SE.UTF-8"), "de");
  EXPECT_EQ(language_for("C", "de_DE", "sv_SE"), "en");
  EXPECT_EQ(language_for("POSIX", "", "de"), "en");
  EXPECT_EQ(language_for("", "", "C.UTF-8"), "en");
  EXPECT_EQ(language_for("", "", "fr_FR.UTF-8"), "en") << "burr does not speak it";
  EXPECT_EQ(language_for("", "", "DE"), "de");
  EXPECT_EQ(language_for("", "", ""), "en");
  EXPECT_EQ(language_for("", "", "deutsch"), "en");
}

// A text that is the same in all languages was forgotten, unless it is one that all three write so.
TEST(Words, AreNotTheSameInAllLanguages) {
  const std::set<std::string> alike = {"Original", "Hand", "axial", "sagittal", "Film",
                                       "Stereo  [F3]", "Headset (OpenXR)", "Pedal", "Headset: {}",
                                       "Voxel",
                                       // of numbers and signs alone
                                       "x{:.1f}   {:.0f} mm", "W {:.0f}  L {:.0f}", "{} {}"};
  for (std::size_t n = 0; n < static_cast<std::size_t>(Word::count_); ++n) {
    const std::string& text = languages().front().texts[n];
    const bool same = std::all_of(languages().begin(), languages().end(),
                                  [&](const Language& one) { return one.texts[n] == text; });
    EXPECT_TRUE(!same || alike.contains(text)) << "\"" << text << "\"";
  }
}

// What was opened is named in the user's language, and nothing of the library's own words is left.
TEST(Words, NameWhatWasOpened) {
  for (const auto& [code, scan, tooth, recording] :
       {std::tuple{"en", "DICOM scan", "Tooth", "recording"},
        {"sv", "DICOM-skanning", "Tand", "inspelning"},
        {"de", "DICOM-Scan", "Zahn", "Aufzeichnung"}}) {
    speak(code);
    EXPECT_EQ(name_of_work("DICOM scan"), scan);
    EXPECT_EQ(name_of_work("tooth"), tooth);
    EXPECT_EQ(name_of_work("tooth?graded"), tooth);
    EXPECT_EQ(name_of_work("recording"), recording);
    EXPECT_EQ(name_of_work("My own case"), "My own case");
  }
  speak("en");
}

TEST(Words, TakeLettersNumbersAndTexts) {
  speak("en");
  EXPECT_EQ(say(Word::rate_section, "Axial", 'B'), "Axial B");
  EXPECT_EQ(say(Word::rate_section, 0.1F, std::size_t{7}), "0.1 7");
  EXPECT_EQ(say(Word::rate_section, std::string("a"), -3), "a -3");
}

// what the file of a language lacks, has too much, or has otherwise than the English one
TEST(Words, NamesWhatIsWrongInALanguagesFileAndTakesTheEnglishTextInstead) {
  const Language made = read_language({"xx",
                                       "language = \"Test\"\nundo = \"U\"\nredo = \"\"\n"
                                       "burr_now = \"burr of {:d} mm\"\nno_such_text = \"N\"\n"},
                                      &languages().front());
  EXPECT_EQ(made.name, "Test");
  const auto text = [&](Word which) { return made.texts[static_cast<std::size_t>(which)]; };
  EXPECT_EQ(text(Word::undo), "U");
  EXPECT_EQ(text(Word::redo), english(Word::redo));
  EXPECT_EQ(text(Word::reset), english(Word::reset));
  EXPECT_EQ(text(Word::burr_now), english(Word::burr_now));
  const std::string all = all_of(made.troubles);
  for (const char* const wanted :
       {"words/xx.toml: reset is missing", "words/xx.toml: redo is missing",
        "burr_now has other placeholders ({0:d}) than the English text ({0:g})",
        "no_such_text is not a key of words/en.toml"})
    EXPECT_NE(all.find(wanted), std::string::npos) << wanted << "\n" << all;
  EXPECT_EQ(all.find("xx.toml: undo is missing"), std::string::npos);
  // 1 text is good, 1 has other placeholders, 1 key is unknown
  EXPECT_EQ(made.troubles.size(), static_cast<std::size_t>(Word::count_) - 2 + 1 + 1);
}

TEST(Words, OfAFileThatIsNoTomlAreEnglishAndTheSentenceNamesTheFile) {
  const Language made = read_language({"xx", "undo = = 3"}, &languages().front());
  EXPECT_EQ(made.texts, languages().front().texts);
  ASSERT_EQ(made.troubles.size(), 1U);
  EXPECT_EQ(made.troubles[0].rfind("words/xx.toml", 0), 0U) << made.troubles[0];
}

TEST(Words, PlaceholdersMayStandInAnotherOrderWhereTheyAreNumbered) {
  EXPECT_EQ(placeholders("no holes: 50 % of it, {{}}"), Strings());
  EXPECT_EQ(placeholders("{} of {:.1f} %"), Strings({"{0}", "{1:.1f}"}));
  EXPECT_EQ(placeholders("{1:.1f} % von {0}"), placeholders("{} of {:.1f} %"));
  EXPECT_NE(placeholders("{} {}"), placeholders("{}"));
  EXPECT_NE(placeholders("{0} {}"), placeholders("{} {}"));
  EXPECT_NE(placeholders("{:.1f}"), placeholders("{:.2f}"));
  EXPECT_EQ(placeholders("%d of %.1f"), Strings({"%.1f", "%d"}));
  EXPECT_NE(placeholders("a { too much"), Strings());
  EXPECT_NE(placeholders("a } too much"), Strings());
}

}  // namespace
}  // namespace burr::words
