// A scene as the text of a case: what is read again is what was written, and the text stays.
#include "burr/scenario/write_case.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "burr/base/given.h"
#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"

namespace burr::scenario {
namespace {

constexpr const char* kTools = R"toml([[tool]]
name = "peg"
title = { en = "Peg", sv = "Tapp" }
drive = "turning"
rpm = 1000
[[tool.part]]
shape = "cylinder"
role = "cuts"
diameter_mm = 4.1
length_mm = 6
)toml";

CaseFile block() {
  CaseFile file;
  file.title = "A block";
  file.phantom = "block";
  file.burr_mm = 6.5;
  file.rpm = 1000;
  file.session.set("stiffness_n_per_m", 777.7);
  return file;
}

TEST(WriteCase, NumbersComeBackToTheBit) {
  CaseFile file = block();
  file.voxel_mm = 0.45;
  file.session.set("torque_mnm", 0.1 + 0.2);
  file.session.set("guard", true);
  file.session.set("teeth", std::int64_t{7});
  file.session.set("touch", std::string("shaft"));
  const auto text = write_case(file);
  ASSERT_TRUE(text.ok()) << text.error().text;
  const auto read = parse_case(*text, "scene.toml");
  ASSERT_TRUE(read.ok()) << read.error().text;
  ASSERT_TRUE(read->session);
  EXPECT_EQ(burr_mm(*read), 6.5);
  EXPECT_EQ(rpm(*read), 1000);
  EXPECT_EQ(voxel_mm(*read), 0.45);
  const auto has = [&](const char* word, const base::Given& value) {
    return read->session->get(word) != nullptr && *read->session->get(word) == value;
  };
  EXPECT_TRUE(has("stiffness_n_per_m", 777.7));
  EXPECT_TRUE(has("torque_mnm", 0.1 + 0.2));
  EXPECT_TRUE(has("guard", true));
  EXPECT_TRUE(has("teeth", std::int64_t{7}));
  EXPECT_TRUE(has("touch", std::string("shaft")));
  EXPECT_EQ(read->session->get("drag"), nullptr);
  // the shortest numbers that do so
  EXPECT_NE(text->find("voxel_mm = 0.45\n"), std::string::npos) << *text;
  EXPECT_NE(text->find("diameter_mm = 6.5\n"), std::string::npos) << *text;
}

// Without [session] a case keeps the last bit that its recordings have.
TEST(WriteCase, ACaseWithoutSessionKeepsItsBits) {
  const auto read = parse_case(
      "title = \"x\"\nphantom = \"block\"\nvoxel_mm = 0.45\n[burr]\ndiameter_mm = 6.5\nrpm = "
      "1000\n",
      "x.toml");
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_EQ(burr_mm(*read), 2e3 * (0.5e-3 * 6.5));
  EXPECT_NE(burr_mm(*read), 6.5);
  EXPECT_EQ(voxel_mm(*read), 1e3 * (1e-3 * 0.45));
}

TEST(WriteCase, WhatACaseTeachesStays) {
  for (const std::string& name : built_in_cases()) {
    const auto work = read_case(name);
    ASSERT_TRUE(work.ok());
    CaseFile file = block();
    file.name = name;
    file.from = work->text;
    file.title.clear();
    file.phantom = work->phantom;
    const auto text = write_case(file);
    ASSERT_TRUE(text.ok()) << text.error().text;
    const auto again = parse_case(*text, name + ".toml");
    ASSERT_TRUE(again.ok()) << again.error().text;
    EXPECT_EQ(again->title, work->title);
    EXPECT_EQ(again->description, work->description);
    EXPECT_EQ(again->spare, work->spare);
    EXPECT_EQ(again->targets.size(), work->targets.size());
    const auto before = lesson_of(*work), after = lesson_of(*again);
    ASSERT_TRUE(before.ok() && after.ok());
    ASSERT_EQ(after->steps.size(), before->steps.size());
    for (std::size_t n = 0; n < before->steps.size(); ++n) {
      EXPECT_EQ(after->steps[n].id, before->steps[n].id);
      EXPECT_EQ(after->steps[n].say.by_language, before->steps[n].say.by_language);
      EXPECT_EQ(after->steps[n].done.has_value(), before->steps[n].done.has_value());
    }
    EXPECT_EQ(after->landmarks.size(), before->landmarks.size());
    EXPECT_EQ(after->regions.size(), before->regions.size());
    EXPECT_EQ(after->structures.size(), before->structures.size());
    // written once more, it is the same text
    file.from = again->text;
    EXPECT_EQ(*write_case(file), *text);
  }
}

TEST(WriteCase, AToolOfTheCasesOwn) {
  CaseFile file = block();
  file.tool = "peg";
  EXPECT_FALSE(write_case(file).ok());  // nobody knows it
  file.tools = kTools;
  const auto text = write_case(file);
  ASSERT_TRUE(text.ok()) << text.error().text;
  const auto read = parse_case(*text, "scene.toml");
  ASSERT_TRUE(read.ok()) << read.error().text;
  ASSERT_EQ(read->own_tools.size(), 1U);
  const auto rack = parse_rack(kTools, "tools.toml", {});
  ASSERT_TRUE(rack.ok());
  EXPECT_EQ(read->own_tools[0].title.by_language, rack->all[0].title.by_language);
  EXPECT_EQ(read->own_tools[0].cutter.speed_rad_s, rack->all[0].cutter.speed_rad_s);
  EXPECT_EQ(read->own_tools[0].tool.parts[0].shape.a, rack->all[0].tool.parts[0].shape.a);
  file.from = read->text;
  file.tools.clear();
  EXPECT_EQ(*write_case(file), *text);
}

TEST(WriteCase, AToolWithAMeshIsRefused) {
  CaseFile file = block();
  file.tool = "punch";
  file.tools =
      "[[tool]]\nname = \"punch\"\ntitle = \"Punch\"\ndrive = \"turning\"\nrpm = 1\n[[tool.part]]\n"
      "shape = \"mesh\"\nrole = \"cuts\"\nfile = \"punch.stl\"\n";
  const auto text = write_case(file);
  ASSERT_FALSE(text.ok());
  EXPECT_NE(text.error().text.find("\"mesh\" is not possible here"), std::string::npos)
      << text.error().text;
}

TEST(WriteCase, ASessionKeepsItsLines) {
  const std::string good =
      "title = \"x\"\nphantom = \"block\"\n[burr]\ndiameter_mm = 5\nrpm = 1000\n[session]\n";
  const auto read = parse_case(good + "rate_hz = 20\nteeth = 2.5\n", "x.toml");
  ASSERT_TRUE(read.ok()) << read.error().text;
  ASSERT_EQ(read->session->fields.size(), 2U);
  EXPECT_EQ(read->session->fields[0].line, 7U);
  EXPECT_EQ(read->session->fields[1].line, 8U);
  const auto wrong = parse_case(good + "rate_hz = [20]\n", "x.toml");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().text,
            "x.toml: line 7: session.rate_hz: must be a number, true or false, or text in quotes");
}

}  // namespace
}  // namespace burr::scenario
