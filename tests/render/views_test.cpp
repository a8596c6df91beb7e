// Section, two eyes, and the view through a tube, compared with geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <utility>

#include "burr/render/pick.h"
#include "burr/render/stereo.h"
#include "render/formula_surfaces.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr int kWide = 600, kHigh = 400;

// the position of a point in the picture [pixel]
Eigen::Vector2d seen(const Camera& camera, const Vec3& p) {
  const Eigen::Vector4d c = clip_from_view(camera, double{kWide} / kHigh, 0.01, 1) *
                            view_from_world(camera) * p.homogeneous();
  return {kWide * (0.5 + 0.5 * c.x() / c.w()), kHigh * (0.5 - 0.5 * c.y() / c.w())};
}

TEST(Stereo, EyesAgreeOnTheTargetsPlaneAndPartBeforeAndBehind) {
  Camera middle;
  middle.azimuth = 0.7;
  middle.elevation = 0.3;
  middle.target = {0.01, 0.02, 0.03};
  const double eye_distance = 8e-3;
  const Eyes eyes = eyes_of(middle, eye_distance);
  EXPECT_NEAR((eyes.right.eye() - eyes.left.eye()).norm(), eye_distance, 1e-12);
  for (const double right : {-0.02, 0.0, 0.03})
    for (const double deeper : {-0.05, 0.0, 0.08}) {
      const Vec3 p = middle.target + right * middle.right() - deeper * middle.backward() +
                     0.01 * middle.above();
      const Eigen::Vector2d l = seen(eyes.left, p), r = seen(eyes.right, p), m = seen(middle, p);
      EXPECT_NEAR(l.y(), r.y(), 1e-9) << "one eye higher than the other hurts";
      // similar triangles: behind the target the right eye sees it farther to the right
      const double pixel = kHigh / middle.view_height();
      EXPECT_NEAR(r.x() - l.x(), pixel * eye_distance * deeper / (middle.distance + deeper), 1e-6);
      EXPECT_NEAR(0.5 * (l.x() + r.x()), m.x(), 1e-6);
      // and the mouse ray goes there
      const Ray ray = ray_through(eyes.left, l.x(), l.y(), kWide, kHigh);
      EXPECT_LT((p - ray.origin).cross(ray.direction).norm(), 1e-9);
    }
}

Image of(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image{width, height, {}};
  for (int n = 0; n < width * height; ++n) image.rgb.insert(image.rgb.end(), {r, g, b});
  return image;
}

TEST(Stereo, JoinsAsAskedFor) {
  const Image left = of(8, 4, 200, 0, 0), right = of(8, 4, 0, 100, 0);
  const auto at = [](const Image& image, int x, int y, int c) {
    return int{image.rgb[static_cast<std::size_t>(3 * (y * image.width + x) + c)]};
  };
  EXPECT_EQ(join_eyes(left, right, Stereo::off).rgb, left.rgb);
  const Image pair = join_eyes(left, right, Stereo::side_by_side);
  EXPECT_EQ(at(pair, 3, 2, 0), 200);
  EXPECT_EQ(at(pair, 4, 2, 0), 0);
  EXPECT_EQ(at(pair, 4, 2, 1), 100);
  const Image rows = join_eyes(left, right, Stereo::interleaved);
  EXPECT_EQ(at(rows, 5, 2, 0), 200);
  EXPECT_EQ(at(rows, 5, 3, 1), 100);
  const Image ana = join_eyes(left, right, Stereo::anaglyph);
  EXPECT_NEAR(at(ana, 1, 1, 0), 0.299 * 200, 1);
  EXPECT_NEAR(at(ana, 1, 1, 1), 0.587 * 100, 1);
  EXPECT_EQ(at(ana, 1, 1, 1), at(ana, 1, 1, 2));
  // an odd width loses nothing
  EXPECT_EQ(join_eyes(of(7, 3, 1, 2, 3), of(7, 3, 4, 5, 6), Stereo::side_by_side).rgb.size(), 63U);
}

TEST(Endoscope, LooksAheadFromItsTip) {
  const Vec3 tip = {0.01, -0.02, 0.03};
  for (const Vec3& ahead : {Vec3(1, 2, -0.5), Vec3(-3, 0.1, 1), Vec3(0, 0, -1), Vec3(0, 0, 1)}) {
    const Camera camera = endoscope_view(tip, ahead);
    EXPECT_LT((camera.eye() - tip).norm(), 1e-12);
    EXPECT_GT((-camera.backward()).dot(ahead.normalized()), std::cos(0.02));
    EXPECT_GT(camera.field_of_view, 1.5);
  }
  EXPECT_TRUE(endoscope_view(tip, Vec3::Zero()).eye().allFinite());
}

Scene ball_scene(double radius) {
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, {0.6F, 0.6F, 0.6F}};
  set_patch(scene, 0, test::ball(Vec3::Zero(), radius, 120));
  scene.camera.distance = 0.2;
  scene.look.plain = true;
  scene.look.background_top = scene.look.background_bottom = {0, 0, 1};
  return scene;
}

TEST(Clip, ClosesTheSectionWithAFlatFace) {
  BURR_NEEDS_GPU(gpu);
  const double radius = 0.03, off = 0.01;
  Scene scene = ball_scene(radius);
  // the eye is at -y: everything nearer to it than `off` in front of the middle is removed
  scene.clip = ClipPlane{Vec3(0, -off, 0), Vec3(0, -1, 0)};
  const auto image = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(image.ok()) << image.error().text;
  const double per_m = kHigh / (2 * std::tan(scene.camera.field_of_view / 2));
  const double section =
      per_m * std::sqrt(radius * radius - off * off) / (scene.camera.distance - off);
  const int middle = 3 * (kHigh / 2 * kWide + kWide / 2);
  int worst = 0, background = 0;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      const double r = std::hypot(x + 0.5 - kWide / 2.0, y + 0.5 - kHigh / 2.0);
      if (r > section - 2) continue;
      const auto at = static_cast<std::size_t>(3 * (y * kWide + x));
      background += image->rgb[at + 2] > 250 && image->rgb[at] < 5;
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(int{image->rgb[at + c]} -
                                         int{image->rgb[static_cast<std::size_t>(middle) + c]}));
    }
  EXPECT_EQ(background, 0);
  EXPECT_LE(worst, 2) << "flat: one brightness all over";
  // nothing of the half in front of it: the outline is that of what is behind the plane
  scene.clip = ClipPlane{Vec3(0, -off, 0), Vec3(0, 1, 0)};
  const auto cap = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(cap.ok());
  long drawn = 0;
  for (std::size_t i = 0; i < cap->rgb.size(); i += 3) drawn += cap->rgb[i + 2] < 250;
  const double outline = per_m * radius / std::sqrt(0.2 * 0.2 - radius * radius);
  // The outline of a cap is that of the sphere as long as the plane lies behind the horizon, which
  // is r^2 / d = 4.5 mm in front of the middle here; at 10 mm it is the edge of the section.
  EXPECT_LT(static_cast<double>(drawn), 0.99 * std::numbers::pi * outline * outline);
  EXPECT_NEAR(static_cast<double>(drawn), std::numbers::pi * section * section,
              0.02 * std::numbers::pi * section * section);
  // the mouse does not hit what was removed
  const Ray ray = ray_through(scene.camera, kWide / 2.0, kHigh / 2.0, kWide, kHigh);
  scene.clip.reset();
  const auto front = pick(scene, ray);
  ASSERT_TRUE(front);
  EXPECT_NEAR(front->p.y(), -radius, 1e-4);
  scene.clip = ClipPlane{Vec3(0, -off, 0), Vec3(0, -1, 0)};
  EXPECT_FALSE(pick(scene, ray));
}

TEST(Clip, AWindowShowsItAtOnceAndLetsItGoAgain) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(0.03);
  gpu.resize_offscreen(kWide, kHigh);
  ASSERT_TRUE(gpu.show(scene).ok());
  const Image whole = gpu.shown();
  scene.clip = ClipPlane{};
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_NE(gpu.shown().rgb, whole.rgb);
  scene.clip.reset();
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(gpu.shown().rgb, whole.rgb);
}

TEST(Round, OnlyACircleIsSeen) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(0.03);
  scene.round = true;
  const auto image = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(image.ok());
  long beside = 0, dark = 0;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      const double r = std::hypot(x + 0.5 - kWide / 2.0, y + 0.5 - kHigh / 2.0);
      const auto at = static_cast<std::size_t>(3 * (y * kWide + x));
      const bool black = image->rgb[at] == 0 && image->rgb[at + 1] == 0 && image->rgb[at + 2] == 0;
      if (r > kHigh / 2.0 + 1) beside += !black;
      if (r < kHigh / 2.0 - 3) dark += black;
    }
  EXPECT_EQ(beside, 0);
  EXPECT_EQ(dark, 0);
}

// An even white face shows every step: each pixel has its own shade.
TEST(Vignette, DarkensTheCornersWithoutStripes) {
  BURR_NEEDS_GPU(gpu);
  Scene scene;
  scene.look.background_top = scene.look.background_bottom = {1, 1, 1};
  scene.vignette = 0.8;
  const auto image = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(image.ok()) << image.error().text;
  const double from = 0.45 * kHigh, to = 0.5 * std::hypot(kWide, kHigh);
  double most = 0;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      const double r = std::hypot(x + 0.5 - kWide / 2.0, y + 0.5 - kHigh / 2.0);
      const double part = std::clamp((r - from) / (to - from), 0.0, 1.0);
      const double wanted = 255 * (1 - 0.8 * part * part * (3 - 2 * part));
      const auto at = static_cast<std::size_t>(3 * (y * kWide + x));
      most = std::max(most, std::abs(image->rgb[at] - wanted));
    }
  EXPECT_LE(most, 1.0);
}

TEST(Inset, LiesWhereItIsPutAndIsSentAgainWhenItChanges) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(0.03);
  gpu.resize_offscreen(kWide, kHigh);
  const auto inset = [](std::uint8_t r, std::uint8_t g) {
    Image image{2, 2, {}};  // the top row red, the bottom row green
    for (int n = 0; n < 4; ++n) {
      image.rgb.insert(image.rgb.end(),
                       {n < 2 ? r : std::uint8_t{0}, n < 2 ? std::uint8_t{0} : g, 0});
    }
    return std::make_shared<const Image>(std::move(image));
  };
  scene.insets.push_back({inset(250, 200), 100, 50, 40, 60});
  const auto look = [&](const Image& image, int x, int y) {
    const auto at = static_cast<std::size_t>(3 * (y * kWide + x));
    return std::array<int, 3>{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
  };
  const auto still = gpu.image(scene, kWide, kHigh, 128);  // in tiles
  ASSERT_TRUE(still.ok());
  ASSERT_TRUE(gpu.show(scene).ok());
  for (const Image& image : {*still, gpu.shown()}) {
    for (const int x : {101, 120, 138}) {
      EXPECT_EQ(look(image, x, 52), (std::array<int, 3>{250, 0, 0}));
      EXPECT_EQ(look(image, x, 108), (std::array<int, 3>{0, 200, 0}));
    }
    EXPECT_EQ(look(image, 97, 60), (std::array<int, 3>{0, 0, 255})) << "beside it the picture";
    EXPECT_EQ(look(image, 120, 115), (std::array<int, 3>{0, 0, 255}));
  }
  scene.insets[0].image = inset(100, 50);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(look(gpu.shown(), 120, 52), (std::array<int, 3>{100, 0, 0}));
  scene.insets.clear();
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(look(gpu.shown(), 120, 52), (std::array<int, 3>{0, 0, 255}));
}

}  // namespace
}  // namespace burr::render
