// A step of a case is done when its measure says so.
#include "burr/scoring/step_done.h"

#include <gtest/gtest.h>

#include <string>

#include "burr/scenario/open_lesson.h"
#include "metrics/metric_bones.h"

namespace burr::scoring {
namespace {

using metrics::test::kMm;

std::string lesson_with(const std::string& done) {
  return R"(format = 2
title = "t"
phantom = "block"
approach = [[0, 0, 1]]
[burr]
diameter_mm = 4
rpm = 40000
[[region]]
name = "pit"
add = [{ shape = "box", at = [0, 0, 5], size_mm = [30, 30, 2] }]
[[step]]
id = "first"
say = "Clear the pit."
region = "pit"
)" + done +
         "\n";
}

TEST(StepDone, IsReachedWhenTheShareIsGone) {
  const auto lesson = scenario::parse_lesson(
      lesson_with("done = { measure = \"removed\", share = 0.6 }"), "c.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  ASSERT_TRUE(check_done(*lesson, "c.toml"));
  metrics::test::Plan plan;
  plan.bone = metrics::test::below(6 * kMm);
  NoProgress quiet;
  for (const auto& [z, reached] :
       {std::pair{20.0, false}, {5.2, false}, {4.6, true}, {2.0, true}}) {
    const auto bones = metrics::test::cut(plan, metrics::test::above(z * kMm), 0.4 * kMm);
    const auto done = step_done(lesson->steps[0], *lesson, *bones.before, *bones.after, quiet);
    ASSERT_TRUE(done) << done.error().text;
    EXPECT_EQ(*done, reached) << "all above " << z << " mm is gone";
  }
}

TEST(StepDone, AStepWithoutAMeasureIsNeverDoneByItself) {
  const auto lesson = scenario::parse_lesson(lesson_with(""), "c.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  EXPECT_TRUE(check_done(*lesson, "c.toml"));
  metrics::test::Plan plan;
  plan.bone = metrics::test::below(6 * kMm);
  const auto bones = metrics::test::cut(plan, metrics::test::above(0), 0.4 * kMm);
  NoProgress quiet;
  const auto done = step_done(lesson->steps[0], *lesson, *bones.before, *bones.after, quiet);
  EXPECT_TRUE(done && !*done);
}

TEST(StepDone, AMistakeIsASentenceWithItsLine) {
  struct Mistake {
    std::string done, says;
  };
  const Mistake mistakes[] = {
      {"measure = \"gone\"",
       "c.toml: line 15: step.done.measure: \"gone\" is not a measure of the bone; use one of "
       "identified, skeletonised, "},
      {"measure = \"order\"", "\"order\" is not a measure of the bone"},
      {"measure = \"plane_offset\"", "\"plane_offset\" is not a measure of the bone"},
      {"measure = \"axis_entry\"", "along: is missing; axis_entry needs a curve"},
      {"measure = \"intact_soft\"", "\"intact_soft\" is not a measure of the bone"},
      {"measure = \"opened\"", "step.done.structure: is missing; opened needs one"},
      {"measure = \"removed\", share_mm = 1", "share_mm: is not a limit of removed; use share"},
      {"measure = \"removed\", share = 2", "share: must be a number above 0 and at most 1"},
      {"measure = \"removed\", along = \"x\"", "along: removed takes no curve; leave it out"},
  };
  for (const Mistake& mistake : mistakes) {
    const auto lesson =
        scenario::parse_lesson(lesson_with("done = { " + mistake.done + " }"), "c.toml");
    ASSERT_TRUE(lesson) << lesson.error().text;
    const Status said = check_done(*lesson, "c.toml");
    ASSERT_FALSE(said) << mistake.done;
    EXPECT_NE(said.error().text.find(mistake.says), std::string::npos) << said.error().text;
  }
}

}  // namespace
}  // namespace burr::scoring
