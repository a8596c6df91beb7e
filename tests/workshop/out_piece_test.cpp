// A piece of bone that was out of the bone at a moment of a recording is drawn where it was then, and nowhere else.
#include "burr/workshop/out_piece.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "burr/render/bone_scene.h"
#include "burr/render/camera.h"
#include "burr/render/look.h"
#include "burr/workshop/piece_look.h"
#include "render/gpu.h"
#include "sim/lifted.h"
#include "support/folder.h"

namespace burr::workshop {
namespace {

using math::Pose;
using math::Vec3;
constexpr double kMm = 1e-3;
constexpr int kWide = 480, kHigh = 360;

bool is_blue(const std::uint8_t* rgb) {
  return int{rgb[2]} > rgb[0] + 40 && int{rgb[2]} > rgb[1] + 5;
}

// A box of pixels; empty: low > high.
struct Pixels {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  int count = 0;
  void add(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
    ++count;
  }
};

Pixels blue(const render::Image& image) {
  Pixels all;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (is_blue(&image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)]))
        all.add(x + 0.5, y + 0.5);
  return all;
}

Eigen::Vector2d pixel_of(const render::Camera& camera, const Vec3& p) {
  const Eigen::Vector4d clip =
      render::clip_from_view(camera, static_cast<double>(kWide) / kHigh, 1e-3, 10) *
      render::view_from_world(camera) * p.homogeneous();
  return {0.5 * (clip.x() / clip.w() + 1) * kWide, 0.5 * (1 - clip.y() / clip.w()) * kHigh};
}

// The corners of the part, at a pose of its body. centre: of the body where it came free
Pixels corners(const render::Camera& camera, const Pose& body, const Vec3& centre) {
  Pixels all;
  for (int c = 0; c < 8; ++c) {
    const Vec3 sign((c & 1) != 0 ? 1 : -1, (c & 2) != 0 ? 1 : -1, (c & 4) != 0 ? 1 : -1);
    const Vec3 free = sim::test::kPartAt + sim::test::kPart.cwiseProduct(sign);
    const Eigen::Vector2d at = pixel_of(camera, body.p + body.q * Vec3(free - centre));
    all.add(at.x(), at.y());
  }
  return all;
}

TEST(OutPiece, IsDrawnWhereItWas) {
  BURR_NEEDS_GPU(gpu);
  const test::Folder folder;
  const std::string path = (folder.path() / "lifted.mcap").string();
  const sim::test::Lifted truth = sim::test::record_lifted(path);
  if (HasFailure()) return;
  auto player = record::Player::open(path);
  ASSERT_TRUE(player.ok());
  auto bone = (*player)->embedded_bone();
  ASSERT_TRUE(bone.ok());
  NoProgress quiet;
  OutPieces pieces(**player);
  PieceLook look;
  const auto picture = [&](double t, render::Camera& camera) {
    EXPECT_TRUE((*player)->bone_at(t, **bone).ok());
    const std::uint64_t there = (*bone)->content_hash();
    const auto row = (*player)->tick_at(t);
    EXPECT_TRUE(row.ok());
    render::Scene scene;
    scene.look = render::still_look();
    scene.look.background_top = scene.look.background_bottom = {0.1F, 0.1F, 0.1F};
    scene.camera.target = Vec3(3, 0, 6) * kMm;
    scene.camera.elevation = 0.2;
    scene.camera.distance = 0.1;
    EXPECT_TRUE(render::skin_bone(scene, **bone, 2, quiet).ok());
    const std::size_t softs = scene.soft.size();
    const auto piece = pieces.at(*row, t, **bone);
    EXPECT_TRUE(piece.ok());
    EXPECT_EQ((*bone)->content_hash(), there) << "the bone is that of the moment again";
    look.put(scene, piece->mesh, piece->by, (*bone)->tissues().tissues.size());
    camera = scene.camera;
    auto fresh =
        render::Renderer::offscreen();  // one that was used knows the patches of the scene before
    EXPECT_TRUE(fresh.ok());
    const auto image = (*fresh)->image(scene, kWide, kHigh);
    EXPECT_TRUE(image.ok());
    look.take_away(scene);
    EXPECT_EQ(scene.soft.size(), softs);
    return *image;
  };
  render::Camera camera;
  const auto colour_at = [&camera](const render::Image& image, const Vec3& p) {
    const Eigen::Vector2d at = pixel_of(camera, p);
    return &image.rgb[3 * (static_cast<std::size_t>(at.y()) * image.width +
                           static_cast<std::size_t>(at.x()))];
  };
  // the part's front face, in the middle, where it came free
  const Vec3 front = sim::test::kPartAt - Vec3(0, sim::test::kPart.y(), 0);
  const render::Image before = picture(truth.before, camera);
  EXPECT_EQ(blue(before).count, 0);
  EXPECT_GT(int{colour_at(before, front)[0]}, 80) << "bone";
  // the second one first: the first is then found on the way
  for (const int n : {1, 0}) {
    const render::Image image = picture(truth.out[n], camera);
    const Pixels is = blue(image), should = corners(camera, truth.at[n], truth.part);
    ASSERT_GT(is.count, 500) << n;
    EXPECT_NEAR(is.left, should.left, 3) << n;
    EXPECT_NEAR(is.right, should.right, 3) << n;
    EXPECT_NEAR(is.top, should.top, 3) << n;
    EXPECT_NEAR(is.bottom, should.bottom, 3) << n;
    EXPECT_LT(int{colour_at(image, front)[0]}, 60) << "nothing is at its old place";
  }
  EXPECT_EQ(blue(picture(truth.lies, camera)).count, 0) << "it is bone";
}

}  // namespace
}  // namespace burr::workshop
