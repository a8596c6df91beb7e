// Transparent bone, compared with the colours that it must have.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "burr/render/bone_scene.h"
#include "burr/volume/bone.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr int kWide = 320, kHigh = 240;
constexpr double kVoxel = 0.5e-3;
constexpr int kSize = 48;  // voxels along a side; bone from 4 to 44
constexpr Colour kNerve = {0.9F, 0.8F, 0.1F}, kVessel = {0.2F, 0.2F, 0.8F};
constexpr Colour kBone = {0.8F, 0.8F, 0.8F}, kBehind = {0.0F, 0.5F, 0.0F};

// A block with a nerve along x, 5 mm below its top, and a vessel along y, 12 mm below it. Seen from
// the top, +z.
std::unique_ptr<volume::Bone> block() {
  const auto count = static_cast<std::size_t>(kSize * kSize * kSize);
  std::vector<volume::Field> field(count);
  std::vector<volume::TissueId> tissue(count);
  volume::Grid grid;
  grid.size = math::Ijk::Constant(kSize);
  grid.voxel = kVoxel;
  volume::TissueTable tissues;
  tissues.tissues[1].colour = kBone;
  tissues.tissues.push_back({.name = "nerve", .kind = volume::TissueKind::soft, .colour = kNerve});
  tissues.tissues.push_back(
      {.name = "vessel", .kind = volume::TissueKind::soft, .colour = kVessel});
  constexpr double kMiddle = 0.5 * (kSize - 1), kHalf = 20, kTube = 4;
  std::size_t at = 0;
  for (int k = 0; k < kSize; ++k)
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i, ++at) {
        const Vec3 p = Vec3(i, j, k) - Vec3::Constant(kMiddle);
        const double box = kHalf - p.cwiseAbs().maxCoeff();
        const double nerve = std::hypot(p.y(), p.z() - 10) - kTube,
                     vessel = std::hypot(p.x(), p.z() + 4) - kTube;
        field[at] = volume::field_from_depth(std::min({box, nerve, vessel}));
        tissue[at] = box < 0      ? volume::TissueId{0}
                     : nerve < 0  ? volume::TissueId{2}
                     : vessel < 0 ? volume::TissueId{3}
                                  : volume::TissueId{1};
      }
  return volume::bone_from_arrays(grid, tissues, field, tissue, {}, 0);
}

Scene seen_from_top() {
  NoProgress quiet;
  const auto bone = block();
  Scene scene;
  EXPECT_TRUE(skin_bone(scene, *bone, 2, quiet).ok());
  scene.camera.target = bounds(scene).centre();
  scene.camera.elevation = 1.5707;
  scene.camera.distance = 0.08;
  scene.look.plain = true;
  scene.look.background_top = scene.look.background_bottom = kBehind;
  return scene;
}

using Rgb = std::array<int, 3>;
Rgb at(const Image& image, int x, int y) {
  const auto from = static_cast<std::size_t>(3 * (y * image.width + x));
  return {image.rgb[from], image.rgb[from + 1], image.rgb[from + 2]};
}
// the position of a point of the world in the picture
std::array<int, 2> place(const Scene& scene, const Vec3& p) {
  const Eigen::Vector4d c = clip_from_view(scene.camera, double{kWide} / kHigh, 0.01, 1) *
                            view_from_world(scene.camera) * p.homogeneous();
  return {static_cast<int>(kWide * (0.5 + 0.5 * c.x() / c.w())),
          static_cast<int>(kHigh * (0.5 - 0.5 * c.y() / c.w()))};
}
void expect_mixed(const Rgb& is, const Colour& front, const Colour& behind, double opacity,
                  const char* what) {
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(is[c],
                255 * (opacity * static_cast<double>(front[c]) +
                       (1 - opacity) * static_cast<double>(behind[c])),
                6)
        << what << ", channel " << c;
}

TEST(SeeThrough, ShowsEachStructureByTheShareThatBoneLetsThrough) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = seen_from_top();
  // in the middle the nerve lies over the vessel; the other points are beside it
  const Vec3 middle = scene.camera.target;
  const auto both = place(scene, middle + Vec3(0, 0, 7e-3)),
             nerve = place(scene, middle + Vec3(6e-3, 0, 7e-3)),
             vessel = place(scene, middle + Vec3(0, 6e-3, 0)),
             bone = place(scene, middle + Vec3(5.5e-3, 5.5e-3, 10e-3));
  for (const double opacity : {0.7, 0.4, 0.1, 0.0}) {
    SCOPED_TRACE(opacity);
    scene.look.opacity = opacity;
    const auto image = gpu.image(scene, kWide, kHigh);
    ASSERT_TRUE(image.ok()) << image.error().text;
    expect_mixed(at(*image, nerve[0], nerve[1]), kBone, kNerve, opacity, "nerve");
    expect_mixed(at(*image, vessel[0], vessel[1]), kBone, kVessel, opacity, "vessel");
    expect_mixed(at(*image, both[0], both[1]), kBone, kNerve, opacity, "nerve over vessel");
    expect_mixed(at(*image, bone[0], bone[1]), kBone, kBehind, opacity, "nothing behind");
  }
}

// A thin nerve that bends in a wide canal, which the walls of the canal do not show.
std::unique_ptr<volume::Bone> bent_nerve(double radius) {
  const auto count = static_cast<std::size_t>(kSize * kSize * kSize);
  std::vector<volume::Field> field(count);
  std::vector<volume::TissueId> tissue(count);
  volume::Grid grid;
  grid.size = math::Ijk::Constant(kSize);
  grid.voxel = kVoxel;
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "nerve", .kind = volume::TissueKind::soft, .colour = kNerve});
  std::size_t at = 0;
  for (int k = 0; k < kSize; ++k)
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i, ++at) {
        const Vec3 p = Vec3(i, j, k) - Vec3::Constant(0.5 * (kSize - 1));
        // a part of a ring, tilted
        const Vec3 q(p.x(), p.y() + 12, p.z() + 0.3 * p.x());
        const double off = std::hypot(std::hypot(q.x(), q.y()) - 20, q.z());
        const double box = 20 - p.cwiseAbs().maxCoeff();
        field[at] = volume::field_from_depth(std::min(box, off - radius - 3));
        tissue[at] = box < 0        ? volume::TissueId{0}
                     : off < radius ? volume::TissueId{2}
                                    : volume::TissueId{1};
      }
  return volume::bone_from_arrays(grid, tissues, field, tissue, {}, 0);
}

// The connected parts of what is set, and of what is not.
int parts_of(std::vector<bool> set, bool of) {
  int parts = 0;
  std::vector<std::size_t> todo;
  for (std::size_t n = 0; n < set.size(); ++n) {
    if (set[n] != of) continue;
    ++parts;
    todo.push_back(n);
    while (!todo.empty()) {
      const std::size_t m = todo.back();
      todo.pop_back();
      if (set[m] != of) continue;
      set[m] = !of;
      if (m % kWide > 0) todo.push_back(m - 1);
      if (m % kWide + 1 < kWide) todo.push_back(m + 1);
      if (m >= kWide) todo.push_back(m - kWide);
      if (m + kWide < set.size()) todo.push_back(m + kWide);
    }
  }
  return parts;
}

TEST(SeeThrough, ANerveIsOnePieceWithoutHoles) {
  BURR_NEEDS_GPU(gpu);
  for (const double radius : {1.5, 2.0, 3.5}) {
    SCOPED_TRACE(radius);
    NoProgress quiet;
    const auto bone = bent_nerve(radius);
    Scene scene;
    ASSERT_TRUE(skin_bone(scene, *bone, 2, quiet).ok());
    scene.camera.target = bounds(scene).centre();
    scene.camera.elevation = 1.5707;
    scene.camera.distance = 0.08;
    scene.look.opacity = 0;  // the bone itself is not seen
    scene.look.background_top = scene.look.background_bottom = kBehind;
    const auto image = gpu.image(scene, kWide, kHigh);
    ASSERT_TRUE(image.ok()) << image.error().text;
    std::vector<bool> nerve;
    for (int y = 0; y < kHigh; ++y)
      for (int x = 0; x < kWide; ++x) nerve.push_back(at(*image, x, y)[0] > 20);
    EXPECT_EQ(parts_of(nerve, true), 1);
    // the arc leaves the block at two sides, so what is around it is one piece too
    EXPECT_EQ(parts_of(nerve, false), 1);
    // its area: length of the arc times its width. One pixel of this picture is that wide
    const double pixel = 2 * 0.08 * std::tan(0.5 * scene.camera.field_of_view) / kHigh;
    const double arc = 20 * 2 * std::asin(20.0 / 20 * 0.999) * kVoxel;
    const auto seen = static_cast<double>(std::count(nerve.begin(), nerve.end(), true));
    EXPECT_GT(seen * pixel * pixel, 0.5 * arc * 2 * radius * kVoxel);
    EXPECT_LT(seen * pixel * pixel, 1.5 * arc * 2 * radius * kVoxel);
  }
}

TEST(SeeThrough, WholeBoneIsThePictureItWas) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = seen_from_top();
  scene.look = Look();
  const auto before = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(before.ok());
  scene.look.opacity = 0.5;
  const auto through = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(through.ok());
  EXPECT_NE(through->rgb, before->rgb);
  scene.look.opacity = 1;
  const auto after = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(after.ok());
  EXPECT_EQ(after->rgb, before->rgb);
}

TEST(SeeThrough, TheToolIsSeenBehindBoneAndHidesWhatIsBehindIt) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = seen_from_top();
  scene.look.opacity = 0.4;
  const Vec3 middle = scene.camera.target;
  const auto nerve = place(scene, middle + Vec3(6e-3, 0, 7e-3)),
             beside = place(scene, middle + Vec3(6e-3, 6e-3, -14e-3));
  const auto without = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(without.ok());
  scene.burr.visible = true;
  scene.burr.radius = 2e-3;
  // behind the whole block, its shaft pointing away from the eye
  scene.burr.world_from_tool.p = middle + Vec3(6e-3, 6e-3, -14e-3);
  scene.burr.world_from_tool.q = Eigen::Quaterniond(0, 1, 0, 0);
  const auto behind = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(behind.ok());
  EXPECT_NE(at(*behind, beside[0], beside[1]), at(*without, beside[0], beside[1]));
  EXPECT_EQ(at(*behind, nerve[0], nerve[1]), at(*without, nerve[0], nerve[1]));
  // in front of it, over the nerve: opaque as usual
  scene.burr.world_from_tool.p = middle + Vec3(6e-3, 0, 14e-3);
  const auto before = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(before.ok());
  scene.look.opacity = 1;
  const auto opaque = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(opaque.ok());
  const auto head = place(scene, scene.burr.world_from_tool.p);
  EXPECT_EQ(at(*before, head[0], head[1]), at(*opaque, head[0], head[1]));
}

TEST(SeeThrough, DrawnInPartsIsDrawnWhole) {
  BURR_NEEDS_GPU(gpu);
  BURR_NEEDS_GPU(other);
  Scene scene = seen_from_top();
  scene.look = Look();
  scene.look.opacity = 0.4;
  scene.burr.visible = true;
  for (Renderer* one : {&gpu, &other}) one->resize_offscreen(kWide, kHigh);
  const Vec3 middle = scene.camera.target;
  for (int step = 0; step < 6; ++step) {
    scene.burr.world_from_tool.p = middle + Vec3(1.5e-3 * (step - 3), 1e-3 * step, 13e-3);
    if (step == 4) scene.clip = ClipPlane{middle, Vec3::UnitY()};
    ASSERT_TRUE(gpu.show(scene).ok());
  }
  ASSERT_TRUE(other.show(scene).ok());
  EXPECT_EQ(gpu.shown().rgb, other.shown().rgb);
}

}  // namespace
}  // namespace burr::render
