// The tools of tools/tools.toml, and mistakes in a user's file.
#include "burr/scenario/rack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace burr::scenario {
namespace {

using math::Vec3;

TEST(Rack, BringsEveryKindOfTool) {
  const Rack& rack = built_in_rack();
  for (const char* name : {"fissure-bur", "lindemann", "flame", "cone", "wheel", "twist-drill",
                           "trephine", "sagittal-saw", "reciprocating-saw", "osteotome", "curette"})
    EXPECT_NE(rack.find(name), nullptr) << name;
  for (const RackTool& tool : rack.all) {
    SCOPED_TRACE(tool.name);
    for (const char* language : {"en", "sv", "de"})
      EXPECT_TRUE(tool.title.by_language.contains(language)) << language;
    EXPECT_FALSE(tool.source.empty());
    EXPECT_NEAR(tool.cutter.way.norm(), 1, 1e-12);
    EXPECT_GT(tool.tool.count, 1) << "something is held, too";
  }
}

// The distance of a place from the tool: to the nearest part of this role.
double distance_to(const RackTool& tool, tool::Role role, const Vec3& p_mm) {
  double least = 1e9;
  for (int n = 0; n < tool.tool.count; ++n) {
    const tool::Part& part = tool.tool.parts[static_cast<std::size_t>(n)];
    if (part.role != role) continue;
    least = std::min(least,
                     tool::distance(part.shape, part.tool_from_part.inverse() * (1e-3 * p_mm)).phi);
  }
  return 1e3 * least;
}

TEST(Rack, SizesAreThoseOfTheFile) {
  const Rack& rack = built_in_rack();
  const RackTool& bur = *rack.find("fissure-bur");  // 1.6 mm wide, 5 mm long
  EXPECT_NEAR(1e3 * cutting_width(bur), 1.6, 1e-9);
  EXPECT_NEAR(distance_to(bur, tool::Role::cuts, {1.8, 0, 0}), 1, 1e-9);
  EXPECT_NEAR(distance_to(bur, tool::Role::cuts, {0, 0, -3.5}), 1, 1e-9);
  EXPECT_NEAR(distance_to(bur, tool::Role::rubs, {1.6, 0, 10}), 1, 1e-9);
  const RackTool& saw = *rack.find("sagittal-saw");  // kerf 0.9 mm, blade 0.6 mm
  EXPECT_NEAR(distance_to(saw, tool::Role::cuts, {0, 1.45, 0}), 1, 1e-9);
  EXPECT_NEAR(distance_to(saw, tool::Role::rubs, {0, 1.3, 10}), 1, 1e-9);
  EXPECT_NEAR(tool::stroke_speed(saw.cutter), 4 * 1.05e-3 * 14000 / 60, 1e-12);
  const RackTool& drill = *rack.find("twist-drill");  // point angle 120 degrees
  EXPECT_NEAR(distance_to(drill, tool::Role::cuts, {0, 0, -1.231}), 1, 1e-9);
  const double z = -0.231 + 0.4 / std::tan(60 * std::numbers::pi / 180);
  EXPECT_NEAR(distance_to(drill, tool::Role::cuts, {0.6, 0, z}), 0, 1e-3) << "on the cone";
  EXPECT_NEAR(drill.cutter.speed_rad_s, 1200 * 2 * std::numbers::pi / 60, 1e-9);
}

constexpr const char* kTrephine = R"([[tool]]
name = "peg"
title = "Peg"
drive = "turning"
rpm = 1000
[[tool.part]]
shape = "cylinder"
role = "cuts"
diameter_mm = 4
length_mm = 6
)";

TEST(Rack, ToolsOfOnesOwnAreAddedAndReplace) {
  const auto rack = parse_rack(kTrephine, "mine.toml", built_in_rack());
  ASSERT_TRUE(rack.ok()) << rack.error().text;
  EXPECT_EQ(rack->all.size(), built_in_rack().all.size() + 1);
  ASSERT_NE(rack->find("peg"), nullptr);
  EXPECT_EQ(rack->find("peg")->group, "own");
  std::string other = kTrephine;
  other.replace(other.find("peg"), 3, "wheel");
  const auto replaced = parse_rack(other, "mine.toml", built_in_rack());
  ASSERT_TRUE(replaced.ok());
  EXPECT_EQ(replaced->all.size(), built_in_rack().all.size());
  EXPECT_NEAR(1e3 * cutting_width(*replaced->find("wheel")), 4, 1e-9);
}

TEST(Rack, AMistakeIsOneSentenceWithLineAndField) {
  const struct {
    const char *from, *to, *says;
  } mistakes[] = {
      {"drive = \"turning\"", "drive = \"spinning\"",
       "line 4: tool[1].drive: \"spinning\" is not known; use one of turning"},
      {"rpm = 1000", "stroke_mm = 2",
       "line 5: tool[1].stroke_mm: belongs to drive = \"oscillating or reciprocating\""},
      {"rpm = 1000\n", "", "tool[1].rpm: is missing"},
      {"rpm = 1000", "rpm = 1000\nlean_deg = 91",
       "tool[1].lean_deg: must be a number above 0 and at most 90"},
      {"\"cuts\"", "\"rubs\"", "tool[1].part: none cuts"},
      {"shape = \"cylinder\"", "shape = \"pipe\"",
       "tool[1].part[1].shape: \"pipe\" is not known; use one of ball, capsule"},
      {"shape = \"cylinder\"", "shape = \"tube\"",
       "tool[1].part[1].inner_mm: is missing; give a number"},
      {"shape = \"cylinder\"", "shape = \"tube\"\ninner_mm = 4.5",
       "tool[1].part[1].shape: has no body: edge_mm"},
      {"diameter_mm = 4", "diameter_mm = 0",
       "tool[1].part[1].diameter_mm: must be a number above 0"},
      {"length_mm = 6", "length_mm = 6\nedge_mm = 3",
       "tool[1].part[1].shape: has no body: edge_mm"},
      {"length_mm = 6", "from_mm = 6", "tool[1].part[1].from_mm: needs the other end too"},
      {"length_mm = 6", "lenght_mm = 6", "tool[1].part[1].lenght_mm: is not a known field"},
      {"name = \"peg\"", "name = \"My Peg\"", "tool[1].name: must be small letters"},
  };
  for (const auto& mistake : mistakes) {
    std::string text = kTrephine;
    const std::size_t at = text.find(mistake.from);
    ASSERT_NE(at, std::string::npos) << mistake.from;
    text.replace(at, std::string(mistake.from).size(), mistake.to);
    const auto rack = parse_rack(text, "mine.toml", built_in_rack());
    ASSERT_FALSE(rack.ok()) << mistake.to;
    EXPECT_NE(rack.error().text.find(mistake.says), std::string::npos) << rack.error().text;
    EXPECT_EQ(rack.error().text.rfind("mine.toml: line ", 0), 0U) << rack.error().text;
  }
  const auto missing = built_in_rack().get("hammer");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().text.find("use one of fissure-bur, lindemann"), std::string::npos);
}

}  // namespace
}  // namespace burr::scenario
