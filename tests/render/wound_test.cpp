// Fresh and wet bone: how long it lasts, where, and the colours it must have.
#include "burr/render/wound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "render/gpu.h"
#include "render/shapes.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr double kVoxel = 0.25e-3, kRadius = 2e-3;

// A burr at `tip` that takes `removed` more, in steps as a window sees them.
class Milling {
 public:
  explicit Milling(Wound& wound) : wound_(wound) {}
  void on(const Vec3& tip, double seconds, double removed, bool irrigated) {
    const int frames = std::max(1, static_cast<int>(std::lround(60 * seconds)));
    for (int n = 0; n < frames; ++n) {
      tick_.t += seconds / frames;
      tick_.tip = tip;
      tick_.radius = kRadius;
      tick_.removed += removed / frames;
      tick_.irrigated = irrigated;
      wound_.see(tick_);
    }
  }
  [[nodiscard]] const Wound::Tick& last() const { return tick_; }

 private:
  Wound& wound_;
  Wound::Tick tick_;
};

TEST(Wound, IsFreshWhereItWasCutAndDullsInItsTime) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 tip(0.03, -0.02, 0.011), face = tip - Vec3(0, 0, kRadius);
  milling.on(tip, 1, 0, false);
  EXPECT_EQ(wound.at(face).fresh, 0) << "touched, nothing taken";
  milling.on(tip, 1, 1e-9, false);
  EXPECT_NEAR(wound.at(face).fresh, 1, 1e-5);
  EXPECT_NEAR(wound.at(tip + Vec3(kRadius, 0, 0)).fresh, 1, 1e-5);
  EXPECT_EQ(wound.at(tip - Vec3(0, 0, kRadius + 2e-3)).fresh, 0);
  EXPECT_EQ(wound.at(face).wet, 0);
  milling.on(tip + Vec3(0, 0, 0.01), 10, 0, false);
  EXPECT_NEAR(wound.at(face).fresh, 1 - 10 / Wound::kDulls, 1e-3);
  milling.on(tip + Vec3(0, 0, 0.01), 10.1, 0, false);
  EXPECT_EQ(wound.at(face).fresh, 0);
}

TEST(Wound, IsWetWhereCoolantRanAndDriesInItsTime) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 tip(0, 0, 0), face(0, 0, -kRadius);
  milling.on(tip, 1, 0, true);
  EXPECT_NEAR(wound.at(face).wet, 1, 1e-5);
  EXPECT_EQ(wound.at(face).fresh, 0);
  EXPECT_NEAR(wound.at({0, 0, -kRadius - 0.8 * Wound::kSpray}).wet, 0.5, 0.2) << "its rim";
  EXPECT_EQ(wound.at({0, 0, -kRadius - Wound::kSpray - 1.2e-3}).wet, 0);
  milling.on(tip, 20, 0, false);
  EXPECT_NEAR(wound.at(face).wet, 1 - 20 / Wound::kDries, 1e-3);
  milling.on(tip, 20.1, 0, false);
  EXPECT_EQ(wound.at(face).wet, 0);
}

TEST(Wound, GoesAlongWithTheToolAndForgetsWhenTimeGoesBack) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 first(0, 0, 0), second(0.012, 0, 0);
  milling.on(first, 0.5, 1e-9, false);
  milling.on(second + Vec3(0, 0, 0.01), 0.5, 0, false);  // over there without cutting
  const float before = wound.at({0, 0, -kRadius}).fresh;
  milling.on(second, 0.5, 1e-9, false);
  EXPECT_NEAR(wound.at({0, 0, -kRadius}).fresh, before - 0.5 / Wound::kDulls, 1e-3);
  EXPECT_NEAR(wound.at(second - Vec3(0, 0, kRadius)).fresh, 1, 1e-5);
  Wound::Tick back = milling.last();
  back.t = 0.1;
  wound.see(back);
  EXPECT_EQ(wound.at(second - Vec3(0, 0, kRadius)).fresh, 0);
}

// ---- in pictures

constexpr int kWide = 200, kHigh = 160;
constexpr Colour kBone = {0.6F, 0.5F, 0.4F};

Scene ball() {
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, kBone};
  set_patch(scene, 0, test::ball(Vec3::Zero(), 0.03, 200));
  scene.camera.distance = 0.2;
  scene.look.plain = true;
  return scene;
}
void dress_all(Scene& scene, Dress dress) {
  ScenePatch& patch = scene.patches[0];
  patch.dress = std::make_shared<const std::vector<Dress>>(patch.mesh->vertices().size(), dress);
}

// of the pixels that face the eye: their mean, and how far from it they are
struct Seen {
  double mean[3] = {}, least = 255, most = 0;
};
Seen middle_of(const Image& image) {
  Seen seen;
  int count = 0;
  for (int y = kHigh / 2 - 6; y < kHigh / 2 + 6; ++y)
    for (int x = kWide / 2 - 6; x < kWide / 2 + 6; ++x, ++count)
      for (std::size_t c = 0; c < 3; ++c) {
        const double v = image.rgb[static_cast<std::size_t>(3 * (y * kWide + x)) + c];
        seen.mean[c] += v;
        if (c == 0) seen.least = std::min(seen.least, v);
        if (c == 0) seen.most = std::max(seen.most, v);
      }
  for (double& mean : seen.mean) mean /= count;
  return seen;
}

TEST(Wound, FreshBoneIsPalerByHalfAndGrainyAndWetBoneDarker) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball();
  const auto see = [&](Dress dress) {
    dress_all(scene, dress);
    const auto image = gpu.image(scene, kWide, kHigh);
    EXPECT_TRUE(image.ok());
    return middle_of(*image);
  };
  constexpr double kPale[] = {1.0, 0.98, 0.94};
  const Seen dry = see({}), fresh = see({.fresh = 255}), wet = see({.wet = 255}),
             half = see({.wet = 128});
  for (std::size_t c = 0; c < 3; ++c) {
    const double bone = 255 * static_cast<double>(kBone[c]);
    EXPECT_NEAR(dry.mean[c], bone, 3);
    EXPECT_NEAR(fresh.mean[c], 0.5 * (bone + 255 * kPale[c]), 5);
    EXPECT_NEAR(wet.mean[c], 0.78 * bone, 3);
    EXPECT_NEAR(half.mean[c], 0.89 * bone, 3);
  }
  EXPECT_LE(dry.most - dry.least, 4);
  EXPECT_GT(fresh.most - fresh.least, 10) << "its grain is seen";
  EXPECT_LT(fresh.most - fresh.least, 0.14 * 255);
}

TEST(Wound, WetBoneShines) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball();
  scene.look = Look();
  const auto brightest = [&](Dress dress) {
    dress_all(scene, dress);
    const auto image = gpu.image(scene, kWide, kHigh);
    EXPECT_TRUE(image.ok());
    return int{*std::max_element(image->rgb.begin(), image->rgb.end())};
  };
  EXPECT_GT(brightest({.wet = 255}), brightest({}) + 10) << "though it is darker elsewhere";
}

TEST(Wound, ADressOfNothingAndNoneAreTheSamePicture) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball();
  for (const bool plain : {true, false}) {
    scene.look = Look();
    scene.look.plain = plain;
    scene.patches[0].dress = nullptr;
    const auto none = gpu.image(scene, kWide, kHigh);
    dress_all(scene, {});
    const auto nothing = gpu.image(scene, kWide, kHigh);
    dress_all(scene, {.fresh = 200, .wet = 90});
    const auto some = gpu.image(scene, kWide, kHigh);
    scene.patches[0].dress = nullptr;
    const auto off = gpu.image(scene, kWide, kHigh);
    ASSERT_TRUE(none.ok() && nothing.ok() && some.ok() && off.ok());
    EXPECT_EQ(none->rgb, nothing->rgb);
    EXPECT_NE(none->rgb, some->rgb);
    EXPECT_EQ(none->rgb, off->rgb);
  }
}

TEST(Wound, DressesOnlyWhatItReachesAndAWindowDrawsItAnew) {
  BURR_NEEDS_GPU(gpu);
  BURR_NEEDS_GPU(other);
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, kBone};
  int n = 0;
  for (const surface::Patch& part : test::cut(test::ball(Vec3::Zero(), 0.03, 120), 3))
    set_patch(scene, n++, part);
  scene.camera.distance = 0.2;
  for (Renderer* one : {&gpu, &other}) one->resize_offscreen(kWide, kHigh);
  ASSERT_TRUE(gpu.show(scene).ok());
  const Image before = gpu.shown();
  Wound wound(kVoxel);
  Milling milling(wound);
  milling.on(Vec3(0, -0.03 - kRadius, 0), 1, 1e-9, true);  // before the eye
  wound.dress(scene);
  int dressed = 0, with_surface = 0;
  for (const ScenePatch& patch : scene.patches) {
    dressed += patch.dress != nullptr;
    with_surface += patch.mesh != nullptr;
  }
  EXPECT_GE(dressed, 1);
  EXPECT_LT(dressed, with_surface / 2);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_LT(gpu.figures().redrawn, 0.9);
  const Image after = gpu.shown();
  EXPECT_NE(after.rgb, before.rgb);
  ASSERT_TRUE(other.show(scene).ok());
  EXPECT_EQ(after.rgb, other.shown().rgb);
  // all is dry and dull again: as it was
  milling.on(Vec3(0, -0.05, 0), 41, 0, false);
  wound.dress(scene);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(gpu.shown().rgb, before.rgb);
}

}  // namespace
}  // namespace burr::render
