// s07_score_a_recording - two numbers about one structure, from a recording: the bone removed
// within 3 mm of it, and the peak force while the burr's centre was within 5 mm of it.
//
//     s07_score_a_recording [FILE] [TISSUE]      default: session.mcap nerve
//
// Checks itself: all removed bone, near and far, is what the ledger of the session says.
#include <burr/base/progress.h>
#include <burr/record/player.h>
#include <burr/volume/distance_to.h>
#include <burr/volume/volume_of.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace burr;

struct Removed {
  double near = 0, all = 0;  // [m^3]
};

// Voxel by voxel: what the field lost, and how far from the structure.
Removed removed(const volume::Bone& before, const volume::Bone& after,
                const volume::DistanceTo& distance, double within) {
  Removed sum;
  const volume::Grid& grid = before.grid();
  const double unit = std::pow(grid.voxel, 3) / volume::kVoxelUnits;  // [m^3]
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const volume::Field was = before.field(i, j, k), is = after.field(i, j, k);
        if (was == is) continue;
        const double lost = unit * (volume::volume_units(was) - volume::volume_units(is));
        sum.all += lost;
        const math::Vec3 p = grid.world_from_grid(math::Ijk(i, j, k).cast<double>());
        if (distance.at(p).distance <= within) sum.near += lost;
      }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string structure = argc > 2 ? argv[2] : "nerve";
  const auto player = record::Player::open(argc > 1 ? argv[1] : "session.mcap");
  if (!player) return std::printf("%s\n", player.error().text.c_str()), 1;
  const auto before = (*player)->embedded_bone(), after = (*player)->embedded_bone();
  if (!before || !after || !(*player)->bone_at((*player)->seconds(), **after))
    return std::printf("the bone at the end cannot be made\n"), 1;

  // how far it is to the structure, anywhere
  std::vector<volume::TissueId> wanted;
  const auto& tissues = (*before)->tissues().tissues;
  for (std::size_t id = 0; id < tissues.size(); ++id)
    if (tissues[id].name == structure) wanted.push_back(static_cast<volume::TissueId>(id));
  NoProgress quiet;
  const auto distance = volume::DistanceTo::make(**before, wanted, {}, quiet);
  if (!distance || distance->empty())
    return std::printf("there is no %s in this bone\n", structure.c_str()), 1;

  const Removed bone = removed(**before, **after, *distance, 3e-3);
  double peak = 0, nearest = distance->reach(), ledger = 0;
  record::Step step;
  for (auto steps = (*player)->steps(); steps.next(step);) {
    const double far = distance->at(step.row.contact.proxy).distance;
    nearest = std::min(nearest, far);
    if (far <= 5e-3) peak = std::max(peak, step.row.contact.force.norm());
    ledger = step.row.ledger.removed - step.row.ledger.added;
  }
  std::printf("removed within 3 mm of the %s: %.3f mm3 of %.3f\n", structure.c_str(),
              bone.near * 1e9, bone.all * 1e9);
  std::printf("burr's centre at least %.2f mm away; peak force within 5 mm: %.2f N\n",
              nearest * 1e3, peak);
  return bone.near <= bone.all && std::abs(bone.all - ledger) <= 1e-3 * ledger ? 0 : 1;
}
