#include "burr/render/camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace burr::render {
namespace {

using math::Vec3;

TEST(Camera, KeepsUpUpHoweverOneTurnsIt) {
  const unsigned seed = 20;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> turn(0, 1);
  Camera camera;
  for (int i = 0; i < 10'000; ++i) {
    orbit(camera, turn(random), turn(random));
    EXPECT_GT(camera.above().z(), 0) << "the world's up points down in the picture";
    EXPECT_NEAR(camera.right().z(), 0, 1e-12) << "the horizon is tilted";
    EXPECT_NEAR(camera.right().cross(camera.above()).dot(camera.backward()), 1, 1e-12);
  }
}

TEST(Camera, LooksFromTheFrontWithThePatientsLeftAtTheRight) {
  const Camera camera;
  EXPECT_TRUE(camera.backward().isApprox(Vec3(0, -1, 0)));  // LPS: -y is anterior
  EXPECT_TRUE(camera.right().isApprox(Vec3(1, 0, 0)));      // +x is the patient's left
}

TEST(Camera, FitsABoxIntoThePictureFromEverySide) {
  const unsigned seed = 21;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 500; ++i) {
    math::Aabb box;
    box.extend(0.1 * Vec3(uniform(random), uniform(random), uniform(random)));
    box.extend(0.1 * Vec3(uniform(random), uniform(random), uniform(random)));
    const double aspect = 0.3 + std::abs(uniform(random)) * 3;
    const Camera camera = fit(std::array{box}, 3 * uniform(random), 1.5 * uniform(random), aspect);
    const Eigen::Matrix4d m =
        clip_from_view(camera, aspect, 0.01 * camera.distance, 10) * view_from_world(camera);
    double widest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector4d c = m * box.corner(corner).homogeneous();
      widest = std::max({widest, std::abs(c.x() / c.w()), std::abs(c.y() / c.w())});
    }
    EXPECT_LE(widest, 1) << "sticks out";
    EXPECT_GE(widest, 0.8) << "smaller than need be";
  }
}

TEST(Camera, ARayGoesThroughThePixelThePointIsDrawnAt) {
  const unsigned seed = 22;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Camera camera;
  camera.target = {0.02, -0.01, 0.05};
  for (int i = 0; i < 200; ++i) {
    orbit(camera, uniform(random) - 0.5, uniform(random) - 0.5);
    const double x = uniform(random) * 640, y = uniform(random) * 480;
    const Ray ray = ray_through(camera, x, y, 640, 480);
    const Vec3 p = ray.origin + (0.1 + uniform(random)) * ray.direction;
    const Eigen::Vector4d c =
        clip_from_view(camera, 640.0 / 480, 0.01, 2) * view_from_world(camera) * p.homogeneous();
    EXPECT_NEAR((c.x() / c.w() + 1) * 320, x, 1e-6);
    EXPECT_NEAR((1 - c.y() / c.w()) * 240, y, 1e-6);
  }
}

TEST(Camera, APartOfThePictureIsThatPartOfIt) {
  const Camera camera;
  const Vec3 p_view(0.01, 0.02, -0.3);
  const auto clip = [&](const Window& part) {
    const Eigen::Vector4d c = clip_from_view(camera, 1.5, 0.01, 1, part) * p_view.homogeneous();
    return Eigen::Vector2d(c.head<2>() / c.w());
  };
  const Eigen::Vector2d whole = clip({}), part = clip({0, 0.5, -0.25, 0.75});
  EXPECT_NEAR(whole.x(), 0.25 + 0.25 * part.x(), 1e-12);
  EXPECT_NEAR(whole.y(), 0.25 + 0.5 * part.y(), 1e-12);
}

TEST(Camera, LooksAtTheWorkFromOutsideBesideTheShaft) {
  for (const Vec3& n :
       {Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0.6, 0.5, -0.62)}) {
    const Camera camera = view_of_work(Vec3(0.1, 0.2, 0.3), n, 0.05);
    EXPECT_TRUE(camera.target.isApprox(Vec3(0.1, 0.2, 0.3)));
    EXPECT_NEAR(camera.view_height(), 0.05, 1e-9);
    const double angle = std::acos(camera.backward().dot(n.normalized())) * 180 / std::numbers::pi;
    EXPECT_NEAR(angle, 32, 1) << "normal " << n.transpose();
  }
}

TEST(Camera, ZoomStaysWithinReach) {
  Camera camera;
  zoom(camera, 1e9);
  EXPECT_GE(camera.distance, 2e-3);
  zoom(camera, 1e-9);
  EXPECT_LE(camera.distance, 5);
}

}  // namespace
}  // namespace burr::render
