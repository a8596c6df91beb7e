// What a report says, without a recording: marks of the learner, advice, agreement, words.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "burr/report/advice.h"
#include "burr/report/evidence_strip.h"
#include "burr/report/report_page.h"
#include "burr/report/report_words.h"
#include "burr/report/score_words.h"
#include "burr/report/self_marks.h"
#include "burr/words/words.h"
#include "support/test_places.h"

namespace burr::report {
namespace {

using scoring::Outcome;
using scoring::Verdict;
using words::speak;
using words::word;
using words::Word;

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
  outcomes[3].reason = "it requires \"gate\", which is not met";
  outcomes[4].earned = false;
  outcomes[4].reason = "too little was removed to say";
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
  EXPECT_EQ(told[0].say, "Leave it whole.") << "what did harm comes before all else";
  EXPECT_NE(told[1].say.find("only 4 %"), std::string::npos) << told[1].say;
  // nobody did harm, and little is gone: that alone
  for (auto& outcome : scored.score.outcomes) outcome.verdict = Verdict::met;
  const auto idle = advice(scored, {});
  ASSERT_EQ(idle.size(), 1U);
  EXPECT_NE(idle[0].say.find("only 4 %"), std::string::npos) << idle[0].say;
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
  const auto marks = parse_self_marks("[marks]\nnear = \"met\"\n\"far\" = \"not met\"\n", "m.toml",
                                      scored.judged.rubric);
  ASSERT_TRUE(marks) << marks.error().text;
  EXPECT_EQ(*marks, (SelfMarks{{"near", SelfMark::met}, {"far", SelfMark::unmet}}));
  // as files of before, and recordings, have it
  const auto old =
      parse_self_marks("[marks]\n\"far\" = \"unmet\"\n", "m.toml", scored.judged.rubric);
  ASSERT_TRUE(old) << old.error().text;
  EXPECT_EQ(*old, (SelfMarks{{"far", SelfMark::unmet}}));
}

TEST(SelfMarks, NameFileLineFieldAndRemedyOfAMistake) {
  const Scored scored = example();
  const std::array<std::pair<const char*, const char*>, 5> kMistakes = {
      {{"[marks]\nno-such = \"met\"\n",
        "m.toml: line 2: no-such: r.toml has no such item; use one of "},
       {"[marks]\nnear = true\n", R"(m.toml: line 2: near: must be "met", "not met" or "unknown")"},
       {"mark = 3\n", "m.toml: line 1: mark: is not a known field; write a table [marks]"},
       {"", "m.toml: marks: is missing; begin with [marks]"},
       {"[marks\n", "m.toml"}}};
  for (const auto& [text, sentence] : kMistakes) {
    const auto marks = parse_self_marks(text, "m.toml", scored.judged.rubric);
    ASSERT_FALSE(marks) << text;
    EXPECT_EQ(marks.error().text.find(sentence), 0U) << marks.error().text;
  }
}

// Nobody did anything wrong where too little was done: it is not "not met", and no cross stands there.
TEST(ReportWords, ThereAreThreeOutcomesWithAWordAndASignEach) {
  speak("en");
  Outcome outcome = with("any", Verdict::unmet, 0.0);
  EXPECT_EQ(mark_of(outcome).word, "not met");
  EXPECT_EQ(mark_of(outcome).tone, Tone::bad);
  outcome.earned = false;
  EXPECT_EQ(mark_of(outcome).word, "too early to say");
  EXPECT_EQ(mark_of(outcome).tone, Tone::open);
  outcome = with("any", Verdict::met, 0.9);
  EXPECT_EQ(mark_of(outcome).word, "met");
  EXPECT_EQ(mark_of(outcome).tone, Tone::good);
  outcome.verdict = Verdict::not_assessable;
  EXPECT_EQ(mark_of(outcome).word, "not assessable");
  EXPECT_EQ(mark_of(outcome).tone, Tone::none) << "no outcome";
}

// In the terminal as on the page, and with what did harm first.
TEST(ScoreWords, SayTheSameThreeOutcomesAndHarmComesFirst) {
  const Scored scored = example();
  const scoring::Rubric& rubric = scored.judged.rubric;
  const auto line = [&](std::size_t n) {
    return item_line(rubric.items[n], scored.score.outcomes[n]);
  };
  EXPECT_EQ(line(0).find("  not met "), 0U) << line(0);
  EXPECT_EQ(line(4).find("  too early to say "), 0U) << line(4);
  EXPECT_EQ(line(5).find("  met "), 0U) << line(5);
  const auto order = scoring::in_order(rubric, scored.score.outcomes, scoring::Part::product);
  EXPECT_EQ(order, (Numbers{2, 0, 1, 3, 4, 5, 6}));
  EXPECT_EQ(safety_line(rubric, scored.score), "safety: 0 of 1 items met; not met: gate");
  const auto json = nlohmann::json::parse(score_json(rubric, scored.score));
  EXPECT_EQ(json["items"][4]["verdict"], "unmet") << "as programs know it";
  EXPECT_EQ(json["items"][4]["outcome"], "too early to say");
  EXPECT_EQ(json["items"][4]["harm"], false);
  EXPECT_EQ(json["items"][2]["harm"], true);
}

// The table of translations is by the English text, so that text must be the library's.
TEST(ReportWords, KnowWhatTheLibraryCallsItsValues) {
  std::string library;
  for (const char* file :
       {"measure_bone.cpp", "measure_manner.cpp", "measure_recording.cpp", "measure_shape.cpp"}) {
    std::ifstream in(test::source_dir() + "/src/burr/scoring/" + file);
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

// ---- evidence as a strip of time

constexpr const char* kManner = R"([rubric]
name = "m"
version = 1
case = "c"
[[item]]
id = "burr"
part = "process"
measure = "burr_choice"
say = "b"
[[item]]
id = "order"
part = "process"
measure = "order"
say = "o"
[[item]]
id = "coolant"
part = "process"
measure = "coolant"
say = "c"
[[item]]
id = "region"
part = "product"
measure = "removed"
region = "x"
say = "r"
[[item]]
id = "strokes"
part = "process"
measure = "strokes"
say = "s"
)";

// 180 s at one sample a second: the first 60 s cut far away with a large dry burr, the next 60 s near
// with it, the last 60 s near with a diamond and coolant.
Scored manner() {
  Scored scored;
  auto rubric = scoring::parse_rubric(kManner, "m.toml");
  EXPECT_TRUE(rubric);
  if (rubric) scored.judged.rubric = std::move(*rubric);
  for (const scoring::Item& item : scored.judged.rubric.items)
    scored.score.outcomes.push_back(with(item.id.c_str(), Verdict::met, 1));
  scoring::Shown& shown = scored.score.shown;
  for (int n = 0; n < 180; ++n) {
    metrics::TrackSample sample;
    sample.t = n + 0.5;
    sample.raw = {1e-3 * n, 0, 0};
    sample.removed = 1e-12;
    sample.radius = 2e-3;
    sample.d = n < 60 ? 5e-3 : 0.5e-3;
    sample.diamond = sample.irrigated = n >= 120;
    shown.track.samples.push_back(sample);
  }
  metrics::TrackSample last;
  last.t = 180;
  shown.track.samples.push_back(last);
  shown.track.begins = {0};
  shown.regions["x"] = metrics::in_ball({90e-3, 0, 0}, 7.5e-3);
  return scored;
}

// The first moment, the last, and the tone of each span.
std::vector<std::tuple<int, int, Tone>> rounded(const ReportStrip& strip) {
  std::vector<std::tuple<int, int, Tone>> spans;
  for (const ReportStrip::Span& one : strip.spans)
    spans.emplace_back(static_cast<int>(std::lround(one.from_s)),
                       static_cast<int>(std::lround(one.to_s)), one.tone);
  return spans;
}
using Spans = std::vector<std::tuple<int, int, Tone>>;

TEST(EvidenceStrip, ShowsWhichBurrCutNearAndNothingOfWhatWasFar) {
  EXPECT_EQ(rounded(strip_of(manner(), 0)), (Spans{{60, 120, Tone::bad}, {120, 180, Tone::good}}));
}

TEST(EvidenceStrip, ShowsCuttingWithAndWithoutCoolant) {
  EXPECT_EQ(rounded(strip_of(manner(), 2)), (Spans{{0, 120, Tone::bad}, {120, 180, Tone::good}}));
}

TEST(EvidenceStrip, ShowsTheStepsInTheirOrderAndWhichWasTooEarly) {
  Scored scored = manner();
  scored.score.shown.steps = {{10, 2, true}, {90, 1, false}, {150, 3, false}};
  const ReportStrip strip = strip_of(scored, 1);
  EXPECT_EQ(rounded(strip),
            (Spans{{10, 10, Tone::bad}, {90, 90, Tone::good}, {150, 150, Tone::good}}));
  EXPECT_EQ(strip.spans[0].name, "2");
}

TEST(EvidenceStrip, ShowsWhenTheBurrWasInTheRegion) {  // 7.5 mm of the ball and 2 mm of the burr
  EXPECT_EQ(rounded(strip_of(manner(), 3)), (Spans{{81, 100, Tone::open}}));
}

TEST(EvidenceStrip, ShowsLongStrokesAboveShortOnesBelow) {
  Scored scored = manner();
  metrics::BurrStroke stroke;
  stroke.d = 5e-3;
  for (const auto& [begin, length] : {std::pair{10.0, 6e-3}, std::pair{50.0, 2e-3}}) {
    stroke.begin = begin;
    stroke.end = begin + 1;
    stroke.length = length;
    scored.score.shown.strokes.push_back(stroke);
  }
  stroke.d = 1e-3;  // near: the item does not ask for it
  stroke.begin = 100;
  scored.score.shown.strokes.push_back(stroke);
  EXPECT_EQ(rounded(strip_of(scored, 4)), (Spans{{10, 11, Tone::good}, {50, 51, Tone::bad}}));
}

TEST(EvidenceStrip, SaysWhyThereIsNoAnswer) {
  Scored scored = manner();
  scored.score.outcomes[1].verdict = Verdict::not_assessable;
  scored.score.outcomes[1].reason = "the recording names fewer than two steps as done";
  const ReportStrip strip = strip_of(scored, 1);
  EXPECT_TRUE(strip.open);
  EXPECT_EQ(strip.caption, "The recording names fewer than two steps as done.");
  EXPECT_NE(strip_html(strip).find("class=\"strip why\""), std::string::npos);
}

// Whatever an item is about, and whatever became of it.
TEST(EvidenceStrip, IsThereForEveryMeasure) {
  for (const scoring::Measure& measure : scoring::measures())
    for (const Verdict verdict : {Verdict::met, Verdict::unmet, Verdict::not_assessable}) {
      Scored scored = manner();
      scoring::Item& item = scored.judged.rubric.items[0];
      item.how = &measure;
      for (const scoring::Limit& limit : measure.limits)
        item.limits[limit.field] = limit.preset * limit.unit;
      scored.score.outcomes[0].verdict = verdict;
      scored.score.outcomes[0].reason = verdict == Verdict::met ? "" : "a reason";
      const ReportStrip strip = strip_of(scored, 0);
      EXPECT_FALSE(strip.caption.empty()) << measure.name;
      EXPECT_EQ(strip.seconds, 180) << measure.name;
    }
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
  ReportItem without = item;
  without.pictures.clear();
  without.strip = ReportStrip{1, {{0, 1, Tone::bad, nasty}}, nasty, true};
  report.parts = {{nasty, nasty, nasty, nasty, {item, without}}};
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
  report.hashes = report.figures = {{nasty, nasty}};
  const std::string page = page_of(report);
  EXPECT_EQ(page.find("<b onload"), std::string::npos);
  EXPECT_EQ(page.find('\x01'), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_NE(page.find("data:image/png;base64,cG5n\""), std::string::npos);
  EXPECT_EQ(page, page_of(report));
}

}  // namespace
}  // namespace burr::report
