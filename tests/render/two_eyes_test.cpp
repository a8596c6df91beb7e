// A window for two eyes, compared with the same pictures made one by one, as `burr picture` makes
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "burr/render/stereo.h"
#include "render/formula_surfaces.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

constexpr Stereo kJoined[] = {Stereo::side_by_side, Stereo::anaglyph, Stereo::interleaved};

Scene bone() {
  Scene scene;
  scene.tissue_colours = {{1, 1, 1}, {0.9F, 0.85F, 0.7F}, {0.9F, 0.4F, 0.3F}};
  const auto parts = test::cut(test::bumpy(0.03, 60), 3);
  for (std::size_t n = 0; n < parts.size(); ++n) set_patch(scene, static_cast<int>(n), parts[n]);
  scene.camera.distance = 0.16;
  scene.camera.azimuth = 0.3;
  scene.burr.visible = true;
  scene.burr.world_from_tool.p = {0, -0.035, 0};
  return scene;
}

double eye_distance(const Scene& scene) { return kComfortable * scene.camera.distance; }

TwoEyes eyes(const Scene& scene, Stereo how) {
  TwoEyes two;
  two.how = how;
  two.eye_distance = eye_distance(scene);
  return two;
}

Image one_by_one(Renderer& renderer, Scene scene, Stereo how, int width, int height) {
  const Eyes both = eyes_of(scene.camera, eye_distance(scene));
  scene.camera = both.left;
  const auto left = renderer.image(scene, width, height);
  scene.camera = both.right;
  const auto right = renderer.image(scene, width, height);
  EXPECT_TRUE(left && right);
  return join_eyes(*left, *right, how);
}

// the largest difference of a colour; joining on the GPU rounds differently from the processor
int worst(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) return 255;
  int most = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    most = std::max(most, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
  return most;
}

TEST(TwoEyes, TheWindowIsWhatIsMadeOneByOne) {
  BURR_NEEDS_GPU(gpu);
  auto other = Renderer::offscreen();
  ASSERT_TRUE(other);
  const Scene scene = bone();
  for (const auto& [wide, high] : {std::pair{640, 360}, {301, 203}}) {
    gpu.resize_offscreen(wide, high);
    for (const Stereo how : kJoined) {
      ASSERT_TRUE(gpu.show(scene, eyes(scene, how)));
      EXPECT_LE(worst(gpu.shown(), one_by_one(**other, scene, how, wide, high)), 1)
          << static_cast<int>(how) << " at " << wide;
    }
    ASSERT_TRUE(gpu.show(scene));
    const auto plain = (*other)->image(scene, wide, high);
    ASSERT_TRUE(plain);
    EXPECT_EQ(gpu.shown().rgb, plain->rgb) << "and one eye again";
  }
}

// The kept picture of one eye is never used for the other: bone, tool, look and size change while
// both rest.
TEST(TwoEyes, EachHoldsItsOwnPictureWhileOneMills) {
  BURR_NEEDS_GPU(gpu);
  auto other = Renderer::offscreen();
  ASSERT_TRUE(other);
  gpu.resize_offscreen(480, 320);
  Scene scene = bone();
  int wide = 480, high = 320;
  std::vector<Stereo> kinds = {Stereo::anaglyph, Stereo::anaglyph,     Stereo::anaglyph,
                               Stereo::off,      Stereo::side_by_side, Stereo::side_by_side,
                               Stereo::anaglyph, Stereo::interleaved,  Stereo::interleaved};
  for (std::size_t n = 0; n < kinds.size(); ++n) {
    // another bump in one patch, the tool at another place
    auto parts = test::cut(test::bumpy(0.03 - 0.0004 * static_cast<double>(n), 60), 3);
    const std::size_t which = 4 + n % 3;
    set_patch(scene, static_cast<int>(which), parts[which]);
    scene.burr.world_from_tool.p.x() = 0.002 * static_cast<double>(n) - 0.006;
    if (n == 5) scene.look.opacity = 0.4F;
    if (n == 8) gpu.resize_offscreen(wide = 350, high = 250);
    ASSERT_TRUE(gpu.show(scene, eyes(scene, kinds[n])));
    if (n > 0 && kinds[n] == kinds[n - 1] && n != 5 && n != 8) {
      EXPECT_LT(gpu.figures().redrawn, 0.9) << n << ": all of it was drawn anew";
    }
    const Image wanted = kinds[n] == Stereo::off ? *(*other)->image(scene, wide, high)
                                                 : one_by_one(**other, scene, kinds[n], wide, high);
    EXPECT_LE(worst(gpu.shown(), wanted), 1) << "picture " << n;
  }
}

TEST(TwoEyes, AreNotSwappedUnlessAskedFor) {
  BURR_NEEDS_GPU(gpu);
  gpu.resize_offscreen(400, 200);
  // a ball nearer than the target: the right eye sees it farther to the left
  Scene scene;
  scene.look.background_top = scene.look.background_bottom = {0, 0, 0};
  scene.tissue_colours = {{1, 1, 1}, {1, 1, 1}};
  scene.camera.distance = 0.3;
  set_patch(scene, 0, test::ball(0.15 * scene.camera.backward(), 0.005, 20));
  const auto middle = [](const Image& image, int x0, int x1, std::size_t channel) {
    double sum = 0, count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = x0; x < x1; ++x)
        if (image.rgb[static_cast<std::size_t>(3 * (y * image.width + x)) + channel] > 60) {
          sum += x + 0.5 - x0;
          ++count;
        }
    return sum / count;
  };
  TwoEyes two = eyes(scene, Stereo::side_by_side);
  ASSERT_TRUE(gpu.show(scene, two));
  const Image plain = gpu.shown();
  // the eyes' distance is 1/30 of 0.3 m: 10 mm, and 200 pixels lie on 0.1532 m
  const double wanted = 10e-3 * (0.3 - 0.15) / 0.15 * 200 / scene.camera.view_height() / 2;
  EXPECT_NEAR(middle(plain, 0, 200, 0) - middle(plain, 200, 400, 0), wanted, 0.4);
  two.swapped = true;
  ASSERT_TRUE(gpu.show(scene, two));
  const Image swapped = gpu.shown();
  EXPECT_NEAR(middle(swapped, 0, 200, 0) - middle(swapped, 200, 400, 0), -wanted, 0.4);
  two = eyes(scene, Stereo::anaglyph);
  ASSERT_TRUE(gpu.show(scene, two));
  EXPECT_NEAR(middle(gpu.shown(), 0, 400, 0) - middle(gpu.shown(), 0, 400, 1), 2 * wanted, 0.8)
      << "red is the left eye's";
}

TEST(TwoEyes, LinesBelongToTheScreenNotToTheWindow) {
  BURR_NEEDS_GPU(gpu);
  auto other = Renderer::offscreen();
  ASSERT_TRUE(other);
  gpu.resize_offscreen(200, 120);
  const Scene scene = bone();
  TwoEyes two = eyes(scene, Stereo::interleaved);
  two.first_row = 7;
  ASSERT_TRUE(gpu.show(scene, two));
  const Image odd = gpu.shown();
  two.swapped = true;
  two.first_row = 4;
  ASSERT_TRUE(gpu.show(scene, two));
  EXPECT_EQ(gpu.shown().rgb, odd.rgb) << "a row lower is the same as the other eye first";
  two.swapped = false;
  ASSERT_TRUE(gpu.show(scene, two));
  EXPECT_LE(worst(gpu.shown(), one_by_one(**other, scene, Stereo::interleaved, 200, 120)), 1);
}

TEST(TwoEyes, WhatLiesOverThePictureIsDrawnForBoth) {
  BURR_NEEDS_GPU(gpu);
  const Scene scene = bone();
  int drawn = 0;
  const auto over = [&drawn] { ++drawn; };
  ASSERT_TRUE(gpu.show(scene, eyes(scene, Stereo::side_by_side), over));
  EXPECT_EQ(drawn, 2);
  ASSERT_TRUE(gpu.show(scene, eyes(scene, Stereo::quad_buffer), over));
  EXPECT_EQ(drawn, 3) << "no picture for each eye here: one";
  EXPECT_FALSE(gpu.quad_buffer());
}

TEST(TwoEyes, AreBothCounted) {
  BURR_NEEDS_GPU(gpu);
  const Scene scene = bone();
  gpu.skip_hidden(false);
  ASSERT_TRUE(gpu.show(scene));
  const long one = gpu.figures().triangles_drawn;
  ASSERT_TRUE(gpu.show(scene, eyes(scene, Stereo::anaglyph)));
  EXPECT_NEAR(static_cast<double>(gpu.figures().triangles_drawn), 2.0 * static_cast<double>(one),
              0.1 * static_cast<double>(one));
  EXPECT_GT(gpu.figures().redrawn, 0.5);
}

}  // namespace
}  // namespace burr::render
