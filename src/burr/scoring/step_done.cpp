#include "burr/scoring/step_done.h"

#include <fmt/core.h>

#include <string_view>
#include <vector>

#include "burr/base/printable.h"
#include "burr/scoring/measure.h"
#include "burr/scoring/measure_list.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"
#include "burr/scoring/workpiece.h"

namespace burr::scoring {
namespace {

// The bone alone decides it, and no plane has to be named.
bool serves(const Measure& how) {
  Item item;
  item.how = &how;
  item.part = how.part;
  return !needs_recording(item) && !how.on_plane;
}

Item item_of_step(const scenario::DoneWhen& done) {
  Item item;
  item.how = measure_named(done.measure);
  if (item.how == nullptr) return item;
  item.part = item.how->part;
  // the step's own structure and region are passed on only to a measure that takes them
  if (item.how->structure) item.structure = done.structure;
  if (item.how->region || item.how->anywhere) item.region = done.region;
  item.along = done.along;
  for (const Limit& limit : item.how->limits) {
    const auto given = done.limits.find(limit.field);
    double value = given == done.limits.end() ? limit.preset : given->second;
    if (given == done.limits.end() && item.how->along && !done.along.empty() &&
        std::string_view(limit.field) == "share")
      value = kShareAlong;
    item.limits[limit.field] = value * limit.unit;
  }
  return item;
}

// What is wrong with it, as "FIELD: what and remedy"; "": nothing.
std::string fault_of(const scenario::DoneWhen& done, const scenario::CaseLesson& lesson) {
  const Item item = item_of_step(done);
  if (item.how == nullptr || !serves(*item.how)) {
    std::vector<std::string_view> names;
    for (const Measure& one : measures())
      if (serves(one)) names.emplace_back(one.name);
    return fmt::format("measure: \"{}\" is not a measure of the bone; use one of {}",
                       base::printable(done.measure), base::list_of(names));
  }
  if (item.how->structure && item.structure.empty())
    return fmt::format("structure: is missing; {} needs one", item.how->name);
  if (item.how->region && item.region.empty())
    return fmt::format("region: is missing; {} needs one", item.how->name);
  if (item.how->on_curve && done.along.empty())
    return fmt::format("along: is missing; {} needs a curve", item.how->name);
  if (!done.along.empty() && !item.how->along && !item.how->on_curve)
    return fmt::format("along: {} takes no curve; leave it out", item.how->name);
  if (const scenario::Landmark* curve = lesson.landmark(done.along);
      !done.along.empty() && (curve == nullptr || curve->points.size() < 2))
    return fmt::format("along: there is no curve \"{}\"; name a landmark with points_mm",
                       base::printable(done.along));
  for (const auto& [name, value] : done.limits) {
    const Limit* limit = nullptr;
    std::vector<std::string_view> names;
    for (const Limit& one : item.how->limits) {
      names.emplace_back(one.field);
      if (name == one.field) limit = &one;
    }
    if (limit == nullptr)
      return fmt::format("{}: is not a limit of {}; use {}", base::printable(name), item.how->name,
                         base::list_of(names));
    if (!(value > limit->above) || !(value <= limit->most))
      return fmt::format("{}: must be a number above {:g} and at most {:g}", name, limit->above,
                         limit->most);
  }
  return {};
}

}  // namespace

Status check_done(const scenario::CaseLesson& lesson, const std::string& file) {
  for (const scenario::Step& step : lesson.steps)
    if (step.done)
      if (const std::string fault = fault_of(*step.done, lesson); !fault.empty())
        return error(fmt::format("{}: line {}: step.done.{}", file, step.done->line, fault));
  return fine();
}

Result<bool> step_done(const scenario::Step& step, const scenario::CaseLesson& lesson,
                       const volume::Bone& before, const volume::Bone& now, Progress& progress) {
  if (!step.done) return false;
  const Item item = item_of_step(*step.done);
  if (item.how == nullptr) return false;
  Workpiece scene(before, now, lesson, progress);
  const bool met = measure_bone(item, scene).verdict == Verdict::met;
  if (scene.stopped() || progress.cancelled()) return error(Trouble::interrupted, "stopped");
  return met;
}

}  // namespace burr::scoring
