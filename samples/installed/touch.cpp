// samples/installed/touch.cpp - uses an installed burr from a separate project: makes a ball of
// bone and compares its volume with the formula.
#include <burr/base/version.h>
#include <burr/volume/bone.h>
#include <burr/volume/volume_of.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

int main() {
  using namespace burr;
  volume::Grid grid;
  grid.size = {48, 48, 48};
  grid.voxel = 0.5e-3;

  // the field: the depth of each voxel in a ball of 10 mm radius
  const double radius = 10e-3;
  const math::Vec3 centre = grid.world_from_grid({23.5, 23.5, 23.5});
  std::vector<volume::Field> field;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const math::Vec3 p = grid.world_from_grid(math::Ijk(i, j, k).cast<double>());
        field.push_back(volume::field_from_depth((radius - (p - centre).norm()) / grid.voxel));
      }
  const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);

  const double measured = volume::volume_of(*bone);
  const double truth = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  std::printf("burr %s: a ball of %.1f mm^3 measures %.1f mm^3 in %zu bricks\n", base::version(),
              truth * 1e9, measured * 1e9, bone->used_slots());
  return std::abs(measured / truth - 1) < 0.005 ? 0 : 1;
}
