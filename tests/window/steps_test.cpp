// The steps of a case, and the sentence about technique: no window is needed.
#include "burr/guidance/steps.h"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "burr/guidance/injury.h"
#include "burr/guidance/step_watch.h"
#include "burr/guidance/technique.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/open_lesson.h"
#include "window/mill/step_light.h"

namespace burr::app {
namespace {

using record::CourseKind;

guidance::Steps steps_named(const std::vector<std::string>& ids) {
  std::vector<scenario::Step> all;
  for (const std::string& id : ids) all.emplace_back().id = id;
  return guidance::Steps(std::move(all));
}

std::string words_of(const guidance::Steps::Events& events) {
  std::string text;
  for (const guidance::Steps::Event& one : events)
    text += (text.empty() ? "" : ", ") + std::string(record::word_of(one.kind)) + " " + one.what;
  return text;
}

TEST(Steps, OneAfterAnother) {
  guidance::Steps steps = steps_named({"a", "b"});
  EXPECT_EQ(words_of(steps.begin()), "step_begun a");
  EXPECT_EQ(words_of(steps.declare_done()), "step_done a, step_begun b");
  EXPECT_EQ(steps.now()->id, "b");
  EXPECT_EQ(words_of(steps.declare_done()), "step_done b");
  EXPECT_EQ(steps.now(), nullptr) << "all are done";
  EXPECT_EQ(steps.done_count(), 2U);
  EXPECT_EQ(words_of(steps.declare_done()), "");
}

TEST(Steps, AreReopenedAndChosen) {
  guidance::Steps steps = steps_named({"a", "b", "c"});
  EXPECT_EQ(words_of(steps.begin()), "step_begun a");
  EXPECT_EQ(words_of(steps.choose(2)), "step_begun c");
  EXPECT_EQ(words_of(steps.choose(0)), "") << "it had begun";
  EXPECT_EQ(words_of(steps.declare_done()), "step_done a, step_begun b");
  EXPECT_EQ(words_of(steps.choose(0)), "step_reopened a");
  EXPECT_FALSE(steps.is_done(0));
  EXPECT_EQ(words_of(steps.declare_done()), "step_done a") << "b has begun already";
  EXPECT_EQ(steps.now()->id, "b");
  EXPECT_EQ(words_of(steps.declare_done()), "step_done b");
  EXPECT_EQ(steps.now()->id, "c");
  EXPECT_EQ(words_of(steps.declare_done()), "step_done c");
  EXPECT_EQ(words_of(steps.choose(1)), "step_reopened b") << "also after all are done";
  EXPECT_EQ(words_of(steps.choose(7)), "");
}

TEST(Steps, AStepWhoseIdMayNotBeRecordedHasItsNumber) {
  guidance::Steps steps = steps_named({"a", "/home/anna", std::string(200, 'x')});
  EXPECT_EQ(steps.id(0), "a");
  EXPECT_EQ(steps.id(1), "step 2");
  EXPECT_EQ(steps.id(2), "step 3");
}

TEST(Steps, ACaseMayHaveNone) {
  guidance::Steps steps;
  EXPECT_TRUE(steps.begin().empty());
  EXPECT_TRUE(steps.declare_done().empty());
  EXPECT_EQ(steps.now(), nullptr);
}

// ---- what is lit, and what is measured

constexpr const char* kLesson = R"(format = 2
title = "t"
phantom = "block"
approach = [[0, 0, 1]]
[[landmark]]
name = "entry"
at_mm = [1, 2, 3]
[[landmark]]
name = "vein"
points_mm = [[0, 0, 0], [0, 0, 10], [0, 0, 20], [0, 0, 30]]
[[structure]]
name = "nerve"
[[region]]
name = "pit"
add = [
  { shape = "ball", at = [0, 0, 8], radius_mm = 4 },
  { shape = "tube", along = "vein", radius_mm = 2, from = 0.3, to = 0.7 },
  { shape = "within", structure = "nerve", radius_mm = 1 },
]
[[region]]
name = "top"
add = [{ shape = "ball", at = [0, 0, 7], radius_mm = 2.5 }]
[[step]]
id = "first"
say = "Clear the pit."
region = "pit"
show = ["entry", "pit", "nerve"]
done = { measure = "removed", region = "top", share = 0.8 }
[[step]]
id = "second"
say = "Look."
region = "pit"
)";

scenario::CaseLesson lesson() {
  auto read = scenario::parse_lesson(kLesson, "my.toml");
  EXPECT_TRUE(read) << read.error().text;
  auto placed = scenario::place(std::move(*read), {}, "my.toml");
  EXPECT_TRUE(placed) << placed.error().text;
  return *placed;
}

TEST(Steps, TargetsAndPlacesHaveMarksOfTheirOwn) {
  using guidance::MarkKind;
  const scenario::CaseLesson all = lesson();
  const std::vector<guidance::StepMark> pit = {{MarkKind::target, {0, 0, 8e-3}, 4e-3, "pit"},
                                               {MarkKind::target, {0, 0, 10e-3}, 2e-3, ""},
                                               {MarkKind::target, {0, 0, 20e-3}, 2e-3, ""}};
  const auto shown = guidance::marks_of(all.steps[0], all, {}, nullptr).marks;
  ASSERT_EQ(shown.size(), 1 + pit.size());
  EXPECT_EQ(shown.back().name, "entry");
  EXPECT_EQ(shown.back().kind, MarkKind::place);
  EXPECT_LT((shown.back().at - math::Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-12);
  const auto own = guidance::marks_of(all.steps[1], all, {}, nullptr).marks;
  ASSERT_EQ(own.size(), pit.size()) << "a step that shows nothing has its region";
  for (std::size_t n = 0; n < pit.size(); ++n) {
    EXPECT_LT((own[n].at - pit[n].at).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(own[n].radius, pit[n].radius);
    EXPECT_EQ(own[n].name, pit[n].name);
    EXPECT_EQ(own[n].kind, pit[n].kind);
    EXPECT_EQ(own[n].name, shown[n].name);
  }
}

// The first step shows the nerve; the second spares it. It has another colour then, and is no target.
TEST(Steps, WhatIsToBeSparedIsNeverShownAsATarget) {
  scenario::CaseLesson all = lesson();
  volume::TissueTable table;
  table.tissues = {{.name = "air"}, {.name = "bone"}, {.name = "nerve"}};
  all.steps[1] = all.steps[0];
  all.steps[1].spare = {"nerve"};
  const auto worked = guidance::marks_of(all.steps[0], all, table, nullptr);
  EXPECT_EQ(worked.target, std::vector<volume::TissueId>{2});
  EXPECT_TRUE(worked.spare.empty());
  const auto spared = guidance::marks_of(all.steps[1], all, table, nullptr);
  EXPECT_TRUE(spared.target.empty());
  EXPECT_EQ(spared.spare, std::vector<volume::TissueId>{2});
  // also where the case, not the step, says that it must stay intact
  all.structures[0].intact = scenario::Intact::soft;
  EXPECT_TRUE(guidance::marks_of(all.steps[0], all, table, nullptr).target.empty());
}

TEST(Steps, TheLitTissueHasItsOwnColourAgainAfterwards) {
  const scenario::CaseLesson all = lesson();
  volume::TissueTable table;
  table.tissues = {{.name = "air"}, {.name = "bone"}, {.name = "nerve"}};
  render::Scene scene;
  scene.tissue_colours = {{0, 0, 0}, {1, 1, 1}, {1, 1, 0}};
  const auto before = scene.tissue_colours;
  StepLight light;
  light.on(guidance::marks_of(all.steps[0], all, table, nullptr), scene);
  EXPECT_TRUE(light.is_on());
  EXPECT_EQ(scene.tissue_colours[1], before[1]);
  EXPECT_NE(scene.tissue_colours[2], before[2]);
  light.off(scene);
  EXPECT_EQ(scene.tissue_colours, before);
}

// A ball of bone; all above z = 2 mm is taken away brick by brick, as a servo would.
TEST(Steps, TheWatchFindsThatAMeasureIsReached) {
  auto bone =
      phantom::bone_from_distance(phantom::cube_grid(24e-3, 48), {}, phantom::ball(10e-3), 8);
  const scenario::CaseLesson all = lesson();
  guidance::StepWatch watch(*bone, all);
  watch.look(0);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_FALSE(watch.take()) << "nothing is cut yet";
  for (volume::BrickIndex brick = 0; brick < bone->brick_count(); ++brick)
    if (bone->brick_field(brick) != nullptr &&
        bone->grid().world_from_grid(bone->brick_ijk(brick).cast<double>()).z() > 2e-3)
      bone->write_brick(brick, {});
  std::optional<std::size_t> done;
  for (int n = 0; n < 1200 && !done; ++n) {  // gives up after two minutes
    watch.look(0);
    done = watch.take();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(done, 0U);
}

// ---- a turning burr in what must not be cut

TEST(Steps, AnInjuryHasOneMessageUntilTheBurrIsOutAgain) {
  constexpr double kVoxel = 0.4e-3;
  guidance::InjuryWatch watch;
  EXPECT_FALSE(watch.look("dura", 1e-3, true, kVoxel));
  EXPECT_FALSE(watch.look("dura", -0.1e-3, true, kVoxel)) << "within the error of the distance";
  EXPECT_FALSE(watch.look("dura", -1e-3, false, kVoxel)) << "the burr stands still";
  EXPECT_TRUE(watch.look("dura", -0.3e-3, true, kVoxel));
  EXPECT_TRUE(watch.is_in());
  EXPECT_FALSE(watch.look("dura", -0.5e-3, true, kVoxel))
      << "no second message for the same injury";
  EXPECT_FALSE(watch.look("dura", -0.1e-3, true, kVoxel));
  EXPECT_FALSE(watch.look("dura", -0.5e-3, true, kVoxel)) << "it was not out yet";
  EXPECT_TRUE(watch.look("sigmoid sinus", -0.5e-3, true, kVoxel)) << "another one";
  EXPECT_FALSE(watch.look("dura", 0.1e-3, true, kVoxel));
  EXPECT_TRUE(watch.look("dura", -0.5e-3, true, kVoxel));
  watch.nothing_near();
  EXPECT_FALSE(watch.is_in());
  EXPECT_TRUE(watch.look("dura", -0.5e-3, true, kVoxel));
}

// ---- the sentence about technique

using Cue = guidance::Technique::Cue;

// Cuts from one time to another, every 20 ms; returns the times at which a sentence appeared [s].
std::vector<double> said(guidance::Technique& technique, guidance::Technique::Moment moment,
                         double from, double to, const scenario::Step* step = nullptr) {
  std::vector<double> times;
  for (int n = 0; from + 0.02 * n < to; ++n) {
    moment.t = from + 0.02 * n;
    static_cast<void>(technique.look(moment, step));
    if (technique.fresh()) times.push_back(moment.t);
  }
  return times;
}

guidance::Technique::Moment pressing_hard() {
  guidance::Technique::Moment moment;
  moment.cutting = true;
  moment.force = 2 * guidance::Technique::kForce;
  moment.diameter = 5e-3;
  return moment;
}

TEST(Technique, SpeaksAfterTwoSecondsOutOfBandAndOnceInTwentySeconds) {
  guidance::Technique technique;
  const std::vector<double> times = said(technique, pressing_hard(), 0, 70);
  ASSERT_EQ(times.size(), 4U);
  EXPECT_NEAR(times[0], 2, 0.03);
  for (std::size_t n = 1; n < times.size(); ++n)
    EXPECT_GE(times[n] - times[n - 1], guidance::Technique::kBetween - 1e-9);
}

TEST(Technique, SaysNothingAboutAShortLapse) {
  guidance::Technique technique;
  for (int n = 0; n < 30; ++n) {
    EXPECT_TRUE(said(technique, pressing_hard(), 3 * n, 3 * n + 1.9).empty());
    guidance::Technique::Moment gentle = pressing_hard();
    gentle.force = 1;
    EXPECT_TRUE(said(technique, gentle, 3 * n + 1.9, 3 * n + 3).empty());
  }
}

TEST(Technique, SaysNothingWithinAMillimetreAndTakesItsSentenceAway) {
  guidance::Technique technique;
  guidance::Technique::Moment near = pressing_hard();
  near.nearest = 0.99e-3;
  EXPECT_TRUE(said(technique, near, 0, 100).empty());
  EXPECT_EQ(said(technique, pressing_hard(), 100, 103).size(), 1U);
  guidance::Technique::Moment moment = pressing_hard();
  moment.t = 103.02;
  EXPECT_EQ(technique.look(moment, nullptr), Cue::gentler);
  moment.nearest = 0.5e-3;
  EXPECT_EQ(technique.look(moment, nullptr), Cue::none);
  EXPECT_FALSE(technique.fresh());
}

TEST(Technique, SaysNothingWhileNothingIsCut) {
  guidance::Technique technique;
  guidance::Technique::Moment moment = pressing_hard();
  moment.cutting = false;
  EXPECT_TRUE(said(technique, moment, 0, 60).empty());
}

TEST(Technique, TheToolOfTheStepIsABand) {
  scenario::Step step;
  step.kind = tool::BurrKind::diamond;
  step.diameter = {2e-3, 4e-3};
  const auto cue = [&step](tool::BurrKind kind, double diameter, const char* tool = "") {
    guidance::Technique technique;
    guidance::Technique::Moment moment;
    moment.tool = tool;
    moment.cutting = true;
    moment.force = 1;
    moment.kind = kind;
    moment.diameter = diameter;
    Cue last = Cue::none;
    for (int n = 0; n < 150; ++n) {
      moment.t = 0.02 * n;
      last = technique.look(moment, &step);
    }
    return last;
  };
  EXPECT_EQ(cue(tool::BurrKind::diamond, 3e-3), Cue::none);
  EXPECT_EQ(cue(tool::BurrKind::diamond, 4e-3), Cue::none) << "its end belongs to it";
  EXPECT_EQ(cue(tool::BurrKind::cutting, 3e-3), Cue::kind);
  EXPECT_EQ(cue(tool::BurrKind::diamond, 1e-3), Cue::larger);
  EXPECT_EQ(cue(tool::BurrKind::diamond, 6e-3), Cue::smaller);
  EXPECT_EQ(cue(tool::BurrKind::diamond, 3e-3, "flame"), Cue::kind) << "the round burr suits";
  step.kind.reset();
  step.diameter.reset();
  step.tool = "flame";
  EXPECT_EQ(cue(tool::BurrKind::cutting, 6e-3, "flame"), Cue::none) << "the burr's size is idle";
  EXPECT_EQ(cue(tool::BurrKind::cutting, 6e-3), Cue::kind);
}

}  // namespace
}  // namespace burr::app
