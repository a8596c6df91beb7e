// workshop/prepare.h - a recipe or a case becomes what a session needs: the bone, the place where
// work begins, the tool.
//
//     auto prepared = workshop::prepare(*scenario::read_case("temporal-bone"), progress);
//     auto session = workshop::begin_by_itself(*prepared, "pocket", 20, settings_of(*prepared), progress);
//     auto recorder = workshop::record(**session, "s.mcap", about(*prepared, "pocket"));
//
// Nothing is printed: notices for the user are in PreparedBone::summary.notices.
// Thread: any, one call at a time. It takes seconds and reports its progress. Errors: one sentence.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/device/device.h"
#include "burr/device/simulated_hand.h"
#include "burr/importing/import.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"

namespace burr::workshop {

struct Tool {
  double diameter_mm = 0;                         // 0: that of the case, otherwise 5
  double rpm = 0;                                 // 0: that of the case, otherwise 40 000
  tool::BurrKind kind = tool::BurrKind::cutting;  // used if there is no case
};

struct PreparedBone {
  std::unique_ptr<volume::Bone> bone;
  surgeon::WorkPlace place;
  importing::ImportSummary summary;            // with the notices
  std::shared_ptr<const volume::Greys> greys;  // if keep_greys was set
  scenario::BoneRecipe recipe;                 // as used: with source and voxel size of the case
  std::optional<scenario::Case> work_case;
  std::string what;  // names the bone without a patient: "temporal-bone", "NIfTI scan"
  double burr_mm =
      0;            // diameter; wide enough to be felt: a notice says where another one was taken
  tool::Burr burr;  // the same burr
  double spindle = 0;  // [rad/s]
};

// scan, keep_greys: see open_bone().
[[nodiscard]] Result<PreparedBone> prepare(const scenario::BoneRecipe& recipe, Progress& progress,
                                           const Tool& tool = {}, const io::Scan* scan = nullptr,
                                           bool keep_greys = false);
// recipe: its voxel size, materials and so on replace those of the case; its source is ignored.
// Error: also a tissue that the case names and the bone lacks.
[[nodiscard]] Result<PreparedBone> prepare(const scenario::Case& work, Progress& progress,
                                           const Tool& tool = {}, scenario::BoneRecipe recipe = {},
                                           const io::Scan* scan = nullptr, bool keep_greys = false);

// The recipe of a case: its phantom or volume, and its voxel size if `recipe` has none.
[[nodiscard]] scenario::BoneRecipe recipe_of(const scenario::Case& work,
                                             scenario::BoneRecipe recipe = {});

// A burr must span four voxels to be felt. If `diameter_mm` spans fewer, and a burr of up to
// tool::kLargestDiameter would span four, diameter_mm becomes the smallest such size, and a notice
// says so.
void fit_burr(double& diameter_mm, double voxel, std::vector<std::string>& notices);

[[nodiscard]] sim::SessionSettings settings_of(const PreparedBone& prepared, bool realtime = false);

// Makes the session, which takes over the bone.
[[nodiscard]] Result<std::unique_ptr<sim::Session>> begin(PreparedBone& prepared,
                                                          std::unique_ptr<device::Device> hand,
                                                          const sim::SessionSettings& settings,
                                                          Progress& progress);
// The same with a simulated hand that makes a motion of surgeon/motion.h or follows a path.
[[nodiscard]] Result<std::unique_ptr<sim::Session>> begin_by_itself(
    PreparedBone& prepared, const std::string& motion, double seconds,
    const sim::SessionSettings& settings, Progress& progress);
[[nodiscard]] Result<std::unique_ptr<sim::Session>> begin_by_itself(
    std::unique_ptr<volume::Bone> bone, device::HandPath path, const sim::SessionSettings& settings,
    Progress& progress, const device::ArmSettings& arm = {});

}  // namespace burr::workshop
