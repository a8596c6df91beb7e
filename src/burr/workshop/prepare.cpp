#include "burr/workshop/prepare.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "burr/workshop/case_session.h"
#include "burr/workshop/open_bone.h"

namespace burr::workshop {
namespace {

constexpr double kDiameterMm = 5, kRpm = 40'000;  // if neither user nor case gives them

double rad_s(double rpm) { return rpm * 2 * std::numbers::pi / 60; }

Result<PreparedBone> prepare(const scenario::BoneRecipe& recipe, const scenario::Case* work,
                             const Tool& tool, const io::Scan* scan, bool keep_greys,
                             Progress& progress) {
  if (work != nullptr)
    if (const Status set = check_session(*work); !set) return set.error();
  auto made = open_bone(recipe, progress, scan, keep_greys);
  if (!made) return made.error();
  if (work != nullptr) {
    const Status fits = scenario::check_tissues(*work, made->bone->tissues());
    if (!fits) return fits.error();
  }
  double diameter_mm = tool.diameter_mm > 0 ? tool.diameter_mm
                       : work != nullptr    ? scenario::burr_mm(*work)
                                            : kDiameterMm;
  const std::optional<math::Vec3> nowhere;
  auto place = surgeon::find_work_place(*made->bone, 0.5e-3 * diameter_mm,
                                        work ? work->at : nowhere, work ? work->into : nowhere);
  if (!place) return place.error();

  PreparedBone out;
  fit_burr(diameter_mm, made->bone->grid().voxel, made->summary.notices);
  out.bone = std::move(made->bone);
  out.place = *place;
  out.summary = std::move(made->summary);
  out.greys = std::move(made->greys);
  out.recipe = recipe;
  if (work != nullptr) out.work_case = *work;
  out.what = scenario::is_phantom(recipe.source) ? scenario::phantom_name(recipe.source)
                                                 : out.summary.format + " scan";
  out.burr_mm = diameter_mm;
  out.burr.radius = 0.5e-3 * diameter_mm;
  out.burr.kind = work != nullptr ? work->burr.kind : tool.kind;
  out.spindle = tool.rpm != 0     ? rad_s(tool.rpm)
                : work != nullptr ? rad_s(scenario::rpm(*work))  // as the command line has it
                                  : rad_s(kRpm);
  return out;
}

}  // namespace

Result<PreparedBone> prepare(const scenario::BoneRecipe& recipe, Progress& progress,
                             const Tool& tool, const io::Scan* scan, bool keep_greys) {
  return prepare(recipe, nullptr, tool, scan, keep_greys, progress);
}

Result<PreparedBone> prepare(const scenario::Case& work, Progress& progress, const Tool& tool,
                             scenario::BoneRecipe recipe, const io::Scan* scan, bool keep_greys) {
  return prepare(recipe_of(work, std::move(recipe)), &work, tool, scan, keep_greys, progress);
}

scenario::BoneRecipe recipe_of(const scenario::Case& work, scenario::BoneRecipe recipe) {
  recipe.source = work.phantom.empty() ? work.volume : scenario::phantom_source(work.phantom);
  if (recipe.voxel_mm == 0) recipe.voxel_mm = scenario::voxel_mm(work);
  return recipe;
}

void fit_burr(double& diameter_mm, double voxel, std::vector<std::string>& notices) {
  const double least_mm = std::ceil(4e4 * voxel - 1e-6) / 10;
  if (diameter_mm >= least_mm || least_mm > 1e3 * tool::kLargestDiameter) return;
  notices.push_back(
      fmt::format("A burr of {:.2f} mm is too small for voxels of {:.2f} mm: burr takes one of "
                  "{:.1f} mm. A smaller burr needs `voxel_mm` {:.2f} or finer.",
                  diameter_mm, 1e3 * voxel, least_mm, std::floor(25 * diameter_mm) / 100));
  diameter_mm = least_mm;
}

sim::SessionSettings settings_of(const PreparedBone& prepared, bool realtime) {
  sim::SessionSettings settings;
  settings.servo.burr.radius = prepared.burr.radius;
  settings.servo.burr.kind = prepared.burr.kind;
  settings.servo.spindle_rad_s = prepared.spindle;
  if (prepared.work_case)  // prepare() tried it
    static_cast<void>(take_session(*prepared.work_case, settings.servo));
  settings.realtime = realtime;
  return settings;
}

Result<std::unique_ptr<sim::Session>> begin(PreparedBone& prepared,
                                            std::unique_ptr<device::Device> hand,
                                            const sim::SessionSettings& settings,
                                            Progress& progress) {
  return sim::Session::make(std::move(prepared.bone), std::move(hand), settings, progress);
}

Result<std::unique_ptr<sim::Session>> begin_by_itself(std::unique_ptr<volume::Bone> bone,
                                                      device::HandPath path,
                                                      const sim::SessionSettings& settings,
                                                      Progress& progress,
                                                      const device::ArmSettings& arm) {
  return sim::Session::make(std::move(bone),
                            std::make_unique<device::SimulatedHand>(std::move(path), arm), settings,
                            progress);
}

Result<std::unique_ptr<sim::Session>> begin_by_itself(PreparedBone& prepared,
                                                      const std::string& motion, double seconds,
                                                      const sim::SessionSettings& settings,
                                                      Progress& progress) {
  auto path = surgeon::motion(motion, prepared.place, settings.servo.burr.radius, seconds);
  if (!path) return path.error();
  return begin_by_itself(std::move(prepared.bone), std::move(*path), settings, progress);
}

}  // namespace burr::workshop
