// Which tool was in the hand at every tick: in a recording, in one from before it was written down,
// and where the servo refused what was asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "burr/record/player.h"
#include "burr/record/timeline.h"
#include "burr/rt/flags.h"
#include "burr/sim/replay.h"
#include "burr/tick/mirror_plane.h"
#include "record/made_up.h"
#include "sim/commanded.h"

namespace burr::sim {
namespace {

using record::test::Folder;
using tick::CommandKind;
using tool::ToolState;

std::unique_ptr<record::Player> opened(const std::string& path) {
  auto player = record::Player::open(path);
  EXPECT_TRUE(player.ok()) << player.error().text;
  return std::move(*player);
}

std::vector<ToolState> tools_of(record::Player& player) {
  std::vector<ToolState> tools;
  record::StepCursor steps = player.steps();
  for (record::Step step; steps.next(step);) tools.push_back(step.row.tool);
  return tools;
}

void expect_same_to_the_bit(record::Player& player) {
  NoProgress quiet;
  auto bone = player.embedded_bone(256);
  ASSERT_TRUE(bone.ok()) << bone.error().text;
  const auto outcome = replay(player, std::move(*bone), quiet);
  ASSERT_TRUE(outcome.ok()) << outcome.error().text;
  EXPECT_FALSE(outcome->first_different_tick.has_value()) << outcome->difference;
  EXPECT_EQ(outcome->gaps, 0U);
  EXPECT_EQ(outcome->ticks, player.end_tick());
}

// In free air and in bone; a stroke is undone, and everything is undone; none is refused.
test::Commanded many_changes() {
  return {.motion = "pocket",
          .seconds = 3,
          .commands = {{20, {CommandKind::burr_radius, 2.5e-3}},
                       {30, {CommandKind::mirror_j, 12.25}},
                       {40, {CommandKind::spindle_speed, -900}},
                       {41, {CommandKind::spindle_speed, 4000}},
                       {900, {CommandKind::burr_kind, 1}},
                       {1000, {CommandKind::irrigation, 1}},
                       {1400, {CommandKind::undo, 0}},
                       {1800, {CommandKind::tool_mode, 3}},
                       {1900, {CommandKind::mirror_off, 0}},
                       {1900, {CommandKind::irrigation, 0}},
                       {2000, {CommandKind::tool_mode, 0}},
                       {2100, {CommandKind::burr_kind, 0}},
                       {2500, {CommandKind::reset, 0}}}};
}

ToolState expected_at(std::uint64_t tick) {
  ToolState tool{.radius = tick < 20 ? 2e-3 : 2.5e-3,
                 .full_speed = tick < 40   ? tick::ServoSettings{}.spindle_rad_s
                               : tick < 41 ? -900
                                           : 4000};
  if (tick >= 30 && tick < 1900) tool.mirror_axis = 1, tool.mirror_twice = 25;  // the nearest plane
  if (tick >= 900 && tick < 2100) tool.kind = tool::BurrKind::diamond;
  if (tick >= 1000 && tick < 1900) tool.irrigated = true;
  if (tick >= 1800 && tick < 2000) tool.mode = tool::Mode::restore;
  return tool;
}

TEST(RecordedTool, ChangesAtItsTickAndNotByAnUndo) {
  const Folder folder;
  test::record_commanded(folder / "s.mcap", many_changes());
  const auto player = opened(folder / "s.mcap");
  EXPECT_TRUE(player->tool_is_recorded());
  const auto tools = tools_of(*player);
  ASSERT_EQ(tools.size(), 3000U);
  for (std::uint64_t tick = 0; tick < tools.size(); ++tick)
    ASSERT_EQ(tools[tick], expected_at(tick)) << tick;
  for (const std::uint64_t asked : {1400U, 2500U}) {  // they did happen
    bool restored = false;
    for (std::uint64_t tick = asked; tick < asked + 300; ++tick)
      restored = restored || (player->tick_at(1e-3 * static_cast<double>(tick))->contact.flags &
                              rt::kFlagRestoring) != 0;
    EXPECT_TRUE(restored) << asked;
  }
  expect_same_to_the_bit(*player);

  NoProgress quiet;
  const auto line = record::timeline_of(*player, quiet);
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(line->tools.size(), 11U) << "the first, and ten ticks with a change";
  for (const double t : {0.0, 0.0199, 0.02, 0.0305, 1.0, 1.8, 1.8999, 1.9, 2.9})
    EXPECT_EQ(line->tool_at(t), expected_at(static_cast<std::uint64_t>(1e3 * t + 1e-6))) << t;
  for (const record::TimelineEvent& event : line->events) EXPECT_FALSE(event.refused);
}

TEST(RecordedTool, AsTheSessionBegan) {
  const Folder folder;
  test::record_commanded(folder / "s.mcap", {.motion = "touch",
                                             .burr_mm = 5,
                                             .kind = tool::BurrKind::diamond,
                                             .mode = tick::ToolMode::touch,
                                             .irrigated = true,
                                             .stopped_after = 0.1});
  test::forget_tool(folder / "s.mcap", folder / "old.mcap");
  const ToolState expected{.radius = 2.5e-3,
                           .full_speed = tick::ServoSettings{}.spindle_rad_s,
                           .kind = tool::BurrKind::diamond,
                           .mode = tool::Mode::touch,
                           .irrigated = true};
  for (const char* name : {"s.mcap", "old.mcap"})
    for (const ToolState& tool : tools_of(*opened(folder / name)))
      ASSERT_EQ(tool, expected) << name;
}

TEST(RecordedTool, OfARefusedBurrIsTheOneThatStays) {
  const Folder folder;
  EXPECT_EQ(test::record_commanded(folder / "s.mcap", test::in_its_own_hole()), 2e-3);
  const auto player = opened(folder / "s.mcap");
  for (const ToolState& tool : tools_of(*player)) ASSERT_EQ(tool.radius, 2e-3);
  EXPECT_EQ(player->tick_at(2.9)->tool.radius, 2e-3);
  NoProgress quiet;
  const auto line = record::timeline_of(*player, quiet);
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(line->tools.size(), 1U);
  EXPECT_EQ(line->tool_at(2.9).radius, 2e-3);
  ASSERT_EQ(line->events.size(), 1U);
  EXPECT_TRUE(line->events[0].refused);
  expect_same_to_the_bit(*player);
}

TEST(RecordedTool, OfAnOldRecordingIsAssumedFromSettingsAndCommands) {
  const Folder folder;
  test::record_commanded(folder / "s.mcap", many_changes());
  test::forget_tool(folder / "s.mcap", folder / "old.mcap");
  const auto player = opened(folder / "old.mcap");
  EXPECT_FALSE(player->tool_is_recorded());
  // a look at one moment needs no earlier one
  for (const std::uint64_t tick : {2999U, 0U, 1899U, 1900U, 950U})
    EXPECT_EQ(player->tick_at(1e-3 * static_cast<double>(tick))->tool, expected_at(tick)) << tick;
  record::StepCursor late = player->steps(1850);
  record::Step step;
  ASSERT_TRUE(late.next(step));
  EXPECT_EQ(step.row.tool, expected_at(1850));
  const auto tools = tools_of(*player);
  for (std::uint64_t tick = 0; tick < tools.size(); ++tick)
    ASSERT_EQ(tools[tick], expected_at(tick)) << tick;
  expect_same_to_the_bit(*player);
}

TEST(RecordedTool, OfAnOldRecordingIsAssumedObeyedButNotBeyondTheServosLimits) {
  const Folder folder;
  auto plan = test::in_its_own_hole();
  plan.commands.push_back({2200, {CommandKind::burr_radius, 9e-3}});
  plan.commands.push_back({2201, {CommandKind::burr_radius, 0.4e-3}});
  plan.commands.push_back({2202, {CommandKind::tool_mode, 7}});
  plan.commands.push_back(
      {2203, {CommandKind::mirror_i, std::numeric_limits<double>::quiet_NaN()}});
  plan.commands.push_back({2204, {CommandKind::spindle_speed, 1e9}});
  EXPECT_EQ(test::record_commanded(folder / "s.mcap", plan), 2e-3);
  test::forget_tool(folder / "s.mcap", folder / "old.mcap");
  auto recorded = tools_of(*opened(folder / "s.mcap"));
  const auto assumed = tools_of(*opened(folder / "old.mcap"));
  ASSERT_EQ(assumed.size(), recorded.size());
  // it does not say that there was no room
  for (std::size_t tick = test::kAsked; tick < recorded.size(); ++tick)
    recorded[tick].radius = 3.5e-3;
  EXPECT_EQ(assumed, recorded);
  expect_same_to_the_bit(*opened(folder / "old.mcap"));
}

}  // namespace
}  // namespace burr::sim
