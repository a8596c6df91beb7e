// The axis along which a mouse's tool is drawn: as a hand turns it, and out of the line of sight.
#include "burr/render/held_tool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "burr/render/pick.h"
#include "formula_surfaces.h"

namespace burr::render {
namespace {

using math::Vec3;

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// A bumpy ball of bone of 60 mm with a bowl in it, and an eye in front of the bowl.
Scene bone() {
  Scene scene;
  int n = 0;
  for (const surface::Patch& patch : test::cut(test::bumpy(30e-3, 60), 6))
    set_patch(scene, n++, patch);
  scene.camera = view_of_work({0, -25e-3, 0}, {0, -1, 0}, 60e-3);
  return scene;
}

struct Seen {
  double fastest = 0;  // [rad/s]
  int pictures = 0, in_sight = 0, crossed = 0;
};

// The pointer goes from place to place in the picture, as slowly and as fast as people move it; the
// view turns now and then.
Seen moves(int count, bool left_handed, unsigned seed) {
  constexpr int kWidth = 1280, kHeight = 720;
  Scene scene = bone();
  HeldTool held;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  Seen seen;
  double x = 640, y = 360;
  Vec3 tip = scene.camera.target, axis = Vec3::Zero();
  for (int move = 0; move < count; ++move) {
    const double to_x = kWidth * any(random), to_y = kHeight * any(random);
    const int pictures = 1 + static_cast<int>(8 * any(random) * any(random));
    const double depth = any(random) < 0.3 ? -1.5e-3 : 1e-3;  // of the burr, above the bone
    const bool turns = any(random) < 0.1;
    const double by = 0.04 * (any(random) - 0.5);  // up to 70 degrees a second
    for (int n = 1; n <= pictures; ++n) {
      const double part = static_cast<double>(n) / pictures;
      if (turns) orbit(scene.camera, by, 0.4 * by);
      const Ray ray =
          ray_through(scene.camera, x + part * (to_x - x), y + part * (to_y - y), kWidth, kHeight);
      if (const auto hit = pick(scene, ray)) tip = hit->p + (scene.burr.radius + depth) * hit->n;
      const double seconds = 1.0 / 60 + 0.02 * any(random);
      const math::Pose pose = held.at(scene, tip, left_handed, seconds);
      const Vec3 now = pose.q * Vec3::UnitZ();
      EXPECT_TRUE(pose.finite());
      EXPECT_TRUE((pose.p.array() == tip.array()).all());
      if (axis.squaredNorm() > 0)
        seen.fastest = std::max(seen.fastest, angle_between(axis, now) / seconds);
      axis = now;
      ++seen.pictures;
      if (angle_between(now, scene.camera.eye() - tip) < HeldTool::kLeast) ++seen.in_sight;
      const auto through = pick(scene, {tip + scene.burr.radius * now, now});
      if (through && through->distance < 40e-3) ++seen.crossed;
    }
    x = to_x;
    y = to_y;
  }
  return seen;
}

TEST(HeldTool, TurnsAsAHandAndLeavesTheSightOfItsTipFree) {
  for (const bool left_handed : {false, true}) {
    const unsigned seed = left_handed ? 72 : 71;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Seen seen = moves(5'000, left_handed, seed);
    std::printf(
        "%d pictures: fastest turn %.1f deg/s, in the line of sight %.3f %%, bone across "
        "the shaft %.2f %%\n",
        seen.pictures, seen.fastest * 180 / M_PI, 100.0 * seen.in_sight / seen.pictures,
        100.0 * seen.crossed / seen.pictures);
    EXPECT_LE(seen.fastest, HeldTool::kFastest * (1 + 1e-6));
    EXPECT_GT(seen.fastest, 0.1 * HeldTool::kFastest) << "it never turned";
    EXPECT_LE(seen.in_sight, 0.01 * seen.pictures);
    EXPECT_LE(seen.crossed, 0.10 * seen.pictures);
  }
}

// A view that jumps to where the camera looks along the tool: it leans away, and is in the way for
// half a second at most.
TEST(HeldTool, LeansAwayFromAnEyeThatLooksAlongIt) {
  Scene scene = bone();
  HeldTool held;
  const Vec3 tip(0, -32e-3, 0);
  Vec3 axis = held.at(scene, tip, false, 0.02).q * Vec3::UnitZ();
  scene.camera = view_of_work(tip, axis, 60e-3);
  scene.camera.azimuth = std::atan2(axis.x(), -axis.y());
  scene.camera.elevation = std::asin(axis.z());
  ASSERT_LT(angle_between(axis, scene.camera.eye() - tip), 0.01);
  int pictures = 0;
  do {
    axis = held.at(scene, tip, false, 0.02).q * Vec3::UnitZ();
    ++pictures;
  } while (angle_between(axis, scene.camera.eye() - tip) < HeldTool::kLeast && pictures < 100);
  EXPECT_LE(pictures, 25);
}

}  // namespace
}  // namespace burr::render
