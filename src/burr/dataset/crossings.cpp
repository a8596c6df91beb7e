#include "burr/dataset/crossings.h"

#include <bitset>
#include <unordered_map>
#include <utility>

#include "burr/sim/replay.h"
#include "burr/volume/copy_of_bone.h"

namespace burr::dataset {
namespace {

using Inside = std::bitset<volume::kBrickVoxels>;

Inside inside_of(const volume::Field* field) {
  Inside inside;
  for (std::size_t v = 0; field != nullptr && v < inside.size(); ++v)
    inside[v] = field[v] >= volume::kIso;
  return inside;
}

}  // namespace

Result<Crossings> crossings_of_states(record::Player& player, const volume::Bone& before) {
  Crossings found;
  std::unordered_map<volume::BrickIndex, Inside> now;
  record::BrickCursor bricks = player.bricks();
  for (tick::BrickRow row; bricks.next(row);) {
    if (row.brick < 0 || row.brick >= before.brick_count())
      return error(player.path() +
                   ": changes a brick that this bone does not have; give the right bone with "
                   "`volume`");
    const Inside is = inside_of(row.field.voxel);
    const auto [at, first] = now.try_emplace(row.brick);
    if (first) at->second = inside_of(before.brick_field(row.brick));
    const Inside changed = at->second ^ is;
    const math::Ijk corner = before.brick_ijk(row.brick);
    for (int v = 0; changed.any() && v < volume::kBrickVoxels; ++v) {
      if (!changed[static_cast<std::size_t>(v)]) continue;
      found.voxels.push_back({row.tick, corner.x() + v % 8, corner.y() + v / 8 % 8,
                              corner.z() + v / 64, at->second[static_cast<std::size_t>(v)]});
    }
    at->second = is;
  }
  found.after = volume::copy_of(before);
  const Status there = player.bone_at(player.seconds(), *found.after);
  if (!there) return there.error();
  return found;
}

Result<Crossings> crossings_of(record::Player& player, const volume::Bone& before,
                               Progress& progress) {
  auto bone = volume::copy_of(before);
  sim::RowLog log(*bone, false, true);
  auto again = sim::replay(player, std::move(bone), progress, &log);
  if (!again && again.error().trouble == Trouble::interrupted) return again.error();
  const bool same = again && again->gaps == 0 && !again->first_different_tick;
  if (!same) {
    auto states = crossings_of_states(player, before);
    if (states) states->late = again ? again->difference : again.error().text;
    return states;
  }
  Crossings found;
  found.voxels = log.take_voxels();
  found.after = std::move(again->bone);
  return found;
}

}  // namespace burr::dataset
