// Surfaces of soft structures: closed, and where the formula says.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "burr/phantom/build.h"
#include "burr/phantom/phantoms.h"
#include "burr/surface/label_surface.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using math::Vec3;

// How far a place lies from the boundary of a tissue in the formula, found in steps along a line:
// true where the boundary is within `reach`.
bool boundary_near(const phantom::Phantom& phantom, volume::TissueId tissue, const Vec3& p,
                   const Vec3& n, double reach) {
  const auto is = [&](const Vec3& q) {
    return phantom.formula.tissue(q, phantom.formula.depth(q)) == tissue;
  };
  const bool here = is(p);
  for (int step = 1; step <= 10; ++step) {
    const double d = 0.1 * step * reach;
    for (const Vec3& way : {n, Vec3::UnitX().eval(), Vec3::UnitY().eval(), Vec3::UnitZ().eval()})
      if (is(p + d * way) != here || is(p - d * way) != here) return true;
  }
  return false;
}

TEST(LabelSurface, IsClosedAndTrueForEachStructureOfTheTemporalBone) {
  constexpr double kVoxel = 0.5e-3;
  const phantom::Phantom phantom = phantom::temporal_bone(kVoxel);
  NoProgress quiet;
  const auto bone = phantom::bone_from_formula(phantom::box_grid(phantom.lo, phantom.hi, kVoxel),
                                               phantom.tissues, phantom.formula, 0, 2, quiet);
  ASSERT_TRUE(bone.ok());
  const auto soft = soft_tissues(**bone);
  ASSERT_EQ(soft.size(), 9U);
  for (const volume::TissueId tissue : soft) {
    SCOPED_TRACE(phantom.tissues[tissue].name);
    const auto mesh = label_surface(**bone, tissue, quiet);
    ASSERT_TRUE(mesh.ok());
    ASSERT_FALSE(mesh->triangles.empty());
    EXPECT_EQ(test::shape_of(*mesh).trouble, "");
    // structures of fewer than four voxels across are as good as their labels, a voxel
    const bool thin = phantom.tissues[tissue].name.find("chorda") == 0 ||
                      phantom.tissues[tissue].name.find("eardrum") == 0 ||
                      phantom.tissues[tissue].name.find("semicircular") == 0 ||
                      phantom.tissues[tissue].name.find("cochlea") == 0;
    std::size_t asked = 0, far = 0;
    for (std::size_t v = 0; v < mesh->vertices.size(); v += 1 + mesh->vertices.size() / 300) {
      const Vertex& vertex = mesh->vertices[v];
      ASSERT_EQ(vertex.tissue, tissue);
      ++asked;
      far += boundary_near(phantom, tissue, vertex.p.cast<double>(), vertex.n.cast<double>(),
                           (thin ? 1.0 : 0.5) * kVoxel)
                 ? 0
                 : 1;
    }
    // where two faces meet in an edge, as at the end of a tube, the filter rounds the edge
    EXPECT_LE(static_cast<double>(far), 0.035 * static_cast<double>(asked)) << "of " << asked;
  }
}

// A tube of known radius, askew to the voxels: no vertex is farther than half a voxel from it.
TEST(LabelSurface, TubeHasItsRadius) {
  const volume::Grid grid = test::askew(math::Ijk(40, 36, 44));
  const std::size_t count = static_cast<std::size_t>(grid.size.prod());
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "nerve", .kind = volume::TissueKind::soft});
  const Vec3 way = Vec3(0.2, 0.35, 1).normalized(), middle(19, 17, 21);
  for (const double radius : {1.5, 2.5, 5.0}) {
    SCOPED_TRACE(radius);
    std::vector<volume::Field> field(count);
    std::vector<volume::TissueId> tissue(count);
    std::size_t at = 0;
    const auto off = [&](const Vec3& p) { return (p - middle).cross(way).norm() - radius; };
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) tissue[at++] = off(Vec3(i, j, k)) < 0 ? 2 : 0;
    const auto bone = volume::bone_from_arrays(grid, tissues, field, tissue, {}, 0);
    NoProgress quiet;
    const auto mesh = label_surface(*bone, 2, quiet);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(test::shape_of(*mesh).trouble, "");
    double most = 0, sum = 0, turned = 0;
    int inner = 0;
    for (const Vertex& vertex : mesh->vertices) {
      const Vec3 p = grid.grid_from_world(vertex.p.cast<double>());
      if (p.z() < 5 || p.z() > grid.size.z() - 6) continue;  // its ends at the grid's border
      most = std::max(most, std::abs(off(p)));
      sum += off(p);
      ++inner;
      const Vec3 out = (p - middle) - way * way.dot(p - middle);
      turned = std::max(turned, std::acos(std::clamp(out.normalized().dot(grid.frame.q.conjugate() *
                                                                          vertex.n.cast<double>()),
                                                     -1.0, 1.0)));
    }
    EXPECT_LT(most, 0.5);
    EXPECT_LT(std::abs(sum / inner), 0.2);
    EXPECT_LT(turned, 6 * std::numbers::pi / 180) << "of its normals";
  }
}

// A sheet nearly parallel to the voxels, as dura over the tegmen: its faces are planes, not terraces.
TEST(LabelSurface, FlatSheetHasNoTerraces) {
  volume::Grid grid;
  grid.size = {96, 64, 32};
  grid.voxel = 0.25e-3;
  const auto count = static_cast<std::size_t>(grid.size.prod());
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "dura", .kind = volume::TissueKind::soft});
  for (const double slope : {0.03, 0.07, 0.2}) {
    SCOPED_TRACE(slope);
    const Vec3 up = Vec3(-slope, -0.3 * slope, 1).normalized(), middle(48, 32, 16);
    const auto off = [&](const Vec3& p) { return up.dot(p - middle); };
    std::vector<volume::Field> field(count);
    std::vector<volume::TissueId> tissue(count);
    std::size_t at = 0;
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i)
          tissue[at++] = std::abs(off(Vec3(i, j, k))) < 2.6 ? 2 : 0;
    const auto bone = volume::bone_from_arrays(grid, tissues, field, tissue, {}, 0);
    NoProgress quiet;
    const auto mesh = label_surface(*bone, 2, quiet);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(test::shape_of(*mesh).trouble, "");
    double most = 0, turned = 0;
    int asked = 0;
    for (const Vertex& vertex : mesh->vertices) {
      const Vec3 p = grid.grid_from_world(vertex.p.cast<double>());
      if ((p - middle).cwiseAbs().x() > 24 || (p - middle).cwiseAbs().y() > 14) continue;
      ++asked;
      most = std::max(most, std::abs(std::abs(off(p)) - 2.6));
      turned =
          std::max(turned, std::acos(std::min(1.0, std::abs(up.dot(vertex.n.cast<double>())))));
    }
    EXPECT_GT(asked, 2000);
    EXPECT_LT(most, 0.5);
    EXPECT_LT(turned, 1.5 * std::numbers::pi / 180) << "of its normals";
  }
}

// A membrane one voxel thick has no hole: its surface is one shell with both faces.
TEST(LabelSurface, ThinMembraneHasNoHole) {
  volume::Grid grid;
  grid.size = {24, 24, 24};
  const auto count = static_cast<std::size_t>(24 * 24 * 24);
  std::vector<volume::Field> field(count);
  std::vector<volume::TissueId> tissue(count);
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "membrane", .kind = volume::TissueKind::soft});
  std::size_t at = 0;
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i)
        tissue[at++] = k == (i + j) / 4 + 6 && (Vec3(i, j, 0) - Vec3(11, 11, 0)).norm() < 9 ? 2 : 0;
  const auto bone = volume::bone_from_arrays(grid, tissues, field, tissue, {}, 0);
  NoProgress quiet;
  const auto mesh = label_surface(*bone, 2, quiet);
  ASSERT_TRUE(mesh.ok());
  const test::Shape shape = test::shape_of(*mesh);
  EXPECT_EQ(shape.trouble, "");
  EXPECT_EQ(shape.euler(), 2);
}

}  // namespace
}  // namespace burr::surface
