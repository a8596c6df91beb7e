#include "shared/work.h"
#include "burr/base/printable.h"
#include "burr/phantom/phantoms.h"
#include "burr/report/scored.h"
#include "burr/workshop/case_session.h"
#include "burr/workshop/other_bone.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <system_error>
#include <utility>

namespace burr::app {
namespace {

// a phantom's bare name; a file of that name comes first
bool bare_name(const std::string& path) {
  std::error_code nobody_asks;
  return !scenario::is_phantom(path) && path.find_first_of("./") == std::string::npos &&
         !std::filesystem::exists(path, nobody_asks);
}

}  // namespace

bool names_a_case(const std::string& path) {
  const auto known = scenario::built_in_cases();
  const bool built_in = std::find(known.begin(), known.end(), path) != known.end();
  std::error_code nobody_asks;
  return (built_in && !std::filesystem::exists(path, nobody_asks)) ||
         std::filesystem::path(path).extension() == ".toml";
}

bool names_a_scan(const WorkOptions& options) {
  const std::string& path = options.volume.source;
  return !path.empty() && !names_a_case(path) && !scenario::is_phantom(path) && !bare_name(path);
}

Status take_case(WorkOptions& options) {
  scenario::BoneRecipe& volume = options.volume;
  if (volume.source.empty()) volume.source = "temporal-bone";
  if (names_a_case(volume.source)) {
    auto read = scenario::read_case(volume.source);
    if (!read) return read.error();
    if (options.other_bones && options.bone == 0 && workshop::has_other_bones(*read))
      options.bone = std::random_device{}() % phantom::kMostBones + 1;
    if (const Status taken = workshop::take_bone(*read, options.bone); !taken) return taken;
    if (!read->rubric.empty())
      if (const Status fits = report::rubric_fits(*read); !fits) return fits;
    if (const Status set = workshop::check_session(*read); !set) return set;
    take_case(options, *read);
  } else if (options.bone > 0) {
    return error(
        Trouble::usage,
        fmt::format("--bone {}: only a case has other bones; name a case in place of \"{}\", "
                    "or leave out --bone",
                    options.bone, base::printable(volume.source)));
  }
  if (options.burr_mm == 0) options.burr_mm = 5;
  if (options.rpm == 0) options.rpm = 40'000;
  return fine();
}

void take_case(WorkOptions& options, const scenario::Case& work) {
  scenario::BoneRecipe& volume = options.volume;
  volume = workshop::recipe_of(work, volume);
  if (options.burr_mm == 0) options.burr_mm = scenario::burr_mm(work);
  if (options.rpm == 0) options.rpm = scenario::rpm(work);
  if (options.seconds == 0) options.seconds = work.seconds;
  options.title = work.title;
  options.at = work.at;
  options.into = work.into;
  options.motion = work.motion;
  options.kind = work.burr.kind;
  if (options.tool.tool.empty()) options.tool.tool = work.tool;
  options.tool.own = work.own_tools;
  options.spare = work.spare;
  options.work_case = work;
}

Result<workshop::PreparedBone> open_work(WorkOptions& options, Progress& progress,
                                         const io::Scan* scan) {
  scenario::BoneRecipe volume = options.volume;
  if (bare_name(volume.source)) volume.source = scenario::phantom_source(volume.source);
  const workshop::Tool tool{options.burr_mm, options.rpm, options.kind};
  auto prepared =
      options.work_case
          ? workshop::prepare(*options.work_case, progress, tool, volume, scan, options.keep_greys)
          : workshop::prepare(volume, progress, tool, scan, options.keep_greys);
  if (prepared) options.burr_mm = prepared->burr_mm;
  return prepared;
}

Result<sim::SessionSettings> settings_of(const WorkOptions& options, bool realtime) {
  sim::SessionSettings settings;
  settings.servo.burr.radius = 0.5e-3 * options.burr_mm;
  settings.servo.burr.kind = options.kind;
  settings.servo.spindle_rad_s = options.rpm * 2 * std::numbers::pi / 60;
  settings.servo.mode = options.mode;
  if (options.work_case)
    if (const Status set = workshop::take_session(*options.work_case, settings.servo); !set)
      return set.error();
  // what the user chose goes first
  if (options.irrigated) settings.servo.irrigated = *options.irrigated;
  if (options.touch != haptics::Method::constraint) settings.servo.touch = options.touch;
  if (const Status taken = take_tool(options.tool, settings.servo); !taken) return taken.error();
  settings.realtime = realtime;
  auto law = own_law(options.law, realtime);
  if (!law) return law.error();
  settings.law = std::move(*law);
  return settings;
}

}  // namespace burr::app
