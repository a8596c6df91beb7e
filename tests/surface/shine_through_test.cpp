// What shines through thin bone, against how thick that bone is made.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "burr/surface/mesher.h"
#include "surface/bones.h"

namespace burr::surface {
namespace {

using volume::Field;
using volume::TissueId;
using volume::TissueKind;

constexpr TissueId kBone = 1, kNerve = 2, kCell = 3;
constexpr double kTop = 30;  // where the bone ends [voxel]

// Bone up to kTop; below `floor(x)` lies `filling`, as deep as the grid.
std::unique_ptr<volume::Bone> plate(const volume::Grid& grid, TissueId filling,
                                    const std::function<double(double x)>& floor) {
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
        const double depth = std::min(kTop - k, k - floor(i));
        field.push_back(volume::field_from_depth(depth));
        tissue.push_back(depth > -volume::kRamp ? (k < floor(i) ? filling : kBone)
                         : k < floor(i)         ? filling
                                                : TissueId{0});
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
    // not at the rim of the grid, where the surface turns down
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
    const auto bone = plate(test::askew({48, 24, 36}, voxel), kNerve, floor);
    int hidden = 0;
    each_on_top(*bone, [&](const math::Vec3& p, const Vertex& v) {
      const double thick = (kTop - floor(p.x())) * voxel;
      const double least = 191 * (1 - (thick + 1.01 * voxel) / kShineThrough) - 1;
      const double most = 191 * (1 - (thick - 0.51 * voxel) / kShineThrough) + 1;
      EXPECT_GE(v.through, least) << "under " << 1e3 * thick << " mm";
      EXPECT_LE(v.through, std::max(most, 0.0)) << "under " << 1e3 * thick << " mm";
      EXPECT_EQ(v.beneath, v.through > 0 ? kNerve : 0);
      EXPECT_EQ(v.tissue, kBone) << "it is still bone";
      hidden += v.through == 0 ? 1 : 0;
    });
    EXPECT_GT(hidden, 0) << "thick bone hides it";
  }
}

TEST(ShineThrough, AirHidesWhatIsBehindItAndDoesNotShineItself) {
  const auto floor = [](double) { return kTop - 4; };
  const auto bone = plate(test::askew({24, 24, 36}, 0.2e-3), kCell, floor);
  each_on_top(*bone, [](const math::Vec3&, const Vertex& v) { EXPECT_EQ(v.through, 0); });
}

TEST(ShineThrough, WhatFillsAHollowIsSeenOnItsWall) {
  const auto floor = [](double) { return 12.0; };
  const auto bone = plate(test::askew({24, 24, 36}, 0.2e-3), kNerve, floor);
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
  const auto bone = plate(test::askew({24, 24, 36}, 0.2e-3), kBone, [](double) { return -9.0; });
  each_on_top(*bone, [](const math::Vec3&, const Vertex& v) {
    EXPECT_EQ(v.beneath, 0);
    EXPECT_EQ(v.through, 0);
  });
}

}  // namespace
}  // namespace burr::surface
