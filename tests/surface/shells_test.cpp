// Parts and cavities of a mesh, of bodies of which both are known.
#include "burr/surface/shells.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>
#include <vector>

#include "burr/surface/mesher.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using math::Vec3;

Mesh mesh_of(const std::function<double(const Vec3&)>& depth) {
  const auto bone = test::bone_of(test::askew({64, 40, 40}), depth);
  NoProgress progress;
  auto mesh = whole_surface(*bone, 1, progress);
  EXPECT_TRUE(mesh) << mesh.error().text;
  return mesh ? std::move(*mesh) : Mesh{};
}
double ball(const Vec3& p, const Vec3& at, double radius) { return radius - (p - at).norm(); }
double mm3(double radius) {  // voxels of 0.5 mm
  return 4.0 / 3 * std::numbers::pi * radius * radius * radius * 0.125;
}
const Vec3 kLarge(20.3, 20.1, 19.7), kSmall(50.2, 20.4, 20.2);

// A large ball with a hollow, in it a ball with a hollow of its own; a small ball beside them, with
// a hollow too; an island.
double nested(const Vec3& p) {
  const double outer = std::min(ball(p, kLarge, 18), -ball(p, kLarge, 14)),
               inner = std::min(ball(p, kLarge, 10), -ball(p, kLarge, 5)),
               other = std::min(ball(p, kSmall, 8), -ball(p, kSmall, 4)),
               island = ball(p, {60, 5, 5}, 0.7);
  return std::max({outer, inner, other, island});
}

TEST(Shells, PartsAndCavitiesAreCounted) {
  const Shells shells = shells_of(mesh_of(nested));
  EXPECT_EQ(shells.parts, 4U);
  EXPECT_EQ(shells.cavities, 3U);
  EXPECT_EQ(shells.islands, 1U);
  EXPECT_NEAR(shells.largest * 1e9 / mm3(18), 1, 0.01);
  EXPECT_NEAR(shells.volume * 1e9 / (mm3(18) - mm3(14) + mm3(10) - mm3(5) + mm3(8) - mm3(4)), 1,
              0.01);
  const Shells one = shells_of(mesh_of([](const Vec3& p) { return ball(p, kLarge, 12); }));
  EXPECT_EQ(one.parts, 1U);
  EXPECT_EQ(one.cavities, 0U);
  EXPECT_EQ(shells_of({}).parts, 0U);
}

TEST(Shells, TheLargestPartKeepsItsOwnCavityAndNoOther) {
  const Mesh largest = largest_part(mesh_of(nested));
  const test::Shape shape = test::shape_of(largest);
  EXPECT_EQ(shape.trouble, "");
  const Shells shells = shells_of(largest);
  EXPECT_EQ(shells.parts, 1U);
  EXPECT_EQ(shells.cavities, 1U);
  EXPECT_NEAR(shells.volume * 1e9 / (mm3(18) - mm3(14)), 1, 0.01);
  EXPECT_NEAR(shape.volume, shells.volume, 1e-12);
}

TEST(Shells, CrumbsAreLeftOutWhole) {
  const Mesh whole = mesh_of(nested);
  LeftOut left_out;
  const Mesh mesh = without_crumbs(whole, 1e-9, left_out);
  EXPECT_EQ(left_out.parts, 1U);
  EXPECT_NEAR(left_out.volume, shells_of(whole).volume - shells_of(mesh).volume, 1e-15);
  EXPECT_EQ(test::shape_of(mesh).trouble, "");
  EXPECT_EQ(shells_of(mesh).parts, 3U);
  EXPECT_EQ(shells_of(mesh).cavities, 3U);
  EXPECT_EQ(without_crumbs(whole, 1e-12, left_out).triangles.size(), whole.triangles.size());
  EXPECT_EQ(left_out.parts, 0U);
}

}  // namespace
}  // namespace burr::surface
