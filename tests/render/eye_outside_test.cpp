// An eye that got into bone is moved out of it, and others stay where they are.
#include "burr/render/eye_outside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace burr::render {
namespace {

using math::Vec3;

// A sphere of triangles around `middle`, facing out, or in: the wall of a hollow. Of its polar cap,
// `open` radians are left out at the bottom.
void add_sphere(surface::Patch& patch, const Vec3& middle, double radius, bool out,
                double open = 0) {
  constexpr int kRound = 48, kRings = 24;
  const auto first = static_cast<std::uint32_t>(patch.vertices.size());
  for (int ring = 0; ring <= kRings; ++ring)
    for (int n = 0; n < kRound; ++n) {
      const double tilt = (std::numbers::pi - open) * ring / kRings,
                   turn = 2 * std::numbers::pi * n / kRound;
      const Vec3 way(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                     std::cos(tilt));
      surface::Vertex vertex;
      vertex.p = (middle + radius * way).cast<float>();
      vertex.n = ((out ? 1 : -1) * way).cast<float>();
      patch.vertices.push_back(vertex);
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int n = 0; n < kRound; ++n) {
      const auto at = [&](int r, int k) {
        return first + static_cast<std::uint32_t>(r * kRound + k % kRound);
      };
      const std::uint32_t a = at(ring, n), b = at(ring + 1, n), c = at(ring + 1, n + 1),
                          d = at(ring, n + 1);
      for (const std::uint32_t corner : {a, b, c, a, c, d}) patch.triangles.push_back(corner);
      if (out) continue;
      for (std::size_t t = patch.triangles.size() - 6; t < patch.triangles.size(); t += 3)
        std::swap(patch.triangles[t + 1], patch.triangles[t + 2]);
    }
}

// A ball of bone of 20 mm radius with a hollow of 8 mm in its middle.
Scene hollow_ball() {
  surface::Patch patch;
  add_sphere(patch, Vec3::Zero(), 20e-3, true);
  add_sphere(patch, Vec3::Zero(), 8e-3, false);
  Scene scene;
  scene.tissue_colours = {{0.9F, 0.9F, 0.8F}};
  set_patch(scene, 0, patch);
  return scene;
}

TEST(EyeOutside, AnEyeInBoneOrInAClosedHollowIsMovedOutAlongItsLineOfSight) {
  for (const double from_middle : {0.5e-3, 6e-3, 12e-3, 19e-3}) {
    Scene scene = hollow_ball();
    scene.camera.azimuth = 0.7;
    scene.camera.elevation = 0.4;
    scene.camera.target = -1e-3 * scene.camera.backward();
    scene.camera.distance = from_middle + 1e-3;
    const Camera before = scene.camera;
    EXPECT_TRUE(keep_eye_outside(scene)) << from_middle;
    EXPECT_NEAR(scene.camera.eye().norm(), 22e-3, 0.2e-3) << from_middle;
    EXPECT_EQ(scene.camera.target, before.target);
    EXPECT_EQ(scene.camera.azimuth, before.azimuth);
    EXPECT_FALSE(keep_eye_outside(scene)) << "once is enough";
  }
}

TEST(EyeOutside, AnEyeInFreeAirStays) {
  Scene scene = hollow_ball();
  scene.camera.distance = 25e-3;
  EXPECT_FALSE(keep_eye_outside(scene));
  EXPECT_EQ(scene.camera.distance, 25e-3);
  // behind the ball, with the back to it
  scene.camera.target = scene.camera.backward() * -80e-3;
  EXPECT_FALSE(keep_eye_outside(scene));
}

// In a bowl, with the wall of the bowl behind the eye.
TEST(EyeOutside, AnEyeInACavityThatIsOpenStays) {
  surface::Patch patch;
  add_sphere(patch, Vec3::Zero(), 20e-3, true, 1.0);
  add_sphere(patch, Vec3::Zero(), 15e-3, false, 1.0);
  Scene scene;
  scene.tissue_colours = {{0.9F, 0.9F, 0.8F}};
  set_patch(scene, 0, patch);
  scene.camera.elevation = 0.8;  // looks down, from under the roof
  scene.camera.target = Vec3(0, 0, -10e-3);
  scene.camera.distance = 8e-3;
  EXPECT_FALSE(keep_eye_outside(scene));
}

}  // namespace
}  // namespace burr::render
