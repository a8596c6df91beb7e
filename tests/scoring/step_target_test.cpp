// Every step of every built-in case: what "Show target" shows, and which tool, burr and press are proposed, against the
// case's own data. What must be spared is counted voxel by voxel, without the distances that the program uses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "burr/guidance/step_marks.h"
#include "burr/guidance/step_plan.h"
#include "burr/guidance/suits.h"
#include "burr/metrics/region.h"
#include "burr/scenario/case.h"
#include "burr/scoring/step_target.h"
#include "burr/scoring/workpiece.h"
#include "burr/volume/sample.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"

namespace burr::guidance {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kUsual = 4e-3;  // preset of the setting for the press [m]
constexpr double kSizes[] = {0.6e-3, 0.8e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 3.5e-3,
                             4e-3,   4.5e-3, 5e-3, 5.5e-3, 6e-3, 6.5e-3, 7e-3};

struct Opened {
  scenario::Case work;
  scenario::CaseLesson lesson;
  std::unique_ptr<volume::Bone> bone;
};

Opened opened(const std::string& name) {
  NoProgress quiet;
  Opened out;
  auto work = scenario::read_case(name);
  EXPECT_TRUE(work) << work.error().text;
  out.work = std::move(*work);
  auto lesson = workshop::placed_lesson(out.work);
  EXPECT_TRUE(lesson) << lesson.error().text;
  out.lesson = std::move(*lesson);
  auto made = workshop::open_bone(workshop::recipe_of(out.work, {}), quiet);
  EXPECT_TRUE(made) << made.error().text;
  out.bone = std::move(made->bone);
  return out;
}

// The names of tissues that must not be cut in this step: as the case lists them, and as the step does.
std::set<std::string> spared_tissues(const Opened& all, const scenario::Step& step) {
  std::set<std::string> names(all.work.spare.begin(), all.work.spare.end());
  for (const std::string& one : step.spare)
    if (const scenario::Structure* structure = all.lesson.structure(one))
      names.insert(structure->names.begin(), structure->names.end());
  return names;
}

BurrChoice burr_of(const Opened& all, const scenario::Step& step) {
  const double least = std::max(tool::kSmallestDiameter, 4 * all.bone->grid().voxel);
  std::vector<double> sizes;
  for (const double size : kSizes)
    if (size >= least - 1e-9) sizes.push_back(size);
  return burr_for(step, {all.work.burr.kind, 2 * all.work.burr.radius}, sizes);
}

// The least distance from a ball's surface to the centre of a voxel that must stay; below 0: it reaches one.
double nearest_spared(const Opened& all, const std::set<std::string>& names, const Vec3& centre,
                      double radius) {
  const volume::Bone& bone = *all.bone;
  const double h = bone.grid().voxel, reach = radius + 2 * h;
  const Ijk middle = bone.grid().grid_from_world(centre).array().round().cast<int>();
  const int far = static_cast<int>(std::ceil(reach / h));
  double least = reach;
  for (int k = -far; k <= far; ++k)
    for (int j = -far; j <= far; ++j)
      for (int i = -far; i <= far; ++i) {
        const Ijk v = middle + Ijk(i, j, k);
        if (!bone.grid().contains(v)) continue;
        const volume::Tissue& tissue = bone.tissues()[bone.tissue(v.x(), v.y(), v.z())];
        if (!names.contains(tissue.name)) continue;
        if (tissue.kind == volume::TissueKind::solid &&
            bone.field(v.x(), v.y(), v.z()) < volume::kIso)
          continue;  // a label beyond the surface
        least = std::min(least, (bone.grid().world_from_grid(v.cast<double>()) - centre).norm());
      }
  return least - radius;
}

class StepTargets : public testing::TestWithParam<std::string> {};

void expect_marks(const Opened& all, const scenario::Step& step,
                  const scoring::StepTarget& target) {
  const StepMarks marks = marks_of(step, all.lesson, all.bone->tissues(), &target);
  EXPECT_TRUE(marks.has(MarkKind::target) || marks.has(MarkKind::plane)) << "nothing to work on";
  const std::set<std::string> spared = spared_tissues(all, step);
  for (const volume::TissueId id : marks.target)
    EXPECT_FALSE(spared.contains(all.bone->tissues()[id].name))
        << all.bone->tissues()[id].name << " is shown as a target";
  for (const StepMark& mark : marks.marks) {
    const bool kept =
        std::find(step.spare.begin(), step.spare.end(), mark.name) != step.spare.end();
    if (!mark.name.empty() && mark.kind != MarkKind::spare) {
      EXPECT_FALSE(kept) << mark.name << " is shown as a " << word_of(mark.kind);
    }
    if (mark.kind == MarkKind::target || mark.kind == MarkKind::plane) {
      EXPECT_TRUE(mark.name.empty() || mark.name == step.region) << mark.name;
    }
  }
  for (const std::string& name : step.spare)
    EXPECT_TRUE(std::any_of(
        marks.marks.begin(), marks.marks.end(),
        [&](const auto& mark) { return mark.kind == MarkKind::spare && mark.name == name; }))
        << name << " is to be spared and has no mark";
  // the four kinds look different
  std::set<std::string> looks;
  for (const MarkKind kind :
       {MarkKind::target, MarkKind::plane, MarkKind::spare, MarkKind::place}) {
    const MarkColour colour = colour_of(kind);
    looks.insert(std::to_string(colour.red) + " " + std::to_string(colour.green) + " " +
                 std::to_string(colour.blue));
  }
  EXPECT_EQ(looks.size(), 4U);
}

void expect_press(const Opened& all, const scenario::Step& step, const scoring::StepTarget& target,
                  double radius) {
  const double press = press_for(target, kUsual);
  EXPECT_GE(press, kLeastPress);
  EXPECT_LE(press, kUsual);
  const std::set<std::string> spared = spared_tissues(all, step);
  double least = 1;
  const std::size_t each = std::max<std::size_t>(1, target.surface.size() / 60);
  for (std::size_t n = 0; n < target.surface.size(); n += each) {
    const Vec3 centre = target.surface[n] + (radius - press) * target.towards;
    least = std::min(least, nearest_spared(all, spared, centre, radius));
  }
  std::printf(
      "  %-16s burr %.1f mm, press %.2f mm; target %.2f mm deep, structure %.2f mm thick, room "
      "%.2f mm; view from (%.2f %.2f %.2f), %.1f mm wide\n",
      step.id.c_str(), 2e3 * radius, 1e3 * press, 1e3 * target.deepest, 1e3 * target.thickness,
      1e3 * target.room, target.towards.x(), target.towards.y(), target.towards.z(),
      2e3 * target.radius);
  EXPECT_GT(least, 0) << "the first press reaches what must be spared";
  // where no press helps: the least one, and there are places enough beside
  std::printf("  %-16s %zu of %zu spots are too near what must be spared\n", "",
              target.too_near.size(), target.too_near.size() + target.surface.size());
  EXPECT_GT(4 * target.surface.size(), target.surface.size() + target.too_near.size());
  if (!target.too_near.empty()) {
    EXPECT_DOUBLE_EQ(press, kLeastPress);
  }
}

TEST_P(StepTargets, AreThoseOfTheCasesOwnData) {
  const Opened all = opened(GetParam());
  NoProgress quiet;
  scoring::TargetFinder finder(*all.bone, all.lesson, quiet);
  std::printf("%s\n", GetParam().c_str());
  ASSERT_FALSE(all.lesson.steps.empty());
  for (const scenario::Step& step : all.lesson.steps) {
    SCOPED_TRACE(step.id);
    const BurrChoice burr = burr_of(all, step);
    if (step.kind) {
      EXPECT_EQ(burr.kind, *step.kind);
    }
    if (step.diameter) {
      EXPECT_GE(burr.diameter, step.diameter->first - 1e-9);
      EXPECT_LE(burr.diameter, step.diameter->second + 1e-9);
    }
    const auto target = finder.find(step, *all.bone, 0.5 * burr.diameter);
    ASSERT_TRUE(target) << target.error().text;
    ASSERT_TRUE(target->found) << "there is no bone in its region";
    EXPECT_LT(std::abs(volume::depth_at(*all.bone, target->at)), all.bone->grid().voxel)
        << "the view looks at the surface";
    const auto& approach = step.approach.empty() ? all.lesson.approach : step.approach;
    EXPECT_GT(target->towards.dot(approach.front().normalized()), 0.999);
    expect_marks(all, step, *target);
    expect_press(all, step, *target, 0.5 * burr.diameter);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, StepTargets, testing::ValuesIn(scenario::built_in_cases()),
                         [](const auto& named) {
                           std::string name = named.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// The jaw's first step: the plane to be cut, and not the nerve.
TEST(StepTarget, OfTheOsteotomyIsItsPlanesOnTheBone) {
  const Opened all = opened("jaw");
  NoProgress quiet;
  scoring::TargetFinder finder(*all.bone, all.lesson, quiet);
  const scenario::Step& step = *all.lesson.step("divide");
  const auto target = finder.find(step, *all.bone, 1e-3);
  ASSERT_TRUE(target && target->found);
  ASSERT_GT(target->outline.size(), 100U);
  const double h = all.bone->grid().voxel;
  double longest = 0;
  for (const char* name : {"back face of the osteotomy", "front face of the osteotomy"}) {
    const scenario::Landmark* plane = all.lesson.landmark(name);
    ASSERT_NE(plane, nullptr);
    double length = 0;
    for (const auto& line : target->outline)
      if (std::abs((line[0] - plane->points[0]).dot(*plane->normal)) < 1e-6) {
        length += (line[1] - line[0]).norm();
        EXPECT_LT(std::abs(volume::depth_at(*all.bone, line[0])), 0.2 * h);
      }
    EXPECT_GT(length, 30e-3) << name << ": around a jaw of some 12 by 20 mm";
    EXPECT_LT(length, 200e-3) << name;
    longest = std::max(longest, length);
  }
  const auto marks = marks_of(step, all.lesson, all.bone->tissues(), &*target);
  EXPECT_TRUE(marks.has(MarkKind::plane));
  EXPECT_FALSE(marks.has(MarkKind::target)) << "a cut is no place to hollow out";
  EXPECT_TRUE(marks.target.empty());
  EXPECT_FALSE(marks.spare.empty()) << "the nerve, in the colour of what is spared";
}

// A slab over a soft layer: what is proposed is known by its formula.
TEST(StepTarget, PressesNoFartherThanTheEnamelIsThick) {
  const Opened all = opened("tooth");
  NoProgress quiet;
  scoring::TargetFinder finder(*all.bone, all.lesson, quiet);
  const scenario::Step& step = *all.lesson.step("open");
  const auto target = finder.find(step, *all.bone, 0.6e-3);
  ASSERT_TRUE(target && target->found);
  const double press = press_for(*target, kUsual);
  // by hand, along the approach from the place that is looked at
  const volume::Bone& bone = *all.bone;
  double enamel = 0;
  for (double t = 0.05e-3; t < 6e-3; t += 0.05e-3) {
    const Ijk v =
        bone.grid().grid_from_world(target->at - t * target->towards).array().round().cast<int>();
    if (bone.tissues()[bone.tissue(v.x(), v.y(), v.z())].name != "enamel") break;
    enamel = t;
  }
  std::printf("enamel %.2f mm where the view looks, press %.2f mm\n", 1e3 * enamel, 1e3 * press);
  // counted column by column outside of burr: enamel 1.2 mm thick in the median, the pulp 3.9 mm below
  EXPECT_NEAR(press, 1.2e-3, 0.2e-3) << "not 4 mm, which went into the pulp";
  EXPECT_LT(target->room, 4e-3);
  EXPECT_GT(target->room, press);
  EXPECT_GE(press, kLeastPress);
}

// When the steps before it are done, the surface is another, and what is spared is nearer.
TEST(StepTarget, KeepsAwayFromThePulpAfterTheStepsBeforeToo) {
  const Opened all = opened("tooth");
  NoProgress quiet;
  scoring::Workpiece scene(*all.bone, *all.bone, all.lesson, quiet);
  const metrics::Region done = scene.regions({"way in", "deep caries"});
  Opened later = opened("tooth");
  for (volume::BrickIndex b = 0; b < later.bone->brick_count(); ++b) {
    const volume::Field* field = later.bone->brick_field(b);
    if (field == nullptr) continue;
    volume::BrickField now;
    std::copy(field, field + volume::kBrickVoxels, now.voxel);
    bool cut = false;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const Ijk at = later.bone->brick_ijk(b) + Ijk(v & 7, (v >> 3) & 7, v >> 6);
      const Vec3 p = later.bone->grid().world_from_grid(at.cast<double>());
      if (now.voxel[v] == 0 || !metrics::contains(done, p)) continue;
      now.voxel[v] = 0;
      cut = true;
    }
    if (!cut) continue;
    later.bone->ensure_slot(b);
    later.bone->write_brick(b, now);
    later.bone->commit_ahead();
  }
  scoring::TargetFinder finder(*all.bone, all.lesson, quiet);
  scenario::Step step = *all.lesson.step("caries");
  step.region = "over the pulp";  // the floor that is left: a press there would be the worst
  const auto target = finder.find(step, *later.bone, 0.4e-3);
  ASSERT_TRUE(target);
  ASSERT_TRUE(target->found);
  EXPECT_LT(target->room, 1.2e-3) << "a millimetre was left";
  expect_press(later, step, *target, 0.4e-3);
}

TEST(BurrFor, TakesTheNearestSizeThatSuitsAndLeavesOneThatDoes) {
  using tool::BurrKind;
  scenario::Step step;
  const double sizes[] = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3};
  const BurrChoice now = {BurrKind::cutting, 3e-3};
  EXPECT_EQ(burr_for(step, now, sizes), now) << "the step says nothing";
  step.diameter = {2.5e-3, 3.5e-3};
  EXPECT_EQ(burr_for(step, now, sizes), now);
  step.diameter = {1e-3, 2.2e-3};
  EXPECT_DOUBLE_EQ(burr_for(step, now, sizes).diameter, 2e-3);
  step.diameter = {4e-3, 7e-3};
  EXPECT_DOUBLE_EQ(burr_for(step, now, sizes).diameter, 4e-3);
  step.diameter = {5.5e-3, 6e-3};
  EXPECT_DOUBLE_EQ(burr_for(step, now, sizes).diameter, 5e-3) << "the nearest there is";
  step.kind = BurrKind::diamond;
  EXPECT_EQ(burr_for(step, now, sizes).kind, BurrKind::diamond);
}

}  // namespace
}  // namespace burr::guidance
