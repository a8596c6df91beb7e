// What the program makes of the names that the library's sentences have.
#include "shared/front_words.h"

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "shared/word_names.h"
#include "window/import/notice_words.h"

namespace burr::app {
namespace {

// The program speaks for `burr mill`, with a few options of it.
class FrontWords : public testing::Test {
 protected:
  void SetUp() override {
    program_.add_flag("--quiet", flag_);
    CLI::App* mill = program_.add_subcommand("mill", "");
    mill->add_option("--spacing-mm", text_);
    mill->add_option("--roi", text_);
    mill->add_option("--tissues,--labels", text_);
    mill->add_option("volume", text_);
    speak_for(*mill);
  }
  void TearDown() override {
    speak_for(CLI::App());
    speak("en");
  }
  CLI::App program_;
  bool flag_ = false;
  std::string text_;
};

TEST_F(FrontWords, AFieldBecomesTheOptionOfTheCommandThatRuns) {
  EXPECT_EQ(in_options("a.nrrd: no spacing; give `spacing_mm` X,Y,Z"),
            "a.nrrd: no spacing; give --spacing-mm X,Y,Z");
  EXPECT_EQ(in_options("use `labels` or a smaller `region`."), "use --tissues or a smaller --roi.");
  EXPECT_EQ(in_options("`region`: voxels are counted from 0"), "--roi: voxels are counted from 0");
  EXPECT_EQ(in_options("`quiet`"), "--quiet");  // of the program itself
  const Error problem = in_options(error(Trouble::usage, "`region`: no"));
  EXPECT_EQ(problem.trouble, Trouble::usage);
  EXPECT_EQ(problem.text, "--roi: no");
  EXPECT_EQ(in_options(std::vector<std::string>{"`region`", "as it is"}),
            (std::vector<std::string>{"--roi", "as it is"}));
}

TEST_F(FrontWords, NoOptionIsNamedThatTheCommandDoesNotHave) {
  for (const char* text : {"see `smooth`.", "give it as `volume`", "`study`"})
    EXPECT_EQ(in_options(text), text);
  speak_for(program_);
  EXPECT_EQ(in_options("see `region`; `quiet`"), "see `region`; --quiet");
}

TEST_F(FrontWords, AFunctionBecomesTheCommandThatDoesTheSame) {
  EXPECT_EQ(in_options("damaged; `record::repair` saves the rest"),
            "damaged; `burr repair` saves the rest");
  EXPECT_EQ(in_options("`no::such`"), "`no::such`");
}

TEST_F(FrontWords, WhatIsNoNameStaysAndMayComeTwice) {
  for (const char* text :
       {"", "`", "``", "nothing", "see `dmesg | grep clocksource`", "`burr repair` --roi"})
    EXPECT_EQ(in_options(text), text);
  // a backtick in the name of a file
  EXPECT_EQ(in_options("odd`name.nrrd: give `region`"), "odd`name.nrrd: give --roi");
  const std::string once = in_options("`region`; `record::repair`");
  EXPECT_EQ(in_options(once), once);
}

TEST_F(FrontWords, EachNameHasOneWordAndAllAreInOrder) {
  for (const auto words : {other_options(), other_ways()}) {
    ASSERT_FALSE(words.empty());
    for (std::size_t n = 1; n < words.size(); ++n) EXPECT_LT(words[n - 1].name, words[n].name);
  }
}

// In the window a setting has the name that stands on the page, in the user's language.
TEST_F(FrontWords, ThePageOfAScanNamesItsOwnFields) {
  EXPECT_EQ(trouble_words("there is no bone; choose another level with `iso`"),
            "there is no bone; choose another level with \"Where bone begins\"");
  EXPECT_EQ(trouble_words("use a larger `voxel_mm` or a smaller `region`"),
            "use a larger \"Voxel size\" or a smaller \"Region\"");
  EXPECT_EQ(trouble_words("give `spacing_mm` X,Y,Z"), "give --spacing-mm X,Y,Z");
  speak("de");
  EXPECT_EQ(trouble_words("`region`").find("Region"), std::string::npos)
      << trouble_words("`region`");
}

}  // namespace
}  // namespace burr::app
