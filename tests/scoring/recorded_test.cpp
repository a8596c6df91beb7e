// Scores of made recordings: good work meets every item, and each fault loses its own item alone.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/haptics/touch_method.h"
#include "burr/phantom/shapes.h"
#include "burr/record/course.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/score.h"
#include "burr/scoring/step_order.h"
#include "metrics/metric_bones.h"
#include "metrics/ticks.h"
#include "record/made_up.h"

namespace burr::scoring {
namespace {

using metrics::test::Happening;
using metrics::test::kMm;

// A nerve of 1 mm radius lies in a block that ends at z = 6 mm; what is above 3.5 mm is cut away.
constexpr const char* kLesson = R"(format = 2
title = "t"
phantom = "block"
approach = [[0, 0, 1]]
[burr]
diameter_mm = 2
[[structure]]
name = "nerve"
names = ["nerve"]
intact = "soft"
[[structure]]
name = "stone"
names = ["hard"]
intact = "solid"
[[region]]
name = "pit"
add = [{ shape = "box", at = [0, 0, 5.5], size_mm = [30, 30, 4] }]
[[step]]
id = "last"
say = "Third."
spare = ["nerve"]
[[step]]
id = "first"
say = "First."
must_precede = ["middle"]
[[step]]
id = "middle"
say = "Second."
must_precede = ["last"]
[reference]
remove = ["pit"]
)";

constexpr const char* kRubric = R"([rubric]
name = "nerve"
version = 1
case = "block"
[[item]]
id = "pit.gone"
part = "product"
measure = "removed"
region = "pit"
say = "Clear the pit."
[[item]]
id = "nerve.whole"
part = "product"
gate = true
measure = "intact_soft"
structure = "nerve"
say = "Stay out of the nerve."
[[item]]
id = "stone.untouched"
part = "product"
measure = "untouched"
structure = "stone"
say = "Do not touch the stone."
[[item]]
id = "burr.choice"
part = "process"
measure = "burr_choice"
say = "Change the burr."
[[item]]
id = "force"
part = "process"
measure = "restraint"
say = "Press less near the nerve."
[[item]]
id = "order"
part = "process"
measure = "order"
say = "Keep the order."
[[item]]
id = "strokes"
part = "process"
measure = "strokes"
say = "Work with long strokes."
[[item]]
id = "coolant"
part = "process"
measure = "coolant"
say = "Cut with coolant."
[[item]]
id = "shaft"
part = "process"
measure = "shaft"
say = "Keep the shaft off the bone."
)";

// How the session differs from good work.
struct Fault {
  double near_height = 2.6 * kMm;  // of the burr's centre over the nerve's axis
  double near_radius = 1 * kMm;
  tool::BurrKind near_kind = tool::BurrKind::diamond;
  double near_force = 0.4;
  std::vector<std::string> order = {"first", "middle", "last"};
  bool declared = true;
  double stroke = 6 * kMm;  // far from the nerve, along y
  bool irrigated = true;
  bool on_stone = false;  // in place of the first 2 s
  bool shaft_touches = true;
  double shaft_rests = 0.9;  // how long it rested on bone [s]
};

// 2 s far from the nerve with 1 N, then 2 s near it.
Happening at(double t, const Fault& fault) {
  Happening now;
  const bool near = t >= 2;
  const double to_and_fro =
      std::abs(std::remainder(2 * t, 1.0)) - 0.25;  // -0.25 to 0.25, twice a second
  now.place = near             ? math::Vec3(6 * kMm, 0, fault.near_height)
              : fault.on_stone ? math::Vec3(-2 * kMm, 6 * kMm, 5 * kMm)
                               : math::Vec3(-6 * kMm, 0, 5 * kMm);
  if (!near) now.place.y() += 2 * fault.stroke * to_and_fro;
  now.tool.irrigated = fault.irrigated;
  now.touching = true;
  now.force = near ? fault.near_force : 1;
  now.removal = 1e-9;
  if (near) now.tool.radius = fault.near_radius;
  if (near) now.tool.kind = fault.near_kind;
  return now;
}

class Recorded : public ::testing::Test {
 protected:
  void SetUp() override {
    metrics::test::Plan plan;
    plan.bone = metrics::test::below(6 * kMm);
    plan.labels = {{phantom::ball(1 * kMm, {6 * kMm, 0, 0}), metrics::test::kNerve},
                   {phantom::ball(1 * kMm, {-2 * kMm, 6 * kMm, 3.5 * kMm}), metrics::test::kHard}};
    bones_ = metrics::test::cut(plan, metrics::test::above(3.5 * kMm), 0.4 * kMm);
  }

  Score score_of(const Fault& fault) {
    const record::test::Folder folder;
    record::SessionInfo info;
    info.volume = record::volume_info(*bones_.before);
    info.rate_hz = metrics::test::kRate;
    info.numbers["touch_method"] = static_cast<double>(
        fault.shaft_touches ? haptics::Method::shaft : haptics::Method::constraint);
    record::Recorder recorder(metrics::test::kRate);
    EXPECT_TRUE(recorder.start(folder / "s.mcap", info, nullptr).ok());
    for (tick::TickRow& row : metrics::test::rows_of(4, [&](double t) { return at(t, fault); })) {
      if (static_cast<double>(row.tick) < fault.shaft_rests * metrics::test::kRate)
        row.contact.flags |= rt::kFlagShaft;
      recorder.wait_for_room();
      EXPECT_TRUE(recorder.ticks().push(row));
    }
    for (const record::CourseEvent& event : course_of(fault)) EXPECT_TRUE(recorder.note(event));
    EXPECT_TRUE(recorder.finish().ok());
    auto player = record::Player::open(folder / "s.mcap");
    EXPECT_TRUE(player) << player.error().text;
    const auto lesson = scenario::parse_lesson(kLesson, "c.toml");
    const auto rubric = parse_rubric(kRubric, "r.toml");
    EXPECT_TRUE(lesson && rubric && check(*rubric, *lesson));
    NoProgress quiet;
    auto made = score(*rubric, *lesson, *bones_.before, *bones_.after, player->get(), quiet);
    EXPECT_TRUE(made) << made.error().text;
    return std::move(*made);
  }

  void expect_lost(const Score& score, std::string_view lost) {
    for (const Outcome& one : score.outcomes)
      EXPECT_EQ(one.verdict, one.id == lost ? Verdict::unmet : Verdict::met)
          << one.id << " " << one.value.value_or(-1) << " " << one.reason;
  }

  metrics::test::Cut bones_;

 private:
  static std::vector<record::CourseEvent> course_of(const Fault& fault) {
    std::vector<record::CourseEvent> events;
    std::uint64_t tick = 1000;
    for (const std::string& step : fault.order)
      events.push_back({.tick = tick += 500, .kind = record::CourseKind::step_done, .what = step});
    if (!fault.declared) return events;
    events.push_back({.tick = 3999, .kind = record::CourseKind::done});
    events.push_back({.tick = 3999,
                      .kind = record::CourseKind::ended,
                      .value = record::word_of(record::Ending::declared_done)});
    return events;
  }
};

TEST_F(Recorded, GoodWorkMeetsEveryItem) {
  const Score good = score_of({});
  expect_lost(good, "");
  EXPECT_FALSE(good.unfinished);
  EXPECT_DOUBLE_EQ(good.process.points.value_or(-1), 100);
}

TEST_F(Recorded, ADeepBurrLosesTheNerveAndTheForceIsAsItWas) {
  const Score deep = score_of({.near_height = 1.2 * kMm});
  expect_lost(deep, "nerve.whole");
  EXPECT_NEAR(deep.outcomes[1].value.value_or(0), 0.8 * kMm, 0.25 * kMm);
  ASSERT_TRUE(deep.outcomes[1].tick);
  EXPECT_GE(*deep.outcomes[1].tick, 2000U);
}

TEST_F(Recorded, ALargeCuttingBurrNearLosesTheChoice) {
  expect_lost(
      score_of(
          {.near_height = 4.6 * kMm, .near_radius = 3 * kMm, .near_kind = tool::BurrKind::cutting}),
      "burr.choice");
}

TEST_F(Recorded, FullForceNearLosesTheForce) {
  expect_lost(score_of({.near_force = 0.9}), "force");
}

TEST_F(Recorded, ShortStrokesLoseTheStrokes) {
  const Score brief = score_of({.stroke = 2.5 * kMm});
  expect_lost(brief, "strokes");
  EXPECT_NEAR(brief.outcomes[6].value.value_or(0), 2.5 * kMm, 0.5 * kMm);
}

TEST_F(Recorded, ADryBurrLosesTheCoolant) {
  expect_lost(score_of({.irrigated = false}), "coolant");
}

TEST_F(Recorded, ATurningBurrOnTheStoneLosesIt) {
  const Score touched = score_of({.on_stone = true});
  expect_lost(touched, "stone.untouched");
  ASSERT_TRUE(touched.outcomes[2].tick);
  EXPECT_LT(*touched.outcomes[2].tick, 2000U);
}

TEST_F(Recorded, AShaftThatRestsOnBoneTooLongLosesIt) {
  const Score leaned = score_of({.shaft_rests = 1.2});
  expect_lost(leaned, "shaft");
  EXPECT_NEAR(leaned.outcomes.back().value.value_or(0), 1.2, 1e-3);
  // where it did not touch, nobody knows
  const Score unfelt = score_of({.shaft_touches = false, .shaft_rests = 0});
  EXPECT_EQ(unfelt.outcomes.back().verdict, Verdict::not_assessable);
  EXPECT_DOUBLE_EQ(unfelt.process.points.value_or(-1), 100);
}

TEST_F(Recorded, AWrongOrderLosesTheOrder) {
  const Score wrong = score_of({.order = {"last", "first", "middle"}});
  expect_lost(wrong, "order");
  EXPECT_EQ(wrong.outcomes[5].value.value_or(0), 2);  // both others had to precede it
}

TEST_F(Recorded, WorkThatIsNotDeclaredDoneIsUnfinished) {
  const Score open = score_of({.declared = false});
  expect_lost(open, "");
  EXPECT_TRUE(open.unfinished);
}

TEST_F(Recorded, TwiceTheSameIsTheSame) {
  const Score a = score_of({}), b = score_of({});
  for (std::size_t n = 0; n < a.outcomes.size(); ++n) {
    EXPECT_EQ(a.outcomes[n].verdict, b.outcomes[n].verdict);
    EXPECT_EQ(a.outcomes[n].value, b.outcomes[n].value);
    EXPECT_EQ(a.outcomes[n].error, b.outcomes[n].error);
    EXPECT_EQ(a.outcomes[n].tick, b.outcomes[n].tick);
    EXPECT_EQ(a.outcomes[n].place, b.outcomes[n].place);
  }
  EXPECT_EQ(a.product.points, b.product.points);
  EXPECT_EQ(a.process.points, b.process.points);
}

// The file lists "last" before the two that must precede it, and only "middle" names it.
TEST(StepOrder, WhatMustPrecedeFollowsTheChainAndNotTheFile) {
  const auto lesson = scenario::parse_lesson(kLesson, "c.toml");
  ASSERT_TRUE(lesson);
  const auto order = [&](const std::vector<std::string>& steps) {
    std::vector<metrics::StepMark> marks;
    for (const std::string& step : steps)
      marks.push_back({static_cast<double>(marks.size()), step, metrics::StepEvent::done});
    return step_order(*lesson, marks);
  };
  EXPECT_EQ(order({"first", "middle", "last"}).wrong, 0U);
  EXPECT_EQ(order({"first", "last"}).wrong, 0U);
  EXPECT_EQ(order({"last", "first"}).wrong, 1U);
  EXPECT_EQ(order({"last", "middle", "first"}).wrong, 3U);
  EXPECT_EQ(order({"first", "middle", "last", "first"}).wrong, 0U);  // the first time counts
  EXPECT_EQ(order({"first", "other"}).done, 1U);
}

}  // namespace
}  // namespace burr::scoring
