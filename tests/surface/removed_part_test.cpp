// The removed part is checked by its surface, so the test is in this folder.
#include "burr/volume/removed_part.h"

#include <gtest/gtest.h>

#include <numbers>

#include "burr/surface/mesher.h"
#include "burr/volume/volume_of.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using math::Vec3;
using test::askew;
using test::bone_of;
using test::shape_of;

Mesh whole(const volume::Bone& bone) {
  NoProgress progress;
  auto mesh = whole_surface(bone, 1, progress);
  EXPECT_TRUE(mesh.ok());
  return std::move(*mesh);
}

TEST(RemovedPart, OfABallMilledIntoASlabIsTheCap) {
  // a slab up to z = 20.3; a ball of radius 9.1 with its centre 2.2 above it; the removed part is
  // the lens below
  const double top = 20.3, radius = 9.1;
  const Vec3 centre(24.2, 23.7, 22.5);
  const auto slab = [&](const Vec3& p) { return top - p.z(); };
  const auto ball = [&](const Vec3& p) { return radius - (p - centre).norm(); };
  const auto grid = askew({49, 48, 32});
  const auto before = bone_of(grid, slab);
  const auto after = bone_of(grid, [&](const Vec3& p) { return std::min(slab(p), -ball(p)); });
  const auto removed = volume::removed_part(*before, *after);
  ASSERT_TRUE(removed.ok());

  const Mesh mesh = whole(**removed);
  const auto shape = shape_of(mesh);
  EXPECT_EQ(shape.trouble, "");
  EXPECT_EQ(shape.euler(), 2) << "one piece without holes, no sheets left on the old surface";
  const double height = radius - (centre.z() - top);
  const double truth =
      std::numbers::pi * height * height * (3 * radius - height) / 3 * std::pow(grid.voxel, 3);
  EXPECT_NEAR(shape.volume / truth, 1, 0.02);

  // every vertex lies on the true lens: on the ball below, on the slab's old top above
  double worst = 0;
  for (const Vertex& v : mesh.vertices) {
    const Vec3 p = grid.grid_from_world(v.p.cast<double>());
    worst = std::max(worst, std::abs(std::min(ball(p), slab(p))));
  }
  EXPECT_LT(worst, 0.35) << "voxels, at the sharp rim";

  // the remaining and the removed part add up to the whole
  const double sum = shape_of(whole(**removed)).volume + shape_of(whole(*after)).volume;
  EXPECT_NEAR(sum / shape_of(whole(*before)).volume, 1, 0.001);
  EXPECT_NEAR(
      (volume::volume_of(**removed) + volume::volume_of(*after)) / volume::volume_of(*before), 1,
      0.001);
}

TEST(RemovedPart, ALayerThinnerThanAVoxelIsThereOnAFinerGrid) {
  // an inclined slab, lowered by 0.4 voxel inside a round patch
  const Vec3 up = Vec3(0.3, -0.2, 1).normalized();
  const Vec3 middle(24, 24, 16);
  const auto slab = [&](const Vec3& p) { return (middle - p).dot(up); };
  const auto patch = [&](const Vec3& p) {  // depth inside a round pin along `up`
    const Vec3 d = p - middle;
    return 14 - (d - up * d.dot(up)).norm();
  };
  const auto grid = askew({49, 48, 32});
  const auto before = bone_of(grid, slab);
  const auto after = bone_of(
      grid, [&](const Vec3& p) { return std::min(slab(p), std::max(slab(p) - 0.4, -patch(p))); });
  const double truth = std::numbers::pi * 14 * 14 * 0.4 * std::pow(grid.voxel, 3);
  EXPECT_NEAR(volume::removed_volume(*before, *after) / truth, 1, 0.05);
  const auto fine = volume::removed_part(*before, *after, 4);
  ASSERT_TRUE(fine.ok());
  const auto shape = shape_of(whole(**fine));
  EXPECT_EQ(shape.trouble, "");
  EXPECT_NEAR(shape.volume / truth, 1, 0.1);
}

TEST(RemovedPart, OnAFinerGridLiesInTheSamePlace) {
  const auto grid = askew({30, 31, 29});
  const auto before = bone_of(grid, [](const Vec3&) { return 5.0; });  // up to the border
  const auto ball = [](const Vec3& p) { return 6.3 - (p - Vec3(9.2, 14, 13.3)).norm(); };
  const auto after = bone_of(grid, [&](const Vec3& p) { return std::min(5.0, -ball(p)); });
  for (const int finer : {1, 2, 3}) {
    SCOPED_TRACE(finer);
    const auto removed = volume::removed_part(*before, *after, finer);
    ASSERT_TRUE(removed.ok());
    const Mesh mesh = whole(**removed);
    EXPECT_EQ(shape_of(mesh).euler(), 2);
    for (const Vertex& v : mesh.vertices) {
      ASSERT_NEAR(ball(grid.grid_from_world(v.p.cast<double>())), 0, 0.06);
      ASSERT_EQ(v.tissue, 1);
    }
  }
}

TEST(RemovedPart, IsAnErrorWhenThereIsNone) {
  const auto bone = bone_of(askew({20, 20, 20}), [](const Vec3& p) { return 9.0 - p.z(); });
  const auto none = volume::removed_part(*bone, *bone);
  ASSERT_FALSE(none.ok());
  const auto other = bone_of(askew({21, 20, 20}), [](const Vec3& p) { return 9.0 - p.z(); });
  EXPECT_FALSE(volume::removed_part(*bone, *other).ok());
}

}  // namespace
}  // namespace burr::surface
