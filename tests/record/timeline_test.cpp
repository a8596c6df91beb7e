// The timeline of sessions whose strokes, peaks and commands are known.
#include "burr/record/timeline.h"

#include <gtest/gtest.h>

#include <limits>

#include "record/made_up.h"

namespace burr::record {
namespace {

using namespace test;

Step step_at(std::uint64_t tick, double removed, double force) {
  Step step;
  step.row.tick = tick;
  step.row.ledger.removed = removed;
  step.row.contact.force = {0, 0, force};
  step.row.tool.radius = 3e-3;
  step.row.contact.proxy = {1e-3 * static_cast<double>(tick), 0, 0};
  return step;
}

// 10 s at 1 kHz: cut from 1 to 2 s and from 2.2 to 3 s, then from 6 to 7 s.
Timeline three_cuts() {
  TimelineMaker maker(1000, 10'000);
  double removed = 0;
  for (std::uint64_t tick = 0; tick < 10'000; ++tick) {
    const bool cuts = (tick >= 1000 && tick < 2000) || (tick >= 2200 && tick < 3000) ||
                      (tick >= 6000 && tick < 7000);
    if (cuts) removed += 1e-12;
    maker.add(step_at(tick, removed, tick == 4321 ? 7 : cuts ? 2 : 0));
  }
  return maker.finish();
}

TEST(Timeline, JoinsCutsOfOneStrokeAndPartsThoseOfTwo) {
  const Timeline line = three_cuts();
  ASSERT_EQ(line.strokes.size(), 2U);
  EXPECT_DOUBLE_EQ(line.strokes[0].begin_s, 1);
  EXPECT_DOUBLE_EQ(line.strokes[0].end_s, 2.999);
  EXPECT_DOUBLE_EQ(line.strokes[1].begin_s, 6);
  EXPECT_DOUBLE_EQ(line.strokes[1].end_s, 6.999);
  EXPECT_DOUBLE_EQ(line.seconds, 10);
  ASSERT_TRUE(line.work.has_value());
  EXPECT_DOUBLE_EQ(line.work->at.x(), 1) << "where it first cut";
}

TEST(Timeline, ShowsThePeakOfOneTickHoweverCoarselyItIsLookedAt) {
  const Timeline line = three_cuts();
  EXPECT_FLOAT_EQ(static_cast<float>(line.peak_force), 7);
  EXPECT_DOUBLE_EQ(line.force_in(0, 10), 7);
  EXPECT_DOUBLE_EQ(line.force_in(4, 5), 7);
  EXPECT_DOUBLE_EQ(line.force_in(4.3209, 4.3211), 7);
  EXPECT_DOUBLE_EQ(line.force_in(4.4, 5), 0);
  EXPECT_DOUBLE_EQ(line.force_in(1.5, 1.5), 2);
  EXPECT_DOUBLE_EQ(line.force_in(-5, 100), 7);
}

TEST(Timeline, GoesFromStrokeToStroke) {
  const Timeline line = three_cuts();
  EXPECT_EQ(line.stroke_after(0), 1);
  EXPECT_EQ(line.stroke_after(1), 6);
  EXPECT_FALSE(line.stroke_after(6).has_value());
  EXPECT_EQ(line.stroke_before(10), 6);
  EXPECT_EQ(line.stroke_before(6), 1);
  EXPECT_FALSE(line.stroke_before(1).has_value());
}

TEST(Timeline, KeepsTheCommandsOfPeopleButNotWhatTheServoPutOff) {
  TimelineMaker maker(500, 1000);
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    Step step = step_at(tick, 0, 0);
    if (tick == 100)
      step.commands = {{tick::CommandKind::shed, 2}, {tick::CommandKind::burr_radius, 2e-3}};
    if (tick >= 100) step.row.tool.radius = 2e-3;
    if (tick == 400)
      step.commands = {{tick::CommandKind::undo, 0}, {tick::CommandKind::burr_radius, 1e-3}};
    if (tick == 600)
      step.commands = {{tick::CommandKind::burr_radius, 1e-3},
                       {tick::CommandKind::burr_radius, 2e-3}};
    maker.add(step);
  }
  const Timeline line = maker.finish();
  ASSERT_EQ(line.events.size(), 5U);
  EXPECT_DOUBLE_EQ(line.events[0].t_s, 0.2);
  EXPECT_EQ(line.events[1].command.kind, tick::CommandKind::undo);
  EXPECT_FALSE(line.events[0].refused);
  EXPECT_FALSE(line.events[1].refused);
  EXPECT_TRUE(line.events[2].refused) << "the burr stayed";
  EXPECT_FALSE(line.events[3].refused) << "nobody knows: another one came in the same tick";
  EXPECT_FALSE(line.events[4].refused);
  ASSERT_EQ(line.tools.size(), 2U);
  EXPECT_EQ(line.tool_at(-1).radius, 3e-3);
  EXPECT_EQ(line.tool_at(0.199).radius, 3e-3);
  EXPECT_EQ(line.tool_at(0.2).radius, 2e-3);
  EXPECT_EQ(line.tool_at(1.9).radius, 2e-3);
  EXPECT_EQ(Timeline().tool_at(1).radius, 0) << "not known";
  EXPECT_FALSE(line.work.has_value()) << "nothing was cut";
}

TEST(Timeline, BearsDamagedNumbers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max() - 1;
  TimelineMaker maker(1000, kLargest);
  Step step = step_at(0, kNan, kNan);
  maker.add(step);
  step = step_at(kLargest, 1e300, std::numeric_limits<double>::infinity());
  step.row.contact.proxy.setConstant(kNan);
  maker.add(step);
  const Timeline line = maker.finish();
  EXPECT_EQ(line.peak_force, 0);
  EXPECT_FALSE(line.work.has_value());
  EXPECT_EQ(line.force_in(kNan, kNan), 0);
  EXPECT_EQ(Timeline().force_in(0, 1), 0);
}

TEST(Timeline, OfARecordingIsThatOfItsRows) {
  BURR_SEEDED(random, 7);
  const Folder folder;
  const auto bone = any_bone(random, 64);
  const Truth truth = record_any(folder / "s.mcap", 3000, 500, *bone, random);
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok()) << player.error().text;
  NoProgress quiet;
  const auto line = timeline_of(**player, quiet);
  ASSERT_TRUE(line.ok()) << line.error().text;
  EXPECT_DOUBLE_EQ(line->seconds, 6);
  double peak = 0;
  for (const tick::TickRow& row : truth.ticks)
    if (std::isfinite(row.contact.force.norm())) peak = std::max(peak, row.contact.force.norm());
  EXPECT_DOUBLE_EQ(line->peak_force, peak);
  std::size_t commands = 0;
  for (const tick::CommandRow& row : truth.commands)
    commands += row.command.kind != tick::CommandKind::shed ? 1 : 0;
  EXPECT_EQ(line->events.size(), commands);
}

}  // namespace
}  // namespace burr::record
