// The volume by cells is the volume of the mesh, whatever bricks and borders the surface crosses.
#include "burr/surface/enclosed.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "burr/surface/mesher.h"
#include "burr/surface/shells.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using math::Vec3;

double volume_of_mesh(const volume::Bone& bone) {
  NoProgress progress;
  const auto mesh = whole_surface(bone, 1, progress);
  EXPECT_TRUE(mesh.ok());
  return mesh ? shells_of(*mesh).volume : 0;
}

TEST(EnclosedVolume, OfABallIsTheFormulas) {
  const Vec3 middle(20.3, 19.6, 17.2);
  const auto bone = test::bone_of(test::askew({40, 40, 40}),
                                  [&](const Vec3& p) { return 12 - (p - middle).norm(); });
  const double formula = 4.0 / 3 * std::numbers::pi * 12 * 12 * 12 * 0.5e-3 * 0.5e-3 * 0.5e-3;
  // marching cubes lies inside a ball: the triangles of a radius of 12 voxels lack 0.4 %
  EXPECT_NEAR(enclosed_volume(*bone), formula, 0.006 * formula);
  EXPECT_NEAR(enclosed_volume(*bone), volume_of_mesh(*bone), 1e-5 * formula);
}

TEST(EnclosedVolume, IsThatOfTheMeshWhateverTheFieldAndTheBorder) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> depth(-1.5, seed % 2 == 0 ? 1.5 : 0.3);
    // bone up to the last voxel of the grid, too; sizes that end within a brick
    const auto bone = test::bone_of(test::askew({19, 16, 11}), [&](const Vec3& p) {
      return p.x() < 9 ? -3.0 : seed % 3 == 0 ? 3.0 : depth(random);
    });
    const double volume = volume_of_mesh(*bone);
    EXPECT_NEAR(enclosed_volume(*bone), volume, 1e-5 * volume);
  }
}

}  // namespace
}  // namespace burr::surface
