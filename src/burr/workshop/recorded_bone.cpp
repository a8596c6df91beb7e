#include "burr/workshop/recorded_bone.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/base/inputs.h"
#include "burr/importing/keep_greys.h"
#include "burr/record/find_volume.h"
#include "burr/record/scan_list.h"
#include "burr/volume/greys.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/open_bone.h"

namespace burr::workshop {
namespace {

constexpr double kLeastLoss = 1e-11;  // a hundredth of a mm^3  [m^3]

// How the bone was made, with what only the user has: the file, tables, a series by its UID.
Result<scenario::BoneRecipe> recipe_of(const scenario::BoneRecipe& recorded,
                                       const scenario::BoneRecipe& given,
                                       const std::string& where) {
  scenario::BoneRecipe recipe = recorded;
  recipe.source = given.source;
  recipe.labels = given.labels;
  recipe.materials = given.materials;
  recipe.read_seconds = given.read_seconds;
  recipe.read_memory_mb = given.read_memory_mb;
  if (recorded.series.empty() || recorded.series == scenario::kOwn) recipe.series = given.series;
  if (recorded.series == scenario::kOwn && given.series.empty())
    return error(Trouble::usage, fmt::format("{}: was made from a series chosen by its UID, which "
                                             "recordings do not store; give it again with `series`",
                                             where));
  if (!recorded.labels.empty() && given.labels.empty())
    return error(
        Trouble::usage,
        fmt::format("{}: was made with a table of tissues; give that table with `labels`", where));
  return recipe;
}

// Of each tissue, by its number  [m^3]
std::vector<double> volumes_of(const volume::Bone& bone) {
  std::vector<double> volumes(bone.tissues().tissues.size());
  for (std::size_t id = 1; id < volumes.size(); ++id)
    if (bone.tissues().tissues[id].kind == volume::TissueKind::solid)
      volumes[id] = volume::volume_of(bone, static_cast<volume::TissueId>(id));
  return volumes;
}

std::vector<TissueLoss> losses_of(const volume::TissueTable& table,
                                  const std::vector<double>& before,
                                  const std::vector<double>& now) {
  std::vector<TissueLoss> lost;
  for (std::size_t id = 1; id < before.size(); ++id)
    if (const double by = before[id] - now[id]; std::abs(by) > kLeastLoss)
      lost.push_back({table.tissues[id].name, by, table.tissues[id].spare});
  std::stable_sort(lost.begin(), lost.end(),
                   [](const auto& a, const auto& b) { return a.removed > b.removed; });
  return lost;
}

}  // namespace

Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                              const scenario::BoneRecipe& given,
                                              Progress& progress) {
  base::note_input(player.path());
  const record::SessionInfo& info = player.info();
  if (info.embedded && given.source.empty())
    return player.embedded_bone(static_cast<std::size_t>(info.volume.recipe.reserve_bricks));

  const scenario::BoneRecipe& recorded = info.volume.recipe;
  auto recipe = recipe_of(recorded, given, player.path());
  if (!recipe) return recipe.error();
  if (scenario::is_phantom(recorded.source) && given.source.empty()) {
    recipe->source = recorded.source;
    // burr took both for a phantom, until it was said that they do nothing there
    const scenario::BoneRecipe usual;
    recipe->smooth = usual.smooth;
    recipe->memory_mb = usual.memory_mb;
  } else if (!scenario::is_phantom(given.source)) {
    auto found = record::find_volume(info.volume, {given.source, record::volume_search_path(),
                                                   player.path(), record::scan_list()});
    if (!found) return found.error();
    recipe->source = *found;
  }
  auto made = open_bone(*recipe, progress);
  if (!made) return made.error();
  Status same = record::check_volume(info.volume, *made->bone, recipe->source);
  if (!same) {
    // a file whose two ends are those of the scan, but not the scan
    if (given.source.empty())
      static_cast<void>(record::forget_scan(record::scan_list(), recipe->source));
    return same.error();
  }
  return std::move(made->bone);
}

std::shared_ptr<const volume::Greys> greys_of(const record::Player& player,
                                              const scenario::BoneRecipe& given,
                                              Progress& progress) {
  const auto print = record::fingerprint(given.source);
  if (!print || *print != player.info().volume.source_fingerprint) return nullptr;
  scenario::BoneRecipe answered =
      given;  // doubts about the scan are answered as when the session was recorded
  answered.allow_missing = player.info().volume.recipe.allow_missing;
  answered.as_it_is = player.info().volume.recipe.as_it_is;
  answered.check_values = player.info().volume.recipe.check_values;
  answered.check_scan = player.info().volume.recipe.check_scan;
  const auto scan = io::read_scan(given.source, read_options(answered), progress);
  if (!scan) return nullptr;
  const auto plan = importing::plan_import(*scan, answered);
  return plan ? importing::keep_greys(*scan, plan->iso, progress) : nullptr;
}

Result<Watched> watch(record::Player& player, const scenario::BoneRecipe& given,
                      Progress& progress) {
  if (player.end_tick() == player.first_tick())
    return error(fmt::format("{}: this recording holds no tick", player.path()));
  auto settings = sim::settings_of(player.info(), player.path());
  if (!settings) return settings.error();
  auto bone = bone_of(player, given, progress);
  if (!bone) return bone.error();
  auto timeline = record::timeline_of(player, progress);
  if (!timeline) return timeline.error();
  return Watched{std::move(*bone), std::move(*settings), std::move(*timeline)};
}

std::vector<TissueLoss> losses(const volume::Bone& before, const volume::Bone& now) {
  return losses_of(before.tissues(), volumes_of(before), volumes_of(now));
}

Result<std::vector<TissueLoss>> removed_by_tissue(record::Player& player, Progress& progress,
                                                  const scenario::BoneRecipe& given) {
  auto bone = bone_of(player, given, progress);
  if (!bone) return bone.error();
  const std::vector<double> before = volumes_of(**bone);
  const Status ended = player.bone_at(player.seconds(), **bone);
  if (!ended) return ended.error();
  return losses_of((*bone)->tissues(), before, volumes_of(**bone));
}

}  // namespace burr::workshop
