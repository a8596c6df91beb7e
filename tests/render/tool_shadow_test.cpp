// The shadow of a tool that is no round burr.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "burr/render/scene.h"
#include "render/formula_surfaces.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr int kPixels = 800;
constexpr double kMm = 1e-3;

// A wall of bone at y = 0, seen from the front, with the light from the left at 45 degrees: what is d in front of the wall
// has its shadow d farther to the right.
Scene wall() {
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, {0.8F, 0.8F, 0.8F}};
  surface::Patch patch;
  for (const float x : {-0.06F, 0.06F})
    for (const float z : {-0.06F, 0.06F}) patch.vertices.push_back({{x, 0, z}, {0, -1, 0}, 1});
  patch.triangles = {0, 2, 3, 0, 3, 1};
  set_patch(scene, 0, patch);
  scene.camera.distance = 0.2;
  scene.look.key.towards = {-1, 0, 1};
  scene.look.occlusion = 0;
  scene.burr.visible = true;
  scene.burr.shaft_radius = 1e-6;
  return scene;
}

double brightness(const Image& image, double x, double z) {  // [m], on the wall
  const double per_m = kPixels / (2 * 0.2 * std::tan(0.25));
  const auto column = static_cast<std::size_t>(kPixels / 2 + x * per_m),
             row = static_cast<std::size_t>(kPixels / 2 - z * per_m);
  return image.rgb[3 * (row * kPixels + column)];
}

// of sRGB, 0..1
double linear(double brightness) {
  const double c = brightness / 255;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

surface::Mesh box(const Vec3& half) {
  surface::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& [u, v] :
           std::array<std::array<int, 2>, 4>{{{-1, -1}, {side, -side}, {1, 1}, {-side, side}}}) {
        Vec3 at = Vec3::Zero(), n = Vec3::Zero();
        n[axis] = side;
        at[axis] = side * half[axis];
        at[(axis + 1) % 3] = u * half[(axis + 1) % 3];
        at[(axis + 2) % 3] = v * half[(axis + 2) % 3];
        mesh.vertices.push_back({at.cast<float>(), n.cast<float>(), 1});
      }
      for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U})
        mesh.triangles.push_back(first + corner);
    }
  return mesh;
}

// The round burr's shadow is computed from its centre and radius; that of a ball as a tool of another shape, from its
// triangles.
TEST(ToolShadow, OfABallIsThatOfARoundBurr) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = wall();
  scene.burr.world_from_tool.p = {0, -6 * kMm, 0};
  scene.burr.radius = 3 * kMm;
  const auto round = gpu.image(scene, kPixels, kPixels);
  const surface::Patch ball = test::ball(Vec3::Zero(), 3 * kMm, 40);
  surface::Mesh mesh;
  mesh.vertices = ball.vertices;
  mesh.triangles = ball.triangles;
  scene.burr.other = std::make_shared<const ToolLook>(ToolLook{mesh, {}});
  scene.burr.radius = 1 * kMm;  // must not matter
  const auto shaped = gpu.image(scene, kPixels, kPixels);
  scene.burr.visible = false;
  const auto bare = gpu.image(scene, kPixels, kPixels);
  ASSERT_TRUE(round.ok() && shaped.ok() && bare.ok());

  struct Dark {
    double sum = 0, x = 0;
  } of_round, of_shaped;
  double apart = 0;
  for (double x = 4 * kMm; x < 12 * kMm; x += 0.2 * kMm)
    for (double z = -6 * kMm; z < 6 * kMm; z += 0.2 * kMm) {
      const double lit = linear(brightness(*bare, x, z));
      const double a = lit - linear(brightness(*round, x, z)),
                   b = lit - linear(brightness(*shaped, x, z));
      of_round.sum += a;
      of_round.x += a * x;
      of_shaped.sum += b;
      of_shaped.x += b * x;
      apart += std::abs(a - b);
    }
  EXPECT_GT(of_round.sum, 0);
  EXPECT_NEAR(of_shaped.sum / of_round.sum, 1, 0.1);
  EXPECT_NEAR(of_shaped.x / of_shaped.sum, of_round.x / of_round.sum, 0.3 * kMm);
  EXPECT_LT(apart / of_round.sum, 0.25) << "where the edge is";
}

// A blade, 10 mm long and 0.5 mm thick, which stands on edge 4 to 12 mm in front of the wall.
TEST(ToolShadow, OfABladeIsLongAndNotRound) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = wall();
  scene.burr.radius = 4 * kMm;
  const auto image_with = [&](const Vec3& at) {
    scene.burr.world_from_tool.p = at;
    return gpu.image(scene, kPixels, kPixels);
  };
  scene.burr.other =
      std::make_shared<const ToolLook>(ToolLook{box({0.25 * kMm, 4 * kMm, 5 * kMm}), {}});
  const auto with = image_with({0, -8 * kMm, 0});
  scene.burr.visible = false;
  const auto bare = image_with({0, -8 * kMm, 0});
  ASSERT_TRUE(with.ok() && bare.ok());
  for (const double z : {-2.5, 0.0, 2.5}) {
    EXPECT_LT(brightness(*with, 7 * kMm, z * kMm), 0.75 * brightness(*bare, 7 * kMm, z * kMm)) << z;
    EXPECT_LT(brightness(*with, 10 * kMm, z * kMm), 0.85 * brightness(*bare, 10 * kMm, z * kMm))
        << z;
  }
  for (const auto& [x, z] :
       {std::array{8.0, 8.0}, {8.0, -8.0}, {16.0, 0.0}, {-4.0, 0.0}, {1.5, 0.0}})
    EXPECT_NEAR(brightness(*with, x * kMm, z * kMm), brightness(*bare, x * kMm, z * kMm), 4)
        << x << " " << z;

  // Where only the tool moves, only a part is drawn anew: nothing of the old shadow stays.
  scene.burr.visible = true;
  ASSERT_TRUE(image_with({0, -8 * kMm, 0}).ok());
  const auto moved = image_with({-12 * kMm, -8 * kMm, 6 * kMm});
  ASSERT_TRUE(moved.ok());
  for (const double z : {-2.5, 0.0, 2.5})
    EXPECT_NEAR(brightness(*moved, 7 * kMm, z * kMm), brightness(*bare, 7 * kMm, z * kMm), 2);
}

}  // namespace
}  // namespace burr::render
