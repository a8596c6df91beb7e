#include "commands/mill_way.h"

#include <fmt/format.h>

#include <algorithm>

#include "burr/base/printable.h"
#include "burr/workshop/label_check.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kStepSeconds = 240;  // of a cut along a plane, if nobody says how long

// The cut along the plane of a step of the case.
Result<device::HandPath> step_path(const MillOptions& options, const volume::Bone& bone,
                                   surgeon::WorkPlace& place, std::optional<StepCut>& cut) {
  if (!options.work_case)
    return error(
        Trouble::usage,
        fmt::format("--motion {}: only a case has steps; name a case in place of \"{}\"",
                    base::printable(options.motion_name), base::printable(options.volume.source)));
  const auto lesson = workshop::placed_lesson(*options.work_case);
  if (!lesson) return lesson.error();
  const auto plane = surgeon::plane_of(*lesson, options.motion_name.substr(kStepMotion.size()));
  if (!plane) return plane.error();
  const auto tool = named_tool(options.tool);
  if (!tool) return tool.error();
  const surgeon::Blade blade =
      *tool ? surgeon::blade_of((*tool)->tool, (*tool)->cutter, (*tool)->lean)
            : surgeon::round_blade(0.5e-3 * options.burr_mm());
  const double seconds = options.seconds_given ? options.seconds : kStepSeconds;
  auto path = surgeon::cut_along(bone, *plane, blade, seconds);
  cut = {*plane, surgeon::bone_in_plane(bone, *plane), seconds};
  if (path) place = {path->points.front().world_from_tool.p, -plane->out};
  return path;
}

}  // namespace

Result<device::HandPath> hand_path(const MillOptions& options, const volume::Bone& bone,
                                   surgeon::WorkPlace& place, std::optional<StepCut>& cut) {
  if (options.motion_name.starts_with(kStepMotion)) return step_path(options, bone, place, cut);
  std::optional<Vec3> at, into;
  if (!options.at_mm.empty())
    at = Vec3(options.at_mm[0], options.at_mm[1], options.at_mm[2]) * 1e-3;
  if (!options.into.empty()) into = Vec3(options.into[0], options.into[1], options.into[2]);
  auto found = surgeon::find_work_place(bone, 0.5e-3 * options.burr_mm(), at, into);
  if (!options.path_csv.empty()) {
    auto path = surgeon::read_path(options.path_csv);
    if (path && found) place = *found;
    if (path && !found) place.at = path->points.front().world_from_tool.p;
    return path;
  }
  if (!found) return found.error();
  place = *found;
  return surgeon::motion(options.motion_name, place, 0.5e-3 * options.burr_mm(), options.seconds);
}

std::optional<CutLeft> left_of(const std::optional<StepCut>& cut, const volume::Bone& bone) {
  if (!cut || cut->area <= 0) return std::nullopt;
  CutLeft left;
  left.share = std::min(1.0, surgeon::bone_in_plane(bone, cut->plane) / cut->area);
  if (left.share <= 0) return left;
  left.needs_s = surgeon::seconds_needed(cut->seconds, left.share);
  left.sentence = fmt::format(
      "{:.1f} % of the bone in the plane is left: this tool needs more than {:.0f} s, "
      "try --seconds {:.0f}",
      100 * left.share, cut->seconds, left.needs_s);
  return left;
}

void rest_at_end(device::HandPath& path) {
  constexpr double kAtOnce = 1e-3, kLong = 24 * 3600;  // [s]
  device::PathPoint last = path.points.back();
  last.pedal = 0;
  for (const double wait : {kAtOnce, kLong}) {
    last.t = path.points.back().t + wait;
    path.points.push_back(last);
  }
}

}  // namespace burr::app
