// Rubrics: every field comes back, and every mistake is one sentence with its line.
#include "burr/scoring/rubric.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "burr/scenario/open_lesson.h"
#include "support/folder.h"

namespace burr::scoring {
namespace {

constexpr const char* kGood = R"([rubric]
name = "one"
version = 2
case = "block"
[[item]]
id = "nerve.seen"
part = "product"
weight = 2
measure = "identified"
structure = "nerve"
region = "pit"
cover_mm = 0.8
requires = "nerve.whole"
source = "nobody"
say.en = "Find it."
say.sv = "Hitta den."
[[item]]
id = "nerve.whole"
part = "product"
gate = true
measure = "intact_soft"
structure = "nerve"
calibrated = true
say = "Leave it."
)";

// kGood with one text replaced
std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string trouble_of(const std::string& text) {
  const auto read = parse_rubric(text, "r.toml");
  return read ? "no error" : read.error().text;
}

TEST(Rubric, AGradeIsInTheUnitOfItsMeasure) {
  const auto whole = parse_rubric(with("gate = true", "grade = [1, 0]"), "r.toml");
  ASSERT_TRUE(whole) << whole.error().text;
  ASSERT_TRUE(whole->items[1].grade);
  EXPECT_DOUBLE_EQ(whole->items[1].grade->first, 1e-3);
  EXPECT_EQ(whole->items[1].grade->second, 0);
  const auto share = parse_rubric(with("weight = 2", "grade = [0.2, 0.4]"), "r.toml");
  ASSERT_TRUE(share) << share.error().text;
  EXPECT_DOUBLE_EQ(share->items[0].grade->first, 0.2);
  EXPECT_FALSE(share->items[1].grade);
  EXPECT_EQ(trouble_of(with("weight = 2", "grade = [0.2, 0.2]")),
            "r.toml: line 8: item[1].grade: the value that earns nothing and the one that earns "
            "everything "
            "must differ");
  EXPECT_EQ(trouble_of(with("weight = 2", "grade = [0.2]")),
            "r.toml: line 8: item[1].grade: must be two numbers from 0 to 1000, [0, 1]");
  const std::string two =
      with("weight = 2\nmeasure = \"identified\"", "grade = [0.2, 1]\nmeasure = \"skeletonised\"");
  EXPECT_EQ(
      trouble_of(std::string(two).replace(two.find("cover_mm"), 8, "hi_mm")),
      "r.toml: line 8: item[1].grade: \"skeletonised\" is decided by two numbers, so it cannot be "
      "graded; leave \"grade\" out");
}

TEST(Rubric, ACaseOfItsOwnIsSoughtFromTheFolderOfTheRubric) {
  const burr::test::Folder folder;
  const std::string file = folder / "r.toml";
  std::ofstream(file) << with("\"block\"", "\"../cases/mine.toml\"");
  const auto read = read_rubric(file);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->case_name, "mine");
  EXPECT_EQ(read->case_source, folder / "../cases/mine.toml");
  const auto built_in = read_rubric("block");
  ASSERT_TRUE(built_in) << built_in.error().text;
  EXPECT_EQ(built_in->case_name, "block");
  EXPECT_EQ(built_in->case_source, "block");
}

TEST(Rubric, EveryFieldComesBack) {
  const auto read = parse_rubric(kGood, "r.toml");
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->name, "one");
  EXPECT_EQ(read->version, 2);
  EXPECT_EQ(read->case_name, "block");
  ASSERT_EQ(read->items.size(), 2U);
  const Item& seen = read->items[0];
  EXPECT_EQ(seen.weight, 2);
  EXPECT_FALSE(seen.gate);
  EXPECT_FALSE(seen.calibrated);
  EXPECT_EQ(seen.structure, "nerve");
  EXPECT_EQ(seen.region, "pit");
  EXPECT_DOUBLE_EQ(seen.limit("cover_mm"), 0.8e-3);
  EXPECT_DOUBLE_EQ(seen.limit("share"), 0.3);  // the preset
  EXPECT_EQ(seen.needs, "nerve.whole");
  EXPECT_EQ(seen.say.in("sv"), "Hitta den.");
  EXPECT_TRUE(read->items[1].gate);
  EXPECT_TRUE(read->items[1].calibrated);
}

TEST(Rubric, AMistakeIsASentenceWithItsLine) {
  EXPECT_EQ(trouble_of(with("cover_mm = 0.8", "cover_mm = -1")),
            "r.toml: line 12: item[1].cover_mm: must be a number above 0 and at most 5");
  const std::string unknown = trouble_of(with("cover_mm = 0.8", "cover = 0.8"));
  EXPECT_TRUE(unknown.starts_with("r.toml: line 12: item[1].cover: is not a known field; use id,"))
      << unknown;
  EXPECT_NE(unknown.find("cover_mm"), std::string::npos) << unknown;
  const std::string measure = trouble_of(with("\"identified\"", "\"found\""));
  EXPECT_TRUE(
      measure.starts_with("r.toml: line 9: item[1].measure: \"found\" is not a known "
                          "measure; use one of identified, skeletonised,"))
      << measure;
  EXPECT_EQ(trouble_of(with("requires = \"nerve.whole\"", "requires = \"x\"")),
            "r.toml: line 13: requires: there is no item \"x\"; use the id of one of these: "
            "nerve.seen, nerve.whole");
  EXPECT_EQ(trouble_of(with("gate = true", "requires = \"nerve.seen\"")),
            "r.toml: line 20: requires: \"nerve.seen\" leads back to itself; take one \"requires\" "
            "out of the circle");
  EXPECT_EQ(trouble_of(with("\"nerve.whole\"\npart", "\"nerve.seen\"\npart")),
            "r.toml: line 17: id: \"nerve.seen\" is also the item of line 5; give it another id");
  EXPECT_EQ(trouble_of(with("part = \"product\"\nweight", "part = \"process\"\nweight")),
            "r.toml: line 7: item[1].part: \"identified\" measures the product; use part = "
            "\"product\"");
}

TEST(Rubric, RequiresStaysInItsPart) {
  std::string text = kGood;
  text +=
      "[[item]]\nid = \"calm\"\npart = \"process\"\nmeasure = \"restraint\"\n"
      "requires = \"nerve.whole\"\nsay = \"Press less.\"\n";
  EXPECT_EQ(trouble_of(text),
            "r.toml: line 29: requires: \"nerve.whole\" is an item of the product, and this one of "
            "the process; the two parts are never mixed, so require an item of the same part");
}

TEST(Rubric, HasAtMostFiveHundredItems) {
  // each requires the one before
  const auto many = [](int count) {
    std::string text = kGood;
    for (int n = 2; n < count; ++n) {
      const std::string id = "i" + std::to_string(n);
      text += "[[item]]\nid = \"" + id + "\"\npart = \"product\"\nmeasure = \"intact_soft\"\n" +
              "structure = \"nerve\"\nsay = \"Leave it.\"\nrequires = \"" +
              (n == 2 ? "nerve.seen" : "i" + std::to_string(n - 1)) + "\"\n";
    }
    return text;
  };
  EXPECT_EQ(trouble_of(many(500)), "no error");
  EXPECT_NE(trouble_of(many(501)).find("item: has 501 entries; use at most 500"),
            std::string::npos);
}

TEST(Rubric, TheCaseMustHaveWhatItNames) {
  const auto lesson = scenario::parse_lesson(R"(format = 2
title = "t"
phantom = "block"
[burr]
diameter_mm = 4
[[structure]]
name = "nerve"
[[region]]
name = "pit"
add = [{ shape = "ball", at = [0, 0, 0], radius_mm = 4 }]
)",
                                             "c.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  const auto good = parse_rubric(kGood, "r.toml");
  ASSERT_TRUE(good);
  EXPECT_TRUE(check(*good, *lesson));
  const auto region = parse_rubric(with("\"pit\"", "\"pot\""), "r.toml");
  ASSERT_TRUE(region);
  EXPECT_EQ(check(*region, *lesson).error().text,
            "r.toml: line 11: region: the case \"block\" has no region \"pot\"; use one of pit");
  const auto structure = parse_rubric(with("\"nerve\"\nregion", "\"vein\"\nregion"), "r.toml");
  ASSERT_TRUE(structure);
  EXPECT_EQ(check(*structure, *lesson).error().text,
            "r.toml: line 10: structure: the case \"block\" has no structure \"vein\"; use one of "
            "nerve");
  // the other cavities of an item about one cavity
  const char* const cavity =
      "[rubric]\nname = \"r\"\nversion = 1\ncase = \"block\"\n[[item]]\nid = \"a\"\n"
      "part = \"product\"\nmeasure = \"cavity_depth\"\nregion = \"pit\"\nwithin = \"half\"\nsay = "
      "\"s\"\n";
  const auto within = parse_rubric(cavity, "r.toml");
  ASSERT_TRUE(within) << within.error().text;
  EXPECT_EQ(check(*within, *lesson).error().text,
            "r.toml: line 10: within: the case \"block\" has no region \"half\"; use one of pit");
  const auto elsewhere = parse_rubric(with("region = \"pit\"", "within = \"pit\""), "r.toml");
  ASSERT_FALSE(elsewhere);
  EXPECT_NE(elsewhere.error().text.find("within"), std::string::npos);
}

TEST(Rubric, AnAxisNeedsACurveWithADirectionAndAPlaneItemAPlane) {
  const auto lesson = scenario::parse_lesson(R"(format = 2
title = "t"
phantom = "block"
[burr]
diameter_mm = 4
[[landmark]]
name = "round"
points_mm = [[0, 0, 0], [5, 0, 0], [0, 0, 0]]
[[landmark]]
name = "cut"
at_mm = [0, 0, 0]
normal = [0, 0, 1]
[[region]]
name = "pit"
add = [{ shape = "ball", at = [0, 0, 0], radius_mm = 4 }]
)",
                                             "c.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  const auto trouble = [&](const std::string& item) {
    const auto read = parse_rubric(
        "[rubric]\nname = \"r\"\nversion = 1\ncase = \"block\"\n[[item]]\nid = \"a\"\n"
        "part = \"product\"\nregion = \"pit\"\nsay = \"s\"\n" +
            item,
        "r.toml");
    if (!read) return read.error().text;
    const Status fits = check(*read, *lesson);
    return fits ? std::string("no error") : fits.error().text;
  };
  EXPECT_EQ(
      trouble("measure = \"axis_angle\"\nalong = \"round\"\n"),
      "r.toml: line 11: along: the curve \"round\" begins and ends at the same point, so it is no "
      "axis; use another one");
  EXPECT_EQ(
      trouble("measure = \"axis_angle\"\nalong = \"cut\"\n"),
      "r.toml: line 11: along: the case \"block\" has no curve among its landmarks \"cut\"; use "
      "one of round");
  EXPECT_EQ(trouble("measure = \"plane_angle\"\nplane = \"round\"\n"),
            "r.toml: line 11: plane: the case \"block\" has no plane \"round\"; use one of cut");
  EXPECT_EQ(trouble("measure = \"plane_angle\"\nplane = \"cut\"\n"), "no error");
}

TEST(Rubric, TheBuiltInOnesAreRead) {
  for (const std::string& name : built_in_rubrics()) {
    const auto read = read_rubric(name);
    ASSERT_TRUE(read) << read.error().text;
    for (const Item& item : read->items) {
      EXPECT_FALSE(item.calibrated) << item.id;
      for (const char* language : {"en", "sv", "de"})
        EXPECT_TRUE(item.say.by_language.contains(language)) << item.id << " " << language;
    }
  }
}

}  // namespace
}  // namespace burr::scoring
