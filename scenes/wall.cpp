#include "scenes/wall.h"

#include "burr/phantom/build.h"

namespace burr::scenes {

std::unique_ptr<volume::Bone> wall() {
  constexpr double kHalf = 30e-3, kThick = 8e-3, kAir = 3e-3, kVoxel = 0.5e-3;
  volume::TissueTable tissues;
  tissues.tissues[1].name = "wall";
  tissues.tissues[1].friction = 1;
  return phantom::bone_from_distance(
      phantom::box_grid({-kHalf, -kHalf, -kThick}, {kHalf, kHalf, kAir}, kVoxel), tissues,
      phantom::slab());
}

}  // namespace burr::scenes
