#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "burr/edit/carve_kernel.h"
#include "burr/volume/volume_of.h"

namespace burr::edit {
namespace {

// The kernels contain their own copy of volume_units(), per instruction set; the ledger is exact
// only if the copies agree with it.
TEST(CarveUnits, AreThoseOfVolumeOf) {
  const std::uint64_t seed = 77;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  const CarveKernel kernel = carve_kernel();
  const float nowhere[4] = {0, 0, 0, -1};
  for (int round = 0; round < 200; ++round) {
    alignas(64) volume::Field field[volume::kBrickVoxels], excess[volume::kBrickVoxels],
        after[volume::kBrickVoxels];
    std::fill_n(excess, volume::kBrickVoxels, volume::Field{0});  // only pairs are written
    for (volume::Field& voxel : field) voxel = static_cast<volume::Field>(random());
    std::uniform_real_distribution<float> where(-12, 4), radius(1, 12);
    const float ball[4] = {where(random), where(random), where(random), radius(random)};
    const int deposit = round % 2;

    const Excess found = kernel.find(field, ball, nowhere, deposit, excess);
    std::int64_t units = 0;  // with a straight ramp, one voxel to each side of the surface
    std::uint32_t pairs = 0;
    const auto straight = [](int f) {
      return std::int64_t{volume::kVoxelUnits} * (std::clamp(f, 16384, 49152) - 16384) / 32768;
    };
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const int all = deposit == 0 ? field[v] - excess[v] : field[v] + excess[v];
      units += straight(all) - straight(field[v]);
      if (excess[v] != 0) pairs |= 1U << (v / 16);
    }
    ASSERT_EQ(deposit == 0 ? -units : units, found.units);
    ASSERT_EQ(found.pairs, pairs);

    const auto share = static_cast<std::int32_t>(random() % 65537);
    const Applied applied = kernel.apply(field, excess, pairs, share, deposit, after);
    const std::int64_t change = volume::volume_units(after) - volume::volume_units(field);
    ASSERT_EQ(deposit == 0 ? -change : change, applied.units);
  }
}

}  // namespace
}  // namespace burr::edit
