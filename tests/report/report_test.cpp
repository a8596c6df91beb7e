// What a report says, without a recording: marks of the learner, advice, agreement, words.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "report/advice.h"
#include "report/report_page.h"
#include "report/report_words.h"
#include "report/self_marks.h"
#include "window/shell/words.h"

namespace burr::app {
namespace {

using scoring::Outcome;
using scoring::Verdict;

constexpr const char* kRubric = R"([rubric]
name = "r"
version = 1
case = "c"
[[item]]
id = "near"
part = "product"
measure = "removed"
region = "x"
say = "Near the threshold."
[[item]]
id = "far"
part = "product"
measure = "removed"
region = "x"
say = "Far from it."
[[item]]
id = "gate"
part = "product"
gate = true
measure = "intact_solid"
structure = "x"
say = "Leave it whole."
[[item]]
id = "follows"
part = "product"
measure = "removed"
region = "x"
requires = "gate"
say = "Follows."
[[item]]
id = "idle"
part = "product"
measure = "kept"
region = "x"
say = "Idle."
[[item]]
id = "good"
part = "product"
measure = "removed"
region = "x"
say = "Good."
[[item]]
id = "open"
part = "product"
measure = "removed"
region = "x"
say = "Open."
)";

Outcome with(const char* id, Verdict verdict, double value) {
  Outcome out;
  out.id = id;
  out.verdict = verdict;
  out.what = "share removed";
  out.value = value;
  out.threshold = 0.8;
  return out;
}

Scored example() {
  Scored scored;
  auto rubric = scoring::parse_rubric(kRubric, "r.toml");
  EXPECT_TRUE(rubric);
  if (rubric) scored.judged.rubric = std::move(*rubric);
  auto& outcomes = scored.score.outcomes;
  outcomes = {with("near", Verdict::unmet, 0.7),       with("far", Verdict::unmet, 0.1),
              with("gate", Verdict::unmet, 1.0),       with("follows", Verdict::unmet, 0.9),
              with("idle", Verdict::unmet, 0.0),       with("good", Verdict::met, 0.9),
              with("open", Verdict::not_assessable, 0)};
  outcomes[3].reason = "it requires \"gate\", which is unmet";
  outcomes[4].earned = false;
  outcomes[4].reason = "too little was removed to earn it";
  outcomes[6].reason = "the bone has no label of it";
  outcomes[6].value.reset();
  scored.score.worked = 0.9;
  return scored;
}

using Numbers = std::vector<std::size_t>;

TEST(Advice, NamesBrokenGatesFirstThenTheFarthestAndNothingThatOnlyFollows) {
  EXPECT_EQ(by_importance(example(), {}), (Numbers{2, 1, 0}));
}

TEST(Advice, PutsWhatTheLearnerTookForMetBeforeTheOthers) {
  EXPECT_EQ(by_importance(example(), {{"near", SelfMark::met}}), (Numbers{2, 0, 1}));
}

TEST(Advice, LooksAtBorderlineItemsLast) {
  Scored scored = example();
  scored.score.outcomes[5].borderline = true;
  EXPECT_EQ(by_importance(scored, {}), (Numbers{2, 1, 0, 5}));
  EXPECT_EQ(advice(scored, {}).size(), 3U);  // a borderline item that is met needs no advice
}

TEST(Advice, SaysToGoOnWhereLittleWasRemoved) {
  speak("en");
  Scored scored = example();
  scored.score.worked = 0.04;
  const auto told = advice(scored, {});
  ASSERT_EQ(told.size(), kMostAdvice);
  EXPECT_NE(told[0].say.find("only 4 %"), std::string::npos) << told[0].say;
  EXPECT_EQ(told[1].say, "Leave it whole.");
}

TEST(Agreement, CountsOnlyWhatBothJudged) {
  speak("en");
  const std::string text = agreement(example(), {{"near", SelfMark::met},      // generous
                                                 {"far", SelfMark::unmet},     // the same
                                                 {"good", SelfMark::unmet},    // strict
                                                 {"gate", SelfMark::unknown},  // no mark
                                                 {"open", SelfMark::met}});  // the machine has none
  EXPECT_NE(text.find("agree on 1 of the 3 items"), std::string::npos) << text;
  EXPECT_NE(text.find("marked 1 as met that it did not, and 1 as not met"), std::string::npos);
}

TEST(SelfMarks, AreReadByTheIdOfTheItem) {
  const Scored scored = example();
  const auto marks = parse_self_marks("[marks]\nnear = \"met\"\n\"far\" = \"unmet\"\n", "m.toml",
                                      scored.judged.rubric);
  ASSERT_TRUE(marks) << marks.error().text;
  EXPECT_EQ(*marks, (SelfMarks{{"near", SelfMark::met}, {"far", SelfMark::unmet}}));
}

TEST(SelfMarks, NameFileLineFieldAndRemedyOfAMistake) {
  const Scored scored = example();
  const std::array<std::pair<const char*, const char*>, 5> kMistakes = {
      {{"[marks]\nno-such = \"met\"\n",
        "m.toml: line 2: no-such: r.toml has no such item; burr score names them"},
       {"[marks]\nnear = true\n", R"(m.toml: line 2: near: must be "met", "unmet" or "unknown")"},
       {"mark = 3\n", "m.toml: line 1: mark: is not a known field; write a table [marks]"},
       {"", "m.toml: marks: is missing; begin with [marks]"},
       {"[marks\n", "m.toml"}}};
  for (const auto& [text, sentence] : kMistakes) {
    const auto marks = parse_self_marks(text, "m.toml", scored.judged.rubric);
    ASSERT_FALSE(marks) << text;
    EXPECT_EQ(marks.error().text.find(sentence), 0U) << marks.error().text;
  }
}

// The table of translations is by the English text, so that text must be the library's.
TEST(ReportWords, KnowWhatTheLibraryCallsItsValues) {
  std::string library;
  for (const char* file :
       {"measure_bone.cpp", "measure_manner.cpp", "measure_recording.cpp", "measure_shape.cpp"}) {
    std::ifstream in(std::string(BURR_SOURCE_DIR "/src/burr/scoring/") + file);
    library.append(std::istreambuf_iterator<char>(in), {});
  }
  for (int n = static_cast<int>(Word::what_seen); n <= static_cast<int>(Word::what_order); ++n) {
    const std::string text = english(static_cast<Word>(n));
    EXPECT_NE(library.find('"' + text + '"'), std::string::npos) << text;
    speak("sv");
    EXPECT_NE(value_word(text), text);
    speak("en");
    EXPECT_EQ(value_word(text), text);
  }
  EXPECT_EQ(value_word("something new"), "something new");
}

TEST(ReportWords, ExplainEveryMeasure) {
  for (const scoring::Measure& measure : scoring::measures())
    EXPECT_FALSE(measure_word(measure.name).empty()) << measure.name;
}

TEST(ReportPage, ShowsEveryTextAsText) {
  const std::string nasty = "<b onload=\"x\">&'\x01";
  Report report;
  report.title = report.no_patient = report.unfinished = report.self = report.beside = nasty;
  report.language = "en";
  report.head = {{nasty, nasty}};
  report.gates = {{nasty, nasty, {nasty, Tone::bad}, {nasty, Tone::good}}};
  ReportItem item;
  item.id = item.text = item.figures = item.default_word = item.beside_figures = nasty;
  item.remarks = {nasty};
  item.pictures = {{"png", nasty, 1, 1}};
  report.parts = {{nasty, nasty, nasty, nasty, {item}}};
  report.next = {{nasty, nasty}};
  report.sides_legend = report.spots_legend = {{nasty, nasty}};
  report.sides = {{nasty, {{"png", nasty, 1, 1}}}};
  ReportLine line;
  line.whose = line.nearest = nasty;
  line.seconds = 1;
  line.steps = {{0, 1, nasty}};
  line.events = {{0.5, nasty, Tone::bad}};
  report.lines = {line};
  report.small = report.commands = {nasty};
  report.hashes = {{nasty, nasty}};
  const std::string page = page_of(report);
  EXPECT_EQ(page.find("<b onload"), std::string::npos);
  EXPECT_EQ(page.find('\x01'), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_NE(page.find("data:image/png;base64,cG5n\""), std::string::npos);
  EXPECT_EQ(page, page_of(report));
}

}  // namespace
}  // namespace burr::app
