#include "window/replay/facts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/record/player.h"
#include "burr/volume/distance_to.h"
#include "burr/workshop/spared.h"

namespace burr::app {
namespace {

constexpr double kTurning = 0.05;  // of full speed; a slower spindle does not cut
constexpr double kApart = 0.3;     // violations with a shorter time between them are one [s]

std::size_t part_of(double t, double seconds) {
  const double at = seconds > 0 ? t / seconds * static_cast<double>(Facts::kParts) : 0;
  return at > 0 ? static_cast<std::size_t>(std::min(at, static_cast<double>(Facts::kParts - 1)))
                : std::size_t{0};
}

std::string name_in(const volume::TissueTable& table, volume::TissueId id) {
  return table[id].name;
}

// Notes a turning burr that is inside of something to be spared.
void hurt(Facts& facts, double t, double deep, std::string name) {
  std::vector<Violation>& all = facts.violations;
  if (all.empty() || all.back().name != name || t - all.back().until > kApart)
    all.push_back({t, t, std::move(name), deep});
  all.back().until = t;
  all.back().deepest = std::max(all.back().deepest, deep);
}

Status measure(record::Player& player, const volume::DistanceTo& distance, Facts& facts,
               Progress& progress) {
  const volume::Bone& bone = *facts.before;
  const double voxel = bone.grid().voxel, rate = player.info().rate_hz;
  record::StepCursor steps = player.steps();
  record::Step step;
  while (steps.next(step)) {
    const tick::TickRow& row = step.row;
    const double t = static_cast<double>(row.tick) / rate;
    if (row.tick % 4096 == 0) {
      if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
      progress.report(facts.seconds > 0 ? std::min(1.0, t / facts.seconds) : 0, "measuring");
    }
    const volume::Nearest near = distance.at(row.contact.proxy);
    const double away = near.distance - row.tool.radius;  // a damaged row may contain anything
    if (!std::isfinite(away)) continue;
    Facts::Part& part = facts.parts[part_of(t, facts.seconds)];
    if (static_cast<float>(away) < part.distance) part = {static_cast<float>(away), near.tissue};
    if (away < -0.5 * voxel &&
        std::abs(row.spindle_rad_s) > kTurning * std::abs(row.tool.full_speed))
      hurt(facts, t, -away, name_in(bone.tissues(), near.tissue));
  }
  return fine();
}

}  // namespace

Facts::Part Facts::nearest_in(double from_s, double to_s) const {
  if (parts.empty()) return {};
  const auto first = static_cast<std::ptrdiff_t>(part_of(from_s, seconds)),
             last = std::max(first, static_cast<std::ptrdiff_t>(part_of(to_s, seconds)));
  return *std::min_element(parts.begin() + first, parts.begin() + last + 1,
                           [](const Part& a, const Part& b) { return a.distance < b.distance; });
}

std::optional<Facts::Least> Facts::least() const {
  const auto found = std::min_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.distance < b.distance;
  });
  if (found == parts.end() || !std::isfinite(found->distance)) return std::nullopt;
  return Least{seconds * static_cast<double>(found - parts.begin()) / kParts,
               static_cast<double>(found->distance), name_of(*found)};
}

std::string Facts::name_of(const Part& part) const {
  return before != nullptr ? name_in(before->tissues(), part.tissue) : std::string();
}

Result<Facts> facts_of(const std::string& recording, const scenario::BoneRecipe& volume,
                       Progress& progress) {
  auto player = record::Player::open(recording);
  if (!player) return player.error();
  Facts facts;
  facts.seconds = (*player)->seconds();
  auto lost = workshop::removed_by_tissue(**player, progress, volume);
  if (!lost) return lost.error();
  facts.lost = std::move(*lost);
  auto bone = workshop::bone_of(**player, volume, progress);
  if (!bone) return bone.error();
  facts.before = std::move(*bone);
  facts.hash = facts.before->content_hash();
  const workshop::Tissues spared = workshop::read_spared((*player)->info());
  auto distance = volume::DistanceTo::make(*facts.before, spared, {}, progress);
  if (!distance) return distance.error();
  facts.spares = !distance->empty();
  if (!facts.spares) return facts;
  facts.parts.resize(Facts::kParts);
  const Status measured = measure(**player, *distance, facts, progress);
  if (!measured) return measured.error();
  return facts;
}

std::vector<LossRow> compared(const std::vector<workshop::TissueLoss>& left,
                              const std::vector<workshop::TissueLoss>& right) {
  std::vector<LossRow> rows;
  const auto put = [&rows](const workshop::TissueLoss& lost, double LossRow::*side) {
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const LossRow& each) { return each.name == lost.name; });
    if (row == rows.end()) {
      rows.push_back({lost.name});
      row = std::prev(rows.end());
    }
    (*row).*side += lost.removed;
    row->spare = row->spare || lost.spare;
  };
  for (const workshop::TissueLoss& lost : left) put(lost, &LossRow::left);
  for (const workshop::TissueLoss& lost : right) put(lost, &LossRow::right);
  std::stable_sort(rows.begin(), rows.end(), [](const LossRow& a, const LossRow& b) {
    return std::max(a.left, a.right) > std::max(b.left, b.right);
  });
  return rows;
}

}  // namespace burr::app
