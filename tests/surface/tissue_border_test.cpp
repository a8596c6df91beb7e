// The border of two solid tissues on the surface: a soft line where the labels have stairs.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "burr/surface/mesher.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using volume::TissueId;
using volume::TissueKind;

constexpr TissueId kEnamel = 1, kCaries = 2;
constexpr double kTop = 16;  // upper end of the bone [voxel]

// Caries where p lies beyond a line that runs askew to the voxels.
double beyond(const math::Vec3& p) { return math::Vec3(1, 0.37, 0).normalized().dot(p) - 26; }

std::unique_ptr<volume::Bone> two_tissues(const volume::Grid& grid) {
  volume::TissueTable table;
  table.tissues = {{.name = "air", .kind = TissueKind::air},
                   {.name = "enamel", .kind = TissueKind::solid},
                   {.name = "caries", .kind = TissueKind::solid}};
  std::vector<volume::Field> field;
  std::vector<TissueId> tissue;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        field.push_back(volume::field_from_depth(kTop - k));
        tissue.push_back(k - kTop > volume::kRamp          ? TissueId{0}
                         : beyond(math::Vec3(i, j, k)) > 0 ? kCaries
                                                           : kEnamel);
      }
  return volume::bone_from_arrays(grid, table, field, tissue, {}, 0);
}

// Share of caries in the colour of a vertex, 0..1.
double caries_in(const Vertex& v) {
  const double other = v.through / 255.0;
  return v.tissue == kCaries ? 1 - other : other;
}

TEST(TissueBorder, OfTwoSolidsIsASoftLineWithoutStairs) {
  const auto bone = two_tissues(test::askew({56, 40, 24}, 0.2e-3));
  NoProgress quiet;
  const auto mesh = whole_surface(*bone, 1, quiet);
  ASSERT_TRUE(mesh);
  int near = 0, far = 0;
  for (const Vertex& v : mesh->vertices) {
    const math::Vec3 p = bone->grid().grid_from_world(v.p.cast<double>());
    if (std::abs(p.z() - kTop) > 0.1 || p.x() < 4 || p.x() > 51 || p.y() < 4 || p.y() > 35)
      continue;
    const double d = beyond(p);
    const double share = caries_in(v);
    SCOPED_TRACE(d);
    if (std::abs(d) > 3) {
      ++far;
      EXPECT_EQ(v.through, 0) << "the colour of the tissue alone";
      EXPECT_EQ(v.tissue, d > 0 ? kCaries : kEnamel);
      continue;
    }
    ++near;
    // a tent of two voxels over a half space: 1/2 at the border, slope about 1/2 a voxel. Stairs
    // would be 0 or 1.
    EXPECT_NEAR(share, std::clamp(0.5 + 0.5 * d, 0.0, 1.0), 0.2);
  }
  EXPECT_GT(near, 100);
  EXPECT_GT(far, 500);
}

// The sum over every voxel of the bone, without any way to leave voxels out.
TEST(TissueBorder, IsTheTentOverAllVoxels) {
  const auto bone = two_tissues(test::askew({56, 40, 24}, 0.2e-3));
  NoProgress quiet;
  const auto mesh = whole_surface(*bone, 1, quiet);
  ASSERT_TRUE(mesh);
  int mixed = 0;
  for (const Vertex& v : mesh->vertices) {
    const math::Vec3 p = bone->grid().grid_from_world(v.p.cast<double>());
    if (std::abs(p.z() - kTop) > 0.1 || std::abs(beyond(p)) > 3 || p.y() < 4 || p.y() > 35)
      continue;
    double own = 0, other = 0;
    for (int k = 0; k < bone->grid().size.z(); ++k)
      for (int j = 0; j < bone->grid().size.y(); ++j)
        for (int i = 0; i < bone->grid().size.x(); ++i) {
          const TissueId tissue = bone->tissue(i, j, k);
          if (tissue == 0) continue;
          const math::Vec3 tent = (2 - (math::Vec3(i, j, k) - p).array().abs()).max(0);
          (tissue == v.tissue ? own : other) += tent.prod();
        }
    EXPECT_NEAR(v.through, 255 * other / (own + other), 1);
    mixed += v.through > 0 ? 1 : 0;
  }
  EXPECT_GT(mixed, 50);
}

}  // namespace
}  // namespace burr::surface
