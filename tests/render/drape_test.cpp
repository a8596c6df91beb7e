// The soft tissue and the blades around an opening.
#include "burr/render/drape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burr/render/microscope.h"
#include "formula_surfaces.h"

namespace burr::render {
namespace {

using math::Vec3;

double off_axis(const Opening& opening, const Vec3& p) {
  const Vec3 d = p - opening.centre;
  return (d - d.dot(opening.outward) * opening.outward).norm();
}

Opening opening_at(const Vec3& outward) {
  return {Vec3(0.01, 0.02, -0.01) + 0.03 * outward, outward, 17e-3};
}

TEST(Drape, LeavesTheOpeningFree) {
  for (const Vec3& outward : {Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0.5, 0.7, 0.3), Vec3(0, 0, 1)}) {
    const Opening opening = opening_at(outward.normalized());
    const Drape drape = make_drape(opening, [](double x, double y) -> std::optional<double> {
      if (x < -0.02) return std::nullopt;  // the bone ends
      return 3e-3 * std::sin(200 * x) + 4e-3 * std::cos(150 * y);
    });
    ASSERT_EQ(drape.points.size(), drape.normals.size());
    ASSERT_EQ(drape.points.size(), drape.colours.size());
    ASSERT_LT(drape.points.size(), 65536U);
    ASSERT_EQ(drape.triangles.size() % 3, 0U);
    // points and the middles of all edges: a triangle nearer to the axis has one of them nearer
    for (std::size_t t = 0; t < drape.triangles.size(); t += 3)
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 a = drape.points[drape.triangles[t + c]].cast<double>(),
                   b = drape.points[drape.triangles[t + (c + 1) % 3]].cast<double>();
        ASSERT_TRUE(a.allFinite());
        EXPECT_GE(off_axis(opening, a), opening.radius - 1e-6);
        EXPECT_GE(off_axis(opening, 0.5 * (a + b)), opening.radius - 0.05e-3);
      }
    for (const auto& n : drape.normals) EXPECT_NEAR(n.norm(), 1, 1e-3);
    // what looks at the bone through the opening passes; what looks beside it does not
    const DrapeAxes axes = axes_of(opening);
    for (int n = 0; n < 40; ++n) {
      const double a = 0.157 * n;
      const Vec3 side = std::cos(a) * axes.right + std::sin(a) * axes.up;
      const auto look = [&](double r) {
        return hit(drape,
                   {opening.centre + r * side + 0.2 * outward.normalized(), -outward.normalized()});
      };
      EXPECT_FALSE(look(0.98 * opening.radius));
      const auto beside = look(opening.radius + 12e-3);
      ASSERT_TRUE(beside);
      EXPECT_NEAR(*beside, 0.2, 0.03);
    }
  }
}

TEST(Drape, IsInThePictureOfAMicroscopeAndNotInTheOpening) {
  Scene scene;
  set_patch(scene, 0, test::ball(Vec3::Zero(), 50e-3, 60));
  const Opening opening = {{0, -50e-3, 0}, {0, -1, 0}, 15e-3};
  scene.camera = microscope_view(opening.centre, opening.outward, kFields[0]);
  scene.drape = drape_over(scene, opening);
  EXPECT_GT(bounds(scene).extent().x(), 0.15) << "the cloth is wider than the bone";
  const Ray middle = ray_through(scene.camera, 320, 180, 640, 360),
            corner = ray_through(scene.camera, 20, 20, 640, 360);
  EXPECT_FALSE(hit(*scene.drape, middle));
  EXPECT_TRUE(hit(*scene.drape, corner));
}

TEST(Microscope, ShowsEachFieldFromTheSamePlace) {
  Camera camera = microscope_view({0.01, 0, 0}, {-1, 0, 0}, kFields[kFirstField]);
  const Vec3 eye = camera.eye();
  EXPECT_TRUE(is_microscope(camera));
  EXPECT_NEAR(camera.view_height(), 25e-3, 1e-9);
  for (std::size_t n = 0; n < kFields.size(); ++n) {
    set_field(camera, kFields[n]);
    EXPECT_NEAR(camera.view_height(), kFields[n], 1e-9);
    EXPECT_EQ(field_step(camera), n);
    EXPECT_NEAR((camera.eye() - eye).norm(), 0, 1e-9);
    EXPECT_TRUE(n == 0 || kFields[n] < kFields[n - 1]);
  }
  EXPECT_FALSE(is_microscope(view_of_work({0, 0, 0}, {0, 0, 1}, 25e-3)));
}

}  // namespace
}  // namespace burr::render
