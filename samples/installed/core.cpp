// samples/installed/core.cpp - burr_core alone: a scripted hand presses a burr into a ball of bone for
// two seconds. Nothing but the C++ library is loaded, and no thread is started.
#include <burr/core.h>

#include <algorithm>
#include <cstdio>
#include <vector>

int main() {
  using namespace burr;
  // a ball of 10 mm radius about the world's origin
  volume::Grid grid;
  grid.size = {96, 96, 96};
  grid.voxel = 0.25e-3;
  grid.frame.p = math::Vec3::Constant(-47.5 * grid.voxel);
  std::vector<volume::Field> field;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const math::Vec3 p = grid.world_from_grid(math::Ijk(i, j, k).cast<double>());
        field.push_back(volume::field_from_depth((10e-3 - p.norm()) / grid.voxel));
      }
  const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 64);
  NoProgress quiet;
  volume::IsoVertices surface(*bone, {}, 1, quiet);

  // down along z, pedal pressed: 1 mm deeper than where the burr touches
  const math::Quat across(0.8, 0.6, 0, 0);  // the burr's axis, so that it cuts
  device::SimulatedHand hand({{{0, {{0, 0, 15e-3}, across}, 1}, {1, {{0, 0, 11e-3}, across}, 1}}},
                             {});
  if (!hand.open()) return 1;
  tick::ServoSettings settings;
  settings.burr.radius = 2e-3;
  tick::Servo servo(*bone, surface, hand, settings);
  double most = 0;
  const tick::TickRow* row = nullptr;
  for (int tick = 0; tick < 2000; ++tick) {
    row = &servo.tick(false);
    servo.publish();
    most = std::max(most, row->contact.force.norm());
  }
  const double removed = 1e9 * row->ledger.removed;
  std::printf("pressed with up to %.2f N, %.2f mm^3 removed\n", most, removed);
  return most > 0.1 && removed > 0.1 ? 0 : 1;
}
