#include "burr/render/skin_mesh.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "render/formula_surfaces.h"

namespace burr::render {
namespace {

TEST(SkinMesh, NormalsComeBackWithinSixHundredthsOfADegree) {
  const unsigned seed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::normal_distribution<float> any;
  double worst = 0;
  for (int n = 0; n < 100'000; ++n) {
    math::Vec3f wanted(any(random), any(random), any(random));
    if (n % 3 == 0) wanted[n % 9 / 3] *= 1e-4F;  // near the folds of the octahedron
    wanted.normalize();
    const math::Vec3f seen = normal_of({math::Vec3f::Zero(), folded(wanted, 1)});
    EXPECT_NEAR(seen.norm(), 1, 1e-6);
    worst = std::max(worst, static_cast<double>((seen - wanted).norm()));
  }
  EXPECT_LT(worst * 180 / std::numbers::pi, 0.06);
  EXPECT_GT(worst, 0) << "nothing was rounded: nothing was tested";
}

TEST(SkinMesh, WhatLooksAlongAnAxisDoesSoExactly) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0F, 1.0F}) {
      math::Vec3f n = math::Vec3f::Zero();
      n[axis] = side;
      EXPECT_EQ(normal_of({math::Vec3f::Zero(), folded(n, 3)}), n);
    }
}

TEST(SkinMesh, PlacesTissuesAndTrianglesAreThoseOfThePatch) {
  // the second has too many vertices for 16 bit
  for (const int steps : {20, 200}) {
    surface::Patch patch = test::ball({0.1, -0.02, 0.3}, 0.02, steps);
    for (std::size_t v = 0; v < patch.vertices.size(); ++v)
      patch.vertices[v].tissue = static_cast<volume::TissueId>(v % 256);
    const SkinMesh mesh(patch);
    ASSERT_EQ(mesh.vertices().size(), patch.vertices.size());
    for (std::size_t v = 0; v < patch.vertices.size(); ++v) {
      ASSERT_EQ(mesh.vertices()[v].p, patch.vertices[v].p);
      ASSERT_EQ(tissue_of(mesh.vertices()[v]), patch.vertices[v].tissue);
    }
    ASSERT_EQ(mesh.index_count(), patch.triangles.size());
    for (std::size_t n = 0; n < patch.triangles.size(); ++n)
      ASSERT_EQ(mesh.index(n), patch.triangles[n]);
    EXPECT_EQ(mesh.large_indices().empty(), steps == 20);
  }
}

}  // namespace
}  // namespace burr::render
