// What is skipped because other bone hides it: never anything that could be seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <thread>

#include "burr/phantom/build.h"
#include "burr/phantom/phantoms.h"
#include "burr/phantom/shapes.h"
#include "burr/render/bone_scene.h"
#include "burr/render/camera.h"
#include "burr/render/coarsening.h"
#include "burr/render/depth_tiles.h"
#include "burr/surface/mesher.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Aabb;
using math::Vec3;
constexpr double kMm = 1e-3;

// ---- the depth map alone

// Eye at the origin, looking along -z; near 1, far 10.
Eigen::Matrix4d perspective() {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = m(1, 1) = 1;
  m(2, 2) = -11.0 / 9;
  m(2, 3) = -20.0 / 9;
  m(3, 2) = -1;
  return m;
}
double depth_at(double z) { return 0.5 * (11.0 / 9 * -z - 20.0 / 9) / -z + 0.5; }

TEST(DepthTiles, HideWhatIsWhollyBehindAWall) {
  constexpr int kSize = 64;
  std::vector<float> depth(kSize * kSize, static_cast<float>(depth_at(-4)));
  DepthTiles tiles;
  tiles.look(depth.data(), {0, 0, kSize, kSize});
  const auto hidden = [&](const Aabb& box) { return tiles.hide(box, perspective(), kSize, kSize); };
  EXPECT_TRUE(hidden({{-1, -1, -6}, {1, 1, -5}}));
  EXPECT_TRUE(hidden({{-1, -1, -6}, {1, 1, -4.001}}));
  EXPECT_FALSE(hidden({{-1, -1, -6}, {1, 1, -3.999}})) << "a side of it stands before the wall";
  EXPECT_FALSE(hidden({{-1, -1, -3}, {1, 1, -2}}));
  EXPECT_FALSE(hidden({{-1, -1, -6}, {1, 1, 1}})) << "it is around the eye";
  EXPECT_FALSE(hidden({{-1, -1, -6}, {1, 1, -0.5}})) << "the near plane cuts it";
  depth[20 * kSize + 40] = 1;  // a hole of one sample, at x 0.27, y -0.36 of the window
  tiles.look(depth.data(), {0, 0, kSize, kSize});
  const double x = (40.5 / 32 - 1) * 5, y = (20.5 / 32 - 1) * 5;
  EXPECT_FALSE(hidden({{x - 0.01, y - 0.01, -5.02}, {x + 0.01, y + 0.01, -5}}));
  EXPECT_TRUE(hidden({{x - 2, y - 0.01, -5.02}, {x - 1.5, y + 0.01, -5}}));
}

TEST(DepthTiles, NeverHideAPointThatTheSamplesShow) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto from = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
  };
  int hidden = 0;
  for (int round = 0; round < 300; ++round) {
    // a window with some hills, of which only a part was redrawn
    const int wide = 40 + static_cast<int>(from(0, 60)), high = 40 + static_cast<int>(from(0, 60));
    const DepthTiles::Part part = {static_cast<int>(from(0, 20)), static_cast<int>(from(0, 20)),
                                   static_cast<int>(from(1, 20)), static_cast<int>(from(1, 20))};
    std::vector<float> depth(static_cast<std::size_t>(part.width * part.height));
    const double base = from(-8, -2), swing = from(0, 1.9);
    for (float& d : depth) d = static_cast<float>(depth_at(base + from(-swing, swing)));
    DepthTiles tiles;
    tiles.look(depth.data(), part);
    for (int n = 0; n < 40; ++n) {
      const Vec3 lo(from(-4, 4), from(-4, 4), from(-9, -1.5)),
          size(from(0, 2), from(0, 2), from(0, 2));
      const Aabb box = {lo, lo + size};
      if (!tiles.hide(box, perspective(), wide, high)) continue;
      ++hidden;
      for (int k = 0; k < 200; ++k) {
        const Vec3 p = lo + Vec3(from(0, 1), from(0, 1), from(0, 1)).cwiseProduct(size);
        const Eigen::Vector4d c = perspective() * p.homogeneous();
        const int x = static_cast<int>(std::floor((0.5 * c.x() / c.w() + 0.5) * wide)) - part.x0,
                  y = static_cast<int>(std::floor((0.5 * c.y() / c.w() + 0.5) * high)) - part.y0;
        if (x < 0 || y < 0 || x >= part.width || y >= part.height) continue;
        EXPECT_GT(0.5 * c.z() / c.w() + 0.5,
                  static_cast<double>(depth[static_cast<std::size_t>(y * part.width + x)]));
      }
    }
  }
  EXPECT_GT(hidden, 1000);
}

// ---- in pictures

// Whether a triangle of the scene is edge-on to the eye, narrower than the rasterizer's grid, at
// the middle of this pixel (y down). The depth and colour of such a triangle are arbitrary: its
// plane is steeper than single precision can follow.
class EdgeOn {
 public:
  EdgeOn(const Scene& scene, int width, int height)
      : view_(view_from_world(scene.camera)),
        per_unit_(0.5 * height / std::tan(0.5 * scene.camera.field_of_view)),
        middle_(0.5 * width, 0.5 * height) {
    for (const ScenePatch& patch : scene.patches)
      if (patch.mesh != nullptr)
        look_at(patch.mesh->vertices(), patch.mesh->index_count(),
                [&](std::size_t n) { return patch.mesh->index(n); });
    for (const SceneBlock& block : scene.blocks)
      if (block.mesh != nullptr)
        for (const CoarseLevel& level : block.mesh->levels)
          look_at(block.mesh->vertices, level.indices.size(),
                  [&](std::size_t n) { return level.indices[n]; });
  }
  [[nodiscard]] bool at(int x, int y) const {
    const Eigen::Vector2d p(x + 0.5, y + 0.5);
    return std::any_of(lines_.begin(), lines_.end(), [&](const Line& line) {
      const Eigen::Vector2d along = line.b - line.a;
      const double t = std::clamp((p - line.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (line.a + t * along - p).norm() < kGrid;
    });
  }

 private:
  static constexpr double kGrid = 1.0 / 128;  // OpenGL requires 1/16 of a pixel, llvmpipe has 1/256
  struct Line {
    Eigen::Vector2d a, b;  // [pixel]
  };

  template <class Index>
  void look_at(const std::vector<SkinVertex>& vertices, std::size_t count, Index index) {
    for (std::size_t t = 0; t + 2 < count; t += 3) {
      std::array<Eigen::Vector2d, 3> at;
      bool before = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = vertices[index(t + k)].p.template cast<double>();
        const Eigen::Vector4d v = view_ * p.homogeneous();
        before = before && v.z() < -1e-4;
        at[k] = middle_ + per_unit_ / -v.z() * Eigen::Vector2d(v.x(), -v.y());
      }
      if (!before) continue;
      std::size_t longest = 0;
      const auto side = [&](std::size_t k) { return (at[(k + 1) % 3] - at[k]).norm(); };
      for (std::size_t k = 1; k < 3; ++k)
        if (side(k) > side(longest)) longest = k;
      const Eigen::Vector2d &a = at[longest], &b = at[(longest + 1) % 3],
                            &c = at[(longest + 2) % 3], u = b - a, w = c - a;
      if (u.norm() > 0 && std::abs(u.x() * w.y() - u.y() * w.x()) < kGrid * u.norm())
        lines_.push_back({a, b});
    }
  }

  Eigen::Matrix4d view_;
  double per_unit_;  // pixels, at 1 m
  Eigen::Vector2d middle_;
  std::vector<Line> lines_;
};

// The picture without hidden parts must equal the whole one. The exception: a triangle that may be
// hidden can show through what is in front of it, in one of some ten million samples, and the user
// should not see that.
void expect_same(const Scene& scene, const Image& whole, const Image& seen) {
  ASSERT_EQ(whole.rgb.size(), seen.rgb.size());
  if (whole.rgb == seen.rgb) return;
  const EdgeOn edge_on(scene, whole.width, whole.height);
  int strays = 0;
  for (int y = 0; y < whole.height; ++y)
    for (int x = 0; x < whole.width; ++x) {
      const auto at = static_cast<std::ptrdiff_t>(y * whole.width + x) * 3;
      if (std::equal(whole.rgb.begin() + at, whole.rgb.begin() + at + 3, seen.rgb.begin() + at))
        continue;
      EXPECT_LE(++strays, 2);
      ASSERT_TRUE(edge_on.at(x, y)) << "bone is missing at " << x << ", " << y;
    }
}

// A ball like a sponge: through every hole other holes are seen.
Scene sponge() {
  NoProgress quiet;
  const double voxel = 0.25 * kMm;
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-16 * kMm), Vec3::Constant(16 * kMm), voxel), {},
      phantom::common(phantom::ball(15 * kMm), phantom::gyroid(7 * kMm)), 0, 2,
      phantom::kGyroidSteepness);
  Scene scene;
  EXPECT_TRUE(skin_bone(scene, *bone, 2, quiet).ok());
  scene.look.plain = true;
  scene.look.supersample = 1;
  return scene;
}

TEST(Visibility, LeavesOutHiddenBoneAndThePictureIsTheSameFromEverywhere) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = sponge();
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  long all = 0, some = 0;
  for (int view = 0; view < 200; ++view) {
    scene.camera = whole_view(scene, 2 * M_PI * any(random), M_PI * (any(random) - 0.5), 1.3);
    scene.camera.distance *= 0.15 + any(random);  // now and then from inside
    gpu.skip_hidden(false);
    const auto whole = gpu.image(scene, 260, 200);
    const int whole_patches = gpu.figures().patches_drawn;
    gpu.skip_hidden(true);
    const auto seen = gpu.image(scene, 260, 200);
    ASSERT_TRUE(whole.ok() && seen.ok());
    SCOPED_TRACE(view);
    ASSERT_NO_FATAL_FAILURE(expect_same(scene, *whole, *seen));
    if (view % 10 != 0) continue;  // once more: what was visible last time is visible now
    const auto again = gpu.image(scene, 260, 200);
    ASSERT_TRUE(again.ok());
    ASSERT_NO_FATAL_FAILURE(expect_same(scene, *whole, *again)) << "again";
    all += whole_patches;
    some += gpu.figures().patches_drawn;
  }
  std::printf("drawn in 20 views: %ld patches of %ld\n", some, all);
  if (gpu.gpu().find("llvmpipe") != std::string::npos) {
    EXPECT_LT(some, all * 9 / 10);
  }
}

// as in a window: the eye moves a little from picture to picture, and the bone changes
TEST(Visibility, HoldsWhileTheEyeMovesAndBoneIsTakenAway) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = sponge();
  gpu.resize_offscreen(260, 200);
  scene.camera = whole_view(scene, 0, 0.2, 1.3);
  scene.camera.distance *= 0.7;
  auto whole_gpu = Renderer::offscreen();
  ASSERT_TRUE(whole_gpu.ok());
  (*whole_gpu)->resize_offscreen(260, 200);
  (*whole_gpu)->skip_hidden(false);
  for (int n = 0; n < 60; ++n) {
    if (n % 3 != 0) orbit(scene.camera, 0.07, 0.01);
    if (n % 5 == 0 && !scene.patches.empty())  // a patch removed, from the front on
      for (std::size_t p = 0; p < scene.patches.size(); ++p)
        if (scene.patches[p].mesh != nullptr && (p * 7 + static_cast<std::size_t>(n)) % 40 == 0)
          set_patch(scene, static_cast<int>(p), surface::Patch{});
    ASSERT_TRUE(gpu.show(scene).ok());
    const Image seen = gpu.shown();
    ASSERT_TRUE((*whole_gpu)->show(scene).ok());
    ASSERT_NO_FATAL_FAILURE(expect_same(scene, (*whole_gpu)->shown(), seen)) << "picture " << n;
  }
}

// All bones, whole and as a window on a slow machine draws them: in coarse blocks.
class VisibilityOf : public testing::TestWithParam<std::string> {};

TEST_P(VisibilityOf, NoViewLacksWhatCouldBeSeen) {
  BURR_NEEDS_GPU(gpu);
  BURR_NEEDS_GPU(whole_gpu);
  NoProgress quiet;
  const double coarser = GetParam() == "skull" ? 3 : 2;  // the largest one
  const auto bone =
      phantom::phantom(GetParam(), coarser * phantom::default_voxel_mm(GetParam()), quiet);
  ASSERT_TRUE(bone.ok()) << bone.error().text;
  Scene scene;
  ASSERT_TRUE(skin_bone(scene, **bone, 2, quiet).ok());
  scene.look.plain = true;
  scene.look.supersample = 1;
  scene.quality.refine = false;
  Coarsening coarse(surface::Mesher(**bone).patches(), (*bone)->grid().voxel);
  for (int n = 0; n < 60'000 && (n < 2 || coarse.waiting() > 0); ++n) {
    coarse.update(scene, n);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  coarse.update(scene, 1e6);

  constexpr int kWide = 260, kHigh = 200;
  for (Renderer* one : {&gpu, &whole_gpu}) one->resize_offscreen(kWide, kHigh);
  whole_gpu.skip_hidden(false);
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  long all = 0, some = 0;
  for (int view = 0; view < 200; ++view) {
    scene.camera = whole_view(scene, 2 * M_PI * any(random), M_PI * (any(random) - 0.5), 1.3);
    scene.camera.distance *= 0.05 + 1.1 * any(random);
    scene.quality.coarse_px = view % 2 == 0 ? 0 : 3;
    ASSERT_TRUE(gpu.show(scene).ok() && whole_gpu.show(scene).ok());
    ASSERT_NO_FATAL_FAILURE(expect_same(scene, whole_gpu.shown(), gpu.shown())) << "view " << view;
    all += whole_gpu.figures().triangles_drawn;
    some += gpu.figures().triangles_drawn;
  }
  std::printf("drawn in 200 views: %ld triangles of %ld\n", some, all);
  if (gpu.gpu().find("llvmpipe") != std::string::npos) {
    EXPECT_LT(some, all);
  }
}

std::vector<std::string> all_phantoms() {
  std::vector<std::string> names;
  for (const std::string_view name : phantom::phantom_names()) names.emplace_back(name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Bones, VisibilityOf, testing::ValuesIn(all_phantoms()),
                         [](const auto& bone) {
                           std::string name = bone.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace burr::render
