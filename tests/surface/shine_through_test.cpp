// What shows through thin bone, for bone of known thickness.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "burr/surface/mesher.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using volume::Field;
using volume::TissueId;
using volume::TissueKind;

constexpr TissueId kBone = 1, kNerve = 2, kCell = 3;
constexpr double kTop = 30;  // upper end of the bone [voxel]

// Bone up to kTop; below `floor(x)` two voxels of `filling`, and below those `behind`.
std::unique_ptr<volume::Bone> plate(const volume::Grid& grid, TissueId filling, TissueId behind,
                                    const std::function<double(double x)>& floor,
                                    double top = kTop) {
  volume::TissueTable table;
  table.tissues = {{.name = "air", .kind = TissueKind::air},
                   {.name = "bone", .kind = TissueKind::solid},
                   {.name = "nerve", .kind = TissueKind::soft},
                   {.name = "cell", .kind = TissueKind::air}};
  std::vector<Field> field;
  std::vector<TissueId> tissue;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const double depth = std::min(top - k, k - floor(i));
        field.push_back(volume::field_from_depth(depth));
        const TissueId below = k < floor(i) - 2 ? behind : filling;
        tissue.push_back(k < floor(i) ? below : depth > -volume::kRamp ? kBone : TissueId{0});
      }
  return volume::bone_from_arrays(grid, table, field, tissue, {}, 0);
}

template <class Judge>
void each_on_top(const volume::Bone& bone, Judge&& judge) {
  NoProgress quiet;
  const auto mesh = whole_surface(bone, 1, quiet);
  ASSERT_TRUE(mesh);
  int seen = 0;
  for (const Vertex& v : mesh->vertices) {
    const math::Vec3 p = bone.grid().grid_from_world(v.p.cast<double>());
    // not at the border of the grid, where the surface turns down
    if (std::abs(p.z() - kTop) > 0.1 || p.x() < 3 || p.x() > bone.grid().size.x() - 4 ||
        p.y() < 3 || p.y() > bone.grid().size.y() - 4)
      continue;
    judge(p, v);
    ++seen;
  }
  EXPECT_GT(seen, 100);
}

TEST(ShineThrough, IsSeenTheMoreTheThinnerTheBone) {
  for (const double voxel : {0.15e-3, 0.25e-3}) {
    SCOPED_TRACE(voxel);
    // from 2 to 14 voxels thick
    const auto floor = [](double x) { return kTop - 2 - 12 * x / 47; };
    const auto bone = plate(test::askew({48, 24, 36}, voxel), kNerve, kNerve, floor);
    int hidden = 0;
    each_on_top(*bone, [&](const math::Vec3& p, const Vertex& v) {
      const double thick = (kTop - floor(p.x())) * voxel;
      const double least = 191 * (1 - (thick + 1.01 * voxel) / shine_through(voxel)) - 1;
      const double most = 191 * (1 - (thick - 0.51 * voxel) / shine_through(voxel)) + 1;
      EXPECT_GE(v.through, least) << "under " << 1e3 * thick << " mm";
      EXPECT_LE(v.through, std::max(most, 0.0)) << "under " << 1e3 * thick << " mm";
      EXPECT_EQ(v.beneath, v.through > 0 ? kNerve : 0);
      EXPECT_EQ(v.tissue, kBone) << "it is still bone";
      hidden += v.through == 0 ? 1 : 0;
    });
    EXPECT_GT(hidden, 0) << "thick bone hides it";
  }
}

// For every position of the brick borders, and every distance of the nerve from them.
TEST(ShineThrough, IsFoundWhereverItLies) {
  for (int top = 24; top < 32; ++top)
    for (const int thick : {3, 6, 9, 11}) {
      SCOPED_TRACE(top * 100 + thick);
      // a nerve along y, from x = 28 to 35; elsewhere bone down to the end of the grid
      const auto floor = [&](double x) { return x >= 28 && x <= 35 ? top - thick : -9.0; };
      const auto bone = plate(test::askew({64, 16, 40}, 0.1e-3), kNerve, kNerve, floor, top);
      NoProgress quiet;
      const auto mesh = whole_surface(*bone, 1, quiet);
      ASSERT_TRUE(mesh);
      int over = 0, far = 0;
      for (const Vertex& v : mesh->vertices) {
        const math::Vec3 p = bone->grid().grid_from_world(v.p.cast<double>());
        if (std::abs(p.z() - top) > 0.1 || p.y() < 3 || p.y() > 12 || p.x() < 3 || p.x() > 60)
          continue;
        if (p.x() > 29.5 && p.x() < 33.5) {
          EXPECT_EQ(v.beneath, kNerve);
          EXPECT_NEAR(v.through, 191 * (1 - thick * 0.1e-3 / shine_through(0.1e-3)), 191 * 0.15);
          ++over;
        } else if (p.x() < 26 || p.x() > 37) {
          EXPECT_EQ(v.through, 0);
          ++far;
        }
      }
      EXPECT_GT(over, 20);
      EXPECT_GT(far, 100);
    }
}

TEST(ShineThrough, AirHidesWhatIsBehindItAndDoesNotShineItself) {
  const auto floor = [](double) { return kTop - 3; };  // the nerve would be 1 mm below the surface
  const auto bone = plate(test::askew({24, 24, 36}, 0.2e-3), kCell, kNerve, floor);
  each_on_top(*bone, [](const math::Vec3&, const Vertex& v) { EXPECT_EQ(v.through, 0); });
}

TEST(ShineThrough, WhatFillsAHollowIsSeenOnItsWall) {
  const auto floor = [](double) { return 12.0; };
  const auto bone = plate(test::askew({24, 24, 36}, 0.2e-3), kNerve, kNerve, floor);
  NoProgress quiet;
  const auto mesh = whole_surface(*bone, 1, quiet);
  ASSERT_TRUE(mesh);
  int walls = 0;
  for (const Vertex& v : mesh->vertices) {
    const math::Vec3 p = bone->grid().grid_from_world(v.p.cast<double>());
    if (std::abs(p.z() - 12) > 0.1 || p.x() < 3 || p.x() > 20 || p.y() < 3 || p.y() > 20) continue;
    EXPECT_EQ(v.beneath, kNerve);
    EXPECT_GE(v.through, 215);
    ++walls;
  }
  EXPECT_GT(walls, 100);
}

TEST(ShineThrough, NothingDoesWhereNothingIsSoft) {
  const auto bone =
      plate(test::askew({24, 24, 36}, 0.2e-3), kBone, kBone, [](double) { return -9.0; });
  each_on_top(*bone, [](const math::Vec3&, const Vertex& v) {
    EXPECT_EQ(v.beneath, 0);
    EXPECT_EQ(v.through, 0);
  });
}

}  // namespace
}  // namespace burr::surface
