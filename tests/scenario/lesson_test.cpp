// Cases of format 2: every field comes back, and every mistake is one sentence with its line.
#include "burr/scenario/open_lesson.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace burr::scenario {
namespace {

constexpr const char* kGood = R"(format = 2
title.en = "A lesson"
title.sv = "En lektion"
phantom = "block"
approach = [[-2, 0, 0], [0, 0, 1]]
[burr]
diameter_mm = 4
rpm = 60000
[[landmark]]
name = "entry"
at_mm = [1, 2, 3]
[[landmark]]
name = "vein"
points_mm = [[0, 0, 0], [0, 0, 10], [0, 5, 10]]
[[landmark]]
name = "roof"
at_mm = [0, 0, 5]
normal = [0, 0, 3]
[[structure]]
name = "nerve"
names = ["nerve", "Nervus"]
intact = "soft"
volume_mm3 = [40, 200]
inscribed_mm = [0.5, 1.6]
pieces = [1, 2]
length_mm = 25
touches = ["wall"]
apart = ["drum"]
[[structure]]
name = "wall"
intact = "plate"
optional = true
[[structure]]
name = "drum"
glass = true
[[region]]
name = "way"
add = [
  { shape = "ball", at = "entry", radius_mm = 4 },
  { shape = "capsule", from = [0, 0, 0], to = "entry", radius_mm = 2 },
  { shape = "box", at = [1, 1, 1], size_mm = [2, 4, 6] },
  { shape = "tube", along = "vein", radius_mm = 3, from = 0.25, to = 0.5 },
  { shape = "between", structure = "nerve", other = "wall", radius_mm = 4 },
]
take = [
  { shape = "half-space", at = "roof", normal = [0, 0, 2] },
  { shape = "within", structure = "nerve", radius_mm = 1 },
]
[[step]]
id = "first"
title = "Begin"
say.en = "Open it."
say.sv = "Öppna den."
structure = "wall"
region = "way"
spare = ["nerve"]
tool = { kind = "diamond", diameter_mm = [2, 4] }
approach = [[0, 3, 0]]
show = ["entry", "way", "nerve"]
must_precede = ["second"]
done = { measure = "removed", share = 0.7 }
[[step]]
id = "second"
say = "Close it."
[[complication]]
id = "bleeds"
step = "first"
structure = "nerve"
say = "It bleeds."
[feedback]
learn = ["step", "target"]
practise = ["tone"]
exam = []
fade = "2,alternate:4,off"
[reference]
remove = ["way"]
leave = [{ structure = "nerve", mm = 1 }]
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// of the line that holds the text
std::string line_of(const std::string& text, const std::string& what) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return "line " +
         std::to_string(
             1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

TEST(CaseLesson, EveryFieldIsReadInMetres) {
  const auto read = parse_lesson(kGood, "my.toml");
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->format, 2);
  EXPECT_EQ(read->title.in("sv"), "En lektion");
  EXPECT_EQ(read->title.in("de"), "A lesson") << "English where a language is missing";
  ASSERT_EQ(read->approach.size(), 2U);
  EXPECT_EQ(read->approach[0], -math::Vec3::UnitX());
  ASSERT_EQ(read->landmarks.size(), 3U);
  EXPECT_LT((read->landmark("entry")->points[0] - math::Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_EQ(read->landmark("vein")->points.size(), 3U);
  EXPECT_EQ(*read->landmark("roof")->normal, math::Vec3::UnitZ());
  EXPECT_EQ(read->landmark("Entry"), nullptr);

  const Structure& nerve = *read->structure("nerve");
  EXPECT_EQ(nerve.names, (std::vector<std::string>{"nerve", "Nervus"}));
  EXPECT_EQ(nerve.intact, Intact::soft);
  EXPECT_DOUBLE_EQ(nerve.volume->first, 40e-9);
  EXPECT_DOUBLE_EQ(nerve.volume->second, 200e-9);
  EXPECT_DOUBLE_EQ(nerve.inscribed->second, 1.6e-3);
  EXPECT_EQ(*nerve.pieces, Range(1, 2));
  EXPECT_DOUBLE_EQ(nerve.length, 25e-3);
  EXPECT_EQ(nerve.touches, std::vector<std::string>{"wall"});
  EXPECT_EQ(nerve.apart, std::vector<std::string>{"drum"});
  EXPECT_EQ(read->structure("wall")->names, std::vector<std::string>{"wall"});
  EXPECT_TRUE(read->structure("wall")->optional);
  EXPECT_TRUE(read->structure("drum")->glass);

  const Step& first = *read->step("first");
  EXPECT_EQ(first.say.in("sv"), "Öppna den.");
  EXPECT_EQ(first.structure, "wall");
  EXPECT_EQ(first.region, "way");
  EXPECT_EQ(first.spare, std::vector<std::string>{"nerve"});
  EXPECT_EQ(first.kind, tool::BurrKind::diamond);
  EXPECT_DOUBLE_EQ(first.diameter->first, 2e-3);
  EXPECT_EQ(first.show.size(), 3U);
  EXPECT_EQ(first.approach, std::vector<math::Vec3>{math::Vec3::UnitY()});
  EXPECT_TRUE(read->step("second")->approach.empty());
  EXPECT_EQ(first.must_precede, std::vector<std::string>{"second"});
  EXPECT_FALSE(read->step("second")->kind);
  EXPECT_EQ(read->complications.at(0).step, "first");
  EXPECT_EQ(read->feedback.fade, "2,alternate:4,off");
  EXPECT_EQ(read->feedback.learn->size(), 2U);
  EXPECT_TRUE(read->feedback.exam && read->feedback.exam->empty());
  ASSERT_TRUE(first.done);
  EXPECT_EQ(first.done->measure, "removed");
  EXPECT_EQ(first.done->region, "way") << "the step's own";
  EXPECT_EQ(first.done->limits.at("share"), 0.7);
  EXPECT_FALSE(read->step("second")->done);
  ASSERT_TRUE(read->reference);
  EXPECT_DOUBLE_EQ(read->reference->leave.at(0).second, 1e-3);
}

TEST(CaseLesson, NamesOfLandmarksBecomePoints) {
  auto read = parse_lesson(kGood, "my.toml");
  ASSERT_TRUE(read) << read.error().text;
  const Landmark of_the_bone[] = {{"entry", {}, {math::Vec3(9, 9, 9)}, {}, 0},
                                  {"antrum", {}, {math::Vec3(1, 0, 0)}, {}, 0}};
  const auto placed = place(*read, of_the_bone, "my.toml");
  ASSERT_TRUE(placed) << placed.error().text;
  const CaseRegion& way = *placed->region("way");
  ASSERT_EQ(way.add.size(), 5U);
  const math::Vec3 entry(1e-3, 2e-3, 3e-3);
  EXPECT_EQ(way.add[0].kind, ShapeKind::ball);
  EXPECT_LT((way.add[0].a.at - entry).norm(), 1e-15) << "the case's own landmark comes first";
  EXPECT_DOUBLE_EQ(way.add[0].radius, 4e-3);
  EXPECT_EQ(way.add[1].a.at, math::Vec3::Zero());
  EXPECT_LT((way.add[1].b.at - entry).norm(), 1e-15);
  EXPECT_LT((way.add[2].size - math::Vec3(2e-3, 4e-3, 6e-3)).norm(), 1e-15);
  EXPECT_EQ(way.add[3].points.size(), 3U);
  EXPECT_EQ(way.add[3].from, 0.25);
  EXPECT_EQ(way.add[4].other, "wall");
  EXPECT_EQ(way.take[0].normal, math::Vec3::UnitZ());
  EXPECT_DOUBLE_EQ(way.take[0].a.at.z(), 5e-3);
  EXPECT_EQ(way.take[1].structure, "nerve");
  EXPECT_NE(placed->landmark("antrum"), nullptr);
}

TEST(CaseLesson, ALandmarkThatNobodyHasIsNamedWithItsLine) {
  const std::string text = with(kGood, "at = \"entry\"", "at = \"the moon\"");
  const auto read = parse_lesson(text, "my.toml");
  ASSERT_TRUE(read) << "the bone may have it: " << read.error().text;
  const auto placed = place(*read, {}, "my.toml");
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error().text, "my.toml: " + line_of(text, "the moon") +
                                     ": ball: there is no landmark \"the moon\"; use one of entry, "
                                     "vein, roof");
  const std::string point = with(kGood, "along = \"vein\"", "along = \"entry\"");
  const auto no_curve = place(*parse_lesson(point, "my.toml"), {}, "my.toml");
  ASSERT_FALSE(no_curve);
  EXPECT_NE(no_curve.error().text.find("is a point"), std::string::npos) << no_curve.error().text;
  const std::string show = with(kGood, "show = [\"entry\"", "show = [\"moon\"");
  const auto shown = place(*parse_lesson(show, "my.toml"), {}, "my.toml");
  ASSERT_FALSE(shown);
  EXPECT_NE(shown.error().text.find("\"moon\""), std::string::npos);
}

TEST(CaseLesson, APieceIsPlannedFromALandmark) {
  const std::string text = std::string(kGood) +
                           "[[piece]]\ntitle.en = \"chin\"\ntitle.sv = \"haka\"\nnear = \"entry\"\n"
                           "by_mm = [0, -5, 0]\nturn_deg = [0, 0, 90]\n";
  const auto read = parse_lesson(text, "my.toml");
  ASSERT_TRUE(read) << read.error().text;
  const auto placed = place(*read, {}, "my.toml");
  ASSERT_TRUE(placed) << placed.error().text;
  ASSERT_EQ(placed->pieces.size(), 1U);
  const PlannedPiece& piece = placed->pieces[0];
  EXPECT_EQ(piece.title.in("sv"), "haka");
  EXPECT_LT((piece.near.at - math::Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_LT((piece.by - math::Vec3(0, -5e-3, 0)).norm(), 1e-15);
  EXPECT_NEAR(piece.turn.z(), 1.5707963267948966, 1e-12);
  const auto lost = place(
      *parse_lesson(with(text, "near = \"entry\"", "near = \"moon\""), "my.toml"), {}, "my.toml");
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.error().text.find("near: there is no landmark \"moon\""), std::string::npos)
      << lost.error().text;
  for (const auto& [from, to, says] :
       {std::tuple{"by_mm = [0, -5, 0]\nturn_deg = [0, 0, 90]", "", "or both"},
        std::tuple{"by_mm = [0, -5, 0]", "by_mm = [0, -5]", "three numbers"},
        std::tuple{"by_mm = [0, -5, 0]", "by_mm = [0, -5000, 0]", "200 mm"},
        std::tuple{"turn_deg = [0, 0, 90]", "turn_deg = [0, 0, 270]", "180 degrees"},
        std::tuple{"near = \"entry\"\n", "", "landmark's name"},
        std::tuple{"by_mm", "by", "not a known field"}}) {
    const auto wrong = parse_lesson(with(text, from, to), "my.toml");
    ASSERT_FALSE(wrong) << from;
    EXPECT_NE(wrong.error().text.find(says), std::string::npos) << wrong.error().text;
    EXPECT_NE(wrong.error().text.find("piece[1]"), std::string::npos) << wrong.error().text;
  }
}

TEST(CaseLesson, MistakesAreNamedByFileLineFieldAndRemedy) {
  struct Mistake {
    std::string from, to, field, says;
  };
  const Mistake mistakes[] = {
      {"format = 2", "format = 3", "format", "newer than this burr"},
      {"format = 2", "format = 1.5", "format", "1 or 2"},
      {"format = 2", "format = 1", "approach", "add the line format = 2"},
      {"title.sv = \"En", "title.swedish = \"En", "title.swedish", "two letters"},
      {"title.sv = \"En lektion\"", "title.sv = 7", "title.sv", "text"},
      {"[[-2, 0, 0]", "[[0, 0, 0]", "approach", "[0, 0, 0]"},
      {"[[-2, 0, 0]", "[[0, 0]", "approach", "list of points"},
      {"[[0, 3, 0]]", "[[0, 0, 0]]", "step[1].approach", "[0, 0, 0]"},
      {"at_mm = [1, 2, 3]", "at = [1, 2, 3]", "landmark[1].at", "not a known field"},
      {"at_mm = [1, 2, 3]", "", "landmark[1].at_mm", "for a point"},
      {"points_mm = [[0, 0, 0], [0, 0, 10], [0, 5, 10]]", "points_mm = [[0, 0, 0]]",
       "landmark[2].points_mm", "two points"},
      {"normal = [0, 0, 3]", "normal = [0, 0, 0]", "landmark[3].normal", "direction"},
      {"name = \"vein\"", "name = \"entry\"", "landmark.name", "twice"},
      {"shape = \"ball\"", "shape = \"egg\"", "region[1].add[1].shape", "use one of ball"},
      {"at = \"entry\", radius_mm = 4", "at = \"entry\"", "region[1].add[1].radius_mm", "missing"},
      {"at = \"entry\", radius_mm = 4", "radius_mm = 4", "region[1].add[1].at", "landmark's name"},
      {"at = \"entry\", radius_mm = 4", "at = \"entry\", r = 4", "region[1].add[1].r",
       "not a known field"},
      {"size_mm = [2, 4, 6]", "size_mm = [2, 0, 6]", "region[1].add[3].size_mm", "above 0"},
      {"from = 0.25, to = 0.5", "from = 0.6, to = 0.5", "region[1].add[4].from", "below"},
      {"along = \"vein\", ", "", "region[1].add[4].along", "CURVE"},
      {"other = \"wall\"", "other = \"well\"", "region.other", "use one of nerve, wall, drum"},
      {"normal = [0, 0, 2]", "normal = [0, 0, 0]", "region[1].take[1].normal", "direction"},
      {"intact = \"soft\"", "intact = \"whole\"", "structure[1].intact", "solid, soft, plate"},
      {"volume_mm3 = [40, 200]", "volume_mm3 = [200, 40]", "structure[1].volume_mm3",
       "the least and the most"},
      {"inscribed_mm = [0.5, 1.6]", "inscribed_mm = 0.5", "structure[1].inscribed_mm",
       "the least and the most"},
      {"touches = [\"wall\"]", "touches = [\"hall\"]", "structure.touches", "\"hall\""},
      {"glass = true", "glass = 1", "structure[3].glass", "true or false"},
      {"glass = true", "glass = true\nintact = \"soft\"", "structure[3].glass",
       "leave out glass or intact"},
      {"id = \"second\"", "id = \"first\"", "step.id", "twice"},
      {"say = \"Close it.\"", "", "step[2].say", "missing"},
      {"must_precede = [\"second\"]", "must_precede = [\"third\"]", "step.must_precede",
       "use one of first, second"},
      {"say = \"Close it.\"", "say = \"Close it.\"\nmust_precede = [\"first\"]",
       "step.must_precede", "circle"},
      {"spare = [\"nerve\"]", "spare = [\"drum\"]", "step.spare", "glass"},
      {"spare = [\"nerve\"]", "spare = \"nerve\"", "step[1].spare", "list of texts"},
      {"region = \"way\"", "region = \"path\"", "step.region", "\"path\""},
      {"kind = \"diamond\", diameter_mm = [2, 4]", "", "step[1].tool.kind", "missing"},
      {"kind = \"diamond\", diameter_mm = [2, 4]", "name = \"spoon\"", "step[1].tool.name",
       "use one of fissure-bur"},
      {"kind = \"diamond\", diameter_mm = [2, 4]", "name = \"flame\", kind = \"diamond\"",
       "step[1].tool.kind", "leave it out"},
      {"step = \"first\"", "step = \"last\"", "complication.step", "\"last\""},
      {"fade = \"2,alternate:4,off\"", "fade = \"slowly\"", "feedback.fade", "2,alternate:4,off"},
      {"fade = \"2,alternate:4,off\"", "fade = \"2,off,3\"", "feedback.fade", "on or off"},
      {"learn = [\"step\"", "learn = [\"score\"", "feedback.learn", "\"score\" is not known"},
      {"exam = []", "exam = [\"distance\"]", "feedback.exam", "never \"distance\""},
      {"measure = \"removed\", ", "", "step[1].done.measure", "missing"},
      {"share = 0.7 }", "share = \"most\" }", "step[1].done.share", "number"},
      {"share = 0.7 }", "region = \"moon\" }", "step.done.region", "\"moon\""},
      {"remove = [\"way\"]", "remove = [\"wey\"]", "reference.remove", "use one of way"},
      {"remove = [\"way\"]", "remove = [\"way\"]\nfill = [\"gap\"]", "reference.fill",
       "use one of way"},
      {"say = \"Close it.\"", "say = \"Close it.\"\nadds = true", "step[2].adds",
       "needs the region"},
      {"\"nerve\", mm = 1 }", "\"nerve\", mm = -1 }", "reference.leave[1].mm", "above 0"},
      {"[[step]]\nid = \"second\"", "[[stepp]]\nid = \"second\"", "stepp", "not a known field"},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string text = with(kGood, mistake.from, mistake.to);
    const auto read = parse_case(text, "my.toml");
    ASSERT_FALSE(read) << mistake.from << " -> " << mistake.to;
    const std::string& said = read.error().text;
    EXPECT_EQ(said.find("my.toml: line "), 0U) << said;
    EXPECT_NE(said.find(": " + mistake.field + ": "), std::string::npos)
        << mistake.field << " in " << said;
    EXPECT_NE(said.find(mistake.says), std::string::npos) << mistake.says << " in " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  }
}

// Above the limits the work of checking grows with the square of a list, or worse.
TEST(CaseLesson, ListsAndTextsHaveALimit) {
  const auto repeated = [](const std::string& text, int times) {
    std::string all;
    for (int n = 0; n < times; ++n) all += with(text, "#", std::to_string(n));
    return all;
  };
  const std::string step = "[[step]]\nid = \"s#\"\nsay = \"Go on.\"\n";
  EXPECT_TRUE(parse_case(kGood + repeated(step, 198), "my.toml"));
  const auto steps = parse_case(kGood + repeated(step, 199), "my.toml");
  ASSERT_FALSE(steps);
  EXPECT_NE(steps.error().text.find("step: has 201 entries; use at most 200"), std::string::npos)
      << steps.error().text;
  const std::string place = "[[landmark]]\nname = \"l#\"\nat_mm = [0, 0, 0]\n";
  EXPECT_TRUE(parse_case(kGood + repeated(place, 997), "my.toml"));
  EXPECT_FALSE(parse_case(kGood + repeated(place, 998), "my.toml"));
  const auto names =
      parse_case(with(kGood, "spare = [\"nerve\"]", "spare = [" + repeated("\"n#\", ", 1001) + "]"),
                 "my.toml");
  ASSERT_FALSE(names);
  EXPECT_NE(names.error().text.find("at most 1000"), std::string::npos) << names.error().text;
  const auto points = parse_case(
      with(kGood, "[[0, 0, 0], [0, 0, 10]", "[" + repeated("[0, 0, #], ", 1001) + "[0, 0, 10]"),
      "my.toml");
  ASSERT_FALSE(points);
  EXPECT_NE(points.error().text.find("landmark[2].points_mm: has 1003"), std::string::npos)
      << points.error().text;
  const auto text = parse_case(kGood + std::string(1 << 20, '#'), "my.toml");
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().text.find("a case at most 1048576"), std::string::npos)
      << text.error().text;
}

// As many ways through the steps as there can be: each step comes before all later ones.
TEST(CaseLesson, ACircleIsFoundAmongTwoHundredSteps) {
  std::string text =
      "format = 2\ntitle = \"Many\"\nphantom = \"block\"\n"
      "[burr]\ndiameter_mm = 4\nrpm = 60000\n";
  std::string later;
  for (int n = 199; n >= 0; --n) {
    const std::string id = "\"s" + std::to_string(n) + "\"";
    text += "[[step]]\nid = " + id + "\nsay = \"Go on.\"\nmust_precede = [" + later + "]\n";
    later += id + ", ";
  }
  const auto good = parse_case(text, "my.toml");
  EXPECT_TRUE(good) << good.error().text;
  const auto bad =
      parse_case(with(text, "must_precede = []", "must_precede = [\"s100\"]"), "my.toml");
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().text.find("circle"), std::string::npos) << bad.error().text;
}

TEST(CaseLesson, TheLineIsThatOfTheMistake) {
  for (const auto& [from, to] : {std::pair{"diameter_mm = 4\n", "diameter_mm = 70\n"},
                                 std::pair{"pieces = [1, 2]", "pieces = [2, 1]"},
                                 std::pair{"{ shape = \"box\"", "{ shape = \"bax\""},
                                 std::pair{"fade = \"2,alternate:4,off\"", "fade = \"never\""}}) {
    const std::string text = with(kGood, from, to);
    const auto read = parse_case(text, "my.toml");
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().text.find("my.toml: " + line_of(text, to) + ": "), std::string::npos)
        << read.error().text;
  }
}

TEST(CaseLesson, ACaseOfFormatOneHasAnEmptyLesson) {
  const auto work = parse_case(
      "title = \"Old\"\nphantom = \"block\"\n[burr]\ndiameter_mm = 4\nrpm = 60000\n", "old.toml");
  ASSERT_TRUE(work) << work.error().text;
  const auto lesson = lesson_of(*work);
  ASSERT_TRUE(lesson) << lesson.error().text;
  EXPECT_EQ(lesson->format, 1);
  EXPECT_TRUE(lesson->steps.empty() && lesson->structures.empty() && lesson->regions.empty());
  EXPECT_EQ(lesson->title.in("en"), "Old");
}

TEST(CaseLesson, ATitleInSeveralLanguagesIsEnglishInTheCase) {
  const auto work = parse_case(kGood, "my.toml");
  ASSERT_TRUE(work) << work.error().text;
  EXPECT_EQ(work->title, "A lesson");
  EXPECT_EQ(lesson_of(*work)->title.in("sv"), "En lektion") << "the recording's text holds it";
}

TEST(CaseLesson, NoTextHoweverBrokenDoesHarm) {
  const std::uint64_t seed = 26;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  for (int n = 0; n < 3000; ++n) {
    std::string text = kGood;
    for (int hits = 1 + static_cast<int>(random() % 4); hits > 0; --hits) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0)
        text[at] = static_cast<char>(random() % 256);
      else
        text.erase(at, random() % 40);
    }
    const auto read = parse_lesson(text, "x.toml");
    if (read)
      static_cast<void>(place(*read, {}, "x.toml"));
    else
      EXPECT_EQ(read.error().text.find("x.toml: "), 0U) << read.error().text;
  }
}

TEST(CaseLesson, BuiltInCasesOfFormatTwoSpeakThreeLanguages) {
  int count = 0;
  for (const std::string& name : built_in_cases()) {
    SCOPED_TRACE(name);
    const auto work = read_case(name);
    ASSERT_TRUE(work) << work.error().text;
    const auto lesson = lesson_of(*work);
    ASSERT_TRUE(lesson) << lesson.error().text;
    if (lesson->format < 2) continue;
    ++count;
    EXPECT_FALSE(lesson->steps.empty());
    const auto complete = [](const Texts& texts) {
      return texts.by_language.contains("en") && texts.by_language.contains("sv") &&
             texts.by_language.contains("de");
    };
    EXPECT_TRUE(complete(lesson->title));
    EXPECT_TRUE(complete(lesson->description));
    for (const Step& step : lesson->steps)
      EXPECT_TRUE(complete(step.title) && complete(step.say)) << step.id;
    for (const Complication& one : lesson->complications) EXPECT_TRUE(complete(one.say)) << one.id;
  }
  EXPECT_GE(count, 1);
}

// A case may name a landmark that its bone has, without saying again where it is.
TEST(CaseLesson, ATitleAloneNamesALandmarkOfTheBone) {
  const std::string with =
      std::string(kGood) +
      "[[landmark]]\nname = \"spine\"\ntitle = { en = \"spine\", sv = \"tagg\" }\n"
      "[[landmark]]\nname = \"nowhere\"\ntitle = \"nowhere\"\n";
  auto read = parse_lesson(with, "c.toml");
  ASSERT_TRUE(read) << read.error().text;
  const Landmark bones[] = {{"spine", {}, {math::Vec3(1, 2, 3)}, {}, 0}};
  const auto placed = place(std::move(*read), bones, "c.toml");
  ASSERT_TRUE(placed) << placed.error().text;
  ASSERT_NE(placed->landmark("spine"), nullptr);
  EXPECT_EQ(placed->landmark("spine")->title.in("sv"), "tagg");
  ASSERT_EQ(placed->landmark("spine")->points.size(), 1U);
  EXPECT_EQ(placed->landmark("spine")->points[0], math::Vec3(1, 2, 3));
  EXPECT_EQ(placed->landmark("nowhere"), nullptr) << "the bone has none";
  EXPECT_FALSE(parse_lesson(std::string(kGood) + "[[landmark]]\nname = \"bare\"\n", "c.toml"));
}

}  // namespace
}  // namespace burr::scenario
