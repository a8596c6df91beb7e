// Fresh and wet bone, dust and blood: how long they last, where they are, and their colours.
#include "burr/render/wound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "render/formula_surfaces.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr double kVoxel = 0.25e-3, kRadius = 2e-3;

// A burr at `tip` that removes `removed` more, in steps as in a window.
class Milling {
 public:
  explicit Milling(Wound& wound) : wound_(wound) {}
  void on(const Vec3& tip, double seconds, double removed, bool irrigated, double added = 0) {
    const int frames = std::max(1, static_cast<int>(std::lround(60 * seconds)));
    for (int n = 0; n < frames; ++n) {
      tick_.t += seconds / frames;
      tick_.tip = tip;
      tick_.radius = kRadius;
      tick_.removed += removed / frames;
      tick_.added += added / frames;
      tick_.irrigated = irrigated;
      wound_.see(tick_);
    }
  }
  void undo(double volume) {
    tick_.t += 0.02;
    tick_.undone += volume;
    wound_.see(tick_);
  }
  [[nodiscard]] const Wound::Tick& last() const { return tick_; }

 private:
  Wound& wound_;
  Wound::Tick tick_;
};

TEST(Wound, WhatASuctionTubeComesNearIsDryAndCleanAndStillFresh) {
  Wound wound(kVoxel);
  wound.suck(Vec3::Zero(), 1.5e-3, 1);  // nothing to remove yet
  EXPECT_FALSE(wound.any());
  Milling milling(wound);
  const Vec3 tip(0.03, -0.02, 0.011), face = tip - Vec3(0, 0, kRadius);
  milling.on(tip, 1, 1e-9, true);
  ASSERT_GT(wound.at(face).wet, 0.9F);
  const float fresh = wound.at(face).fresh;
  const float before = wound.at(face).wet;
  wound.suck(face + Vec3(0, 0, 20e-3), 1.5e-3, 1);
  EXPECT_EQ(wound.at(face).wet, before) << "two centimetres off";
  wound.suck(face, 1.5e-3, Wound::kSuctionTime);
  EXPECT_NEAR(wound.at(face).wet, before * std::exp(-1), 0.12) << "an e-th part in its time";
  wound.suck(face, 1.5e-3, 5);
  EXPECT_EQ(wound.at(face).wet, 0);
  EXPECT_EQ(wound.at(face).fresh, fresh);
  // dry again: dust lies beside the cut, and is sucked away
  milling.on(tip, 1, 2e-9, false);
  milling.on(tip + Vec3(0, 0, 0.01), 3, 0, false);
  const Vec3 beside = tip + Vec3(kRadius + 1.5e-3, 0, 0);
  ASSERT_GT(wound.at(beside).dust, 0.05F);
  wound.suck(beside, 1.5e-3, 5);
  EXPECT_EQ(wound.at(beside).dust, 0);
}

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
  EXPECT_NEAR(wound.at(face).fresh, 1 - 10 / Wound::kDullTime, 1e-3);
  milling.on(tip + Vec3(0, 0, 0.01), 10.1, 0, false);
  EXPECT_EQ(wound.at(face).fresh, 0);
}

// A tool that stays where it is: it removes a cubic millimetre in a second, then waits for its dust to
// settle.
void cut_with(Wound& wound, Wound::Tick tick) {
  for (int n = 0; n < 240; ++n) {
    tick.t = n / 60.0;
    tick.removed = 1e-9 * std::min(1.0, n / 60.0);
    wound.see(tick);
  }
}

// A saw throws its dust along its stroke, what turns to all sides, a chisel makes none.
TEST(Wound, DustLiesWhereTheToolThrowsIt) {
  const Vec3 tip(0.03, -0.02, 0.011), x = Vec3::UnitX(), y = Vec3::UnitY();
  const double near = kRadius + 2e-3, far = kRadius + 9e-3;
  const auto with = [&](double dust, const Vec3& stroke) {
    Wound wound(kVoxel);
    Wound::Tick tick;
    tick.tip = tip;
    tick.radius = kRadius;
    tick.dust = dust;
    tick.stroke = stroke;
    cut_with(wound, tick);
    return wound;
  };
  const Wound turns = with(1, Vec3::Zero());
  EXPECT_GT(turns.at(tip + near * x).dust, 0.02F);
  EXPECT_NEAR(turns.at(tip + near * x).dust, turns.at(tip + near * y).dust, 0.02F);
  EXPECT_EQ(turns.at(tip + far * x).dust, 0);
  const Wound saws = with(1, y);
  EXPECT_GT(saws.at(tip + near * y).dust, 0.02F);
  EXPECT_GT(saws.at(tip + far * y).dust, 0.005F);
  EXPECT_GT(saws.at(tip - far * y).dust, 0.005F) << "to both ends of the stroke";
  EXPECT_EQ(saws.at(tip + near * x).dust, 0);
  const Wound chisels = with(0, Vec3::Zero());
  EXPECT_EQ(chisels.in_the_air(), 0);
  for (const Vec3& way : {x, y}) EXPECT_EQ(chisels.at(tip + near * way).dust, 0);
  EXPECT_NEAR(chisels.at(tip - Vec3(0, 0, kRadius)).fresh,
              turns.at(tip - Vec3(0, 0, kRadius)).fresh, 1e-6)
      << "the cut looks the same";
  // as much lies about a saw as about a burr: the volumes of the two cones
  const auto lies = [&](const Wound& wound) {
    double sum = 0;
    for (int i = -40; i <= 40; ++i)
      for (int j = -40; j <= 40; ++j) {
        const double cover =
            static_cast<double>(wound.at(tip + 0.5e-3 * i * x + 0.5e-3 * j * y).dust);
        const double off = 0.5e-3 * std::hypot(i, j);
        if (off > kRadius + 2e-3) sum += -std::log(1 - std::min(cover, 0.999));
      }
    return sum;
  };
  EXPECT_GT(lies(saws), 0.4 * lies(turns));
}

// Both hands: each cut is fresh where it was made, each tool has its own dust, and what the other removed
// is not thrown by the first.
TEST(Wound, TheToolOfTheOtherHandLeavesItsOwnMarks) {
  const Vec3 tip(0.03, -0.02, 0.011), other = tip + Vec3(0, 9e-3, 0);
  Wound wound(kVoxel);
  Wound::Tick first, second;
  first.tip = tip;
  second.tip = other;
  first.radius = second.radius = 1e-3;
  for (int n = 0; n <= 120; ++n) {
    first.t = second.t = n / 60.0;
    second.removed = first.removed = first.others = 1e-9 * n / 120;  // the second alone cuts
    wound.see(first);
    wound.see_beside(second);
  }
  EXPECT_EQ(wound.at(tip - Vec3(0, 0, 1e-3)).fresh, 0);
  EXPECT_NEAR(wound.at(other - Vec3(0, 0, 1e-3)).fresh, 1, 1e-5);
  EXPECT_GT(wound.at(other + Vec3(0, 3e-3, 0)).dust, 0.02F);
  EXPECT_EQ(wound.at(tip - Vec3(0, 5e-3, 0)).dust, 0);
  // a mouth beside it takes what is in the air
  ASSERT_GT(wound.in_the_air(), 0);
  const double before = wound.in_the_air();
  wound.suck(other, 1.5e-3, Wound::kSuctionTime);
  EXPECT_NEAR(wound.in_the_air(), before * std::exp(-1), 0.02 * before);
  // then the first cuts too: the marks of both are there, and an undo takes both
  for (int n = 1; n <= 60; ++n) {
    first.t = second.t = 2 + n / 60.0;
    first.removed = 1e-9 + 1e-9 * n / 60;
    wound.see(first);
    wound.see_beside(second);
  }
  EXPECT_NEAR(wound.at(tip - Vec3(0, 0, 1e-3)).fresh, 1, 1e-5);
  first.t += 0.02;
  first.undone = 2e-9;
  wound.see(first);
  EXPECT_EQ(wound.at(tip - Vec3(0, 0, 1e-3)).fresh, 0);
  EXPECT_EQ(wound.in_the_air(), 0);
}

// The rows of a window are not of the same tick, and the two sums round differently.
TEST(Wound, ALaterRowOfTheOtherHandLeavesNoMarkOfTheFirst) {
  const Vec3 tip(0.03, -0.02, 0.011), other = tip + Vec3(0, 9e-3, 0);
  Wound wound(kVoxel);
  Wound::Tick first, second;
  first.tip = tip;
  second.tip = other;
  first.radius = second.radius = 1e-3;
  for (int n = 0; n <= 120; ++n) {
    first.t = second.t = n / 60.0;
    first.removed = 1e-9 * n + (n % 3 == 1 ? 1e-20 : 0);
    first.others = second.removed = n == 0 ? 0 : 1e-9 * (n + 0.2 * (n % 4));  // 0 to 0.6 of a step
    wound.see(first);
    wound.see_beside(second);
  }
  EXPECT_EQ(wound.at(tip - Vec3(0, 0, 1e-3)).fresh, 0);
  EXPECT_NEAR(wound.at(other - Vec3(0, 0, 1e-3)).fresh, 1, 1e-5);
}

TEST(Wound, IsWetWhereCoolantRanAndDriesInItsTime) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 tip(0, 0, 0), face(0, 0, -kRadius);
  milling.on(tip, 1, 0, true);
  EXPECT_NEAR(wound.at(face).wet, 1, 1e-5);
  EXPECT_EQ(wound.at(face).fresh, 0);
  EXPECT_NEAR(wound.at({0, 0, -kRadius - 0.8 * Wound::kSprayReach}).wet, 0.5, 0.2) << "its rim";
  EXPECT_EQ(wound.at({0, 0, -kRadius - Wound::kSprayReach - 1.2e-3}).wet, 0);
  milling.on(tip, 20, 0, false);
  EXPECT_NEAR(wound.at(face).wet, 1 - 20 / Wound::kDryTime, 1e-3);
  milling.on(tip, 20.1, 0, false);
  EXPECT_EQ(wound.at(face).wet, 0);
}

TEST(Wound, GoesAlongWithTheToolAndForgetsWhenTimeGoesBack) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 first(0, 0, 0), second(0.012, 0, 0);
  milling.on(first, 0.5, 1e-9, false);
  milling.on(second + Vec3(0, 0, 0.01), 0.5, 0, false);  // at another place, without cutting
  const float before = wound.at({0, 0, -kRadius}).fresh;
  milling.on(second, 0.5, 1e-9, false);
  EXPECT_NEAR(wound.at({0, 0, -kRadius}).fresh, before - 0.5 / Wound::kDullTime, 1e-3);
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
void stain_all(Scene& scene, Stain stains) {
  set_stains(
      scene, 0,
      std::make_shared<const std::vector<Stain>>(scene.patches[0].mesh->vertices().size(), stains));
}

// the mean of the pixels that face the eye, and their spread
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

TEST(Wound, FreshBoneIsPalerAndWetBoneDarker) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball();
  const auto see = [&](Stain stains) {
    stain_all(scene, stains);
    const auto image = gpu.image(scene, kWide, kHigh);
    EXPECT_TRUE(image.ok());
    return middle_of(*image);
  };
  constexpr double kPale[] = {0.97, 0.95, 0.90};
  const Seen dry = see({}), fresh = see({.fresh = 255}), wet = see({.wet = 255}),
             half = see({.wet = 90});
  for (std::size_t c = 0; c < 3; ++c) {
    const double bone = 255 * static_cast<double>(kBone[c]);
    EXPECT_NEAR(dry.mean[c], bone, 3);
    EXPECT_NEAR(fresh.mean[c], 0.62 * bone + 0.38 * 255 * kPale[c], 5);
    EXPECT_NEAR(wet.mean[c], 0.76 * bone, 3);
    EXPECT_LT(half.mean[c], bone - 3);
    EXPECT_GT(half.mean[c], wet.mean[c] + 3);
  }
  EXPECT_LE(dry.most - dry.least, 4);
}

TEST(Wound, WetBoneShines) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball();
  scene.look = Look();
  const auto brightest = [&](Stain stains) {
    stain_all(scene, stains);
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
    set_stains(scene, 0, nullptr);
    const auto none = gpu.image(scene, kWide, kHigh);
    stain_all(scene, {});
    const auto nothing = gpu.image(scene, kWide, kHigh);
    stain_all(scene, {.fresh = 200, .wet = 90});
    const auto some = gpu.image(scene, kWide, kHigh);
    set_stains(scene, 0, nullptr);
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
  milling.on(Vec3(0, -0.03 - kRadius, 0), 1, 1e-9, true);  // in front of the eye
  wound.stain(scene);
  int stained = 0, with_surface = 0;
  for (const ScenePatch& patch : scene.patches) {
    stained += patch.stains != nullptr;
    with_surface += patch.mesh != nullptr;
  }
  EXPECT_GE(stained, 1);
  EXPECT_LT(stained, with_surface / 2);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_LT(gpu.figures().redrawn, 0.9);
  const Image after = gpu.shown();
  EXPECT_NE(after.rgb, before.rgb);
  ASSERT_TRUE(other.show(scene).ok());
  EXPECT_EQ(after.rgb, other.shown().rgb);
  // everything is dry and dull again, as before
  milling.on(Vec3(0, -0.05, 0), 41, 0, false);
  wound.stain(scene);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(gpu.shown().rgb, before.rgb);
}

// ---- dust

TEST(Wound, DustHangsInTheAirAndSettlesAroundTheToolInAConeOfItsVolume) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 tip = Vec3::Zero();
  constexpr double kRemoved = 2e-9;
  milling.on(tip, 1.0 / 60, 0, false);
  milling.on(tip, 1.0 / 60, kRemoved, false);
  const double loose = kRemoved / Wound::kSolidShare;
  EXPECT_NEAR(wound.in_the_air(), loose, 0.05 * loose);
  const double before = wound.in_the_air();
  milling.on(tip, Wound::kSettleTime, 0, false);
  EXPECT_NEAR(wound.in_the_air(), before / std::exp(1), 1e-3 * loose);
  milling.on(tip, 5, 0, false);
  EXPECT_NEAR(wound.in_the_air(), 0, 1e-3 * loose);

  // dust hides the bone as a layer of its thickness does
  const double reach = kRadius + Wound::kDustReach;
  double total = 0;
  for (const double part : {0.45, 0.6, 0.75, 0.9}) {
    const double d = part * reach;
    const double thick = 3 * loose / (std::numbers::pi * reach * reach) * (1 - part);
    EXPECT_NEAR(wound.at({d, 0, 0}).dust, 1 - std::exp(-thick / Wound::kCoverThickness), 0.03)
        << part;
  }
  for (int n = 0; n < 1000;
       ++n) {  // ... and all of it has settled: the cone's volume is that of its layers
    const double d = (n + 0.5) / 1000 * reach;
    total += 3 * loose / (std::numbers::pi * reach * reach) * (1 - d / reach) * 2 *
             std::numbers::pi * d * reach / 1000;
  }
  EXPECT_NEAR(total, loose, 0.01 * loose);
  EXPECT_EQ(wound.at({reach + 1.5e-3, 0, 0}).dust, 0);
  EXPECT_EQ(wound.at({0, 0, -kRadius}).dust, 0) << "the burr sweeps where it cuts";
  const Vec3 beside(0.5 * reach, 0, 0);
  ASSERT_GT(wound.at(beside).dust, 0.1F);
  milling.on(beside, 0.1, 1e-12, false);
  EXPECT_NEAR(wound.at(beside).dust, 0, 1e-3) << "... and what lay there before";
}

TEST(Wound, WhatAStrokeLeftGoesWithIt) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 first(0.03, -0.02, 0.011), second = first + Vec3(6e-3, 0, 0);
  const auto face = [](const Vec3& tip) { return Vec3(tip - Vec3(0, 0, kRadius)); };
  const auto beside = [](const Vec3& tip) { return Vec3(tip + Vec3(0, kRadius + 1.5e-3, 0)); };
  const Vec3 away = first + Vec3(0, 0, 0.01);
  milling.on(first, 0.5, 2e-9, false);
  milling.on(away, 1.5, 0, false);
  const auto before = wound.at(beside(first));
  const float fresh = wound.at(face(first)).fresh;
  const float there = wound.at(beside(second)).dust;  // a little of the first stroke's
  ASSERT_GT(before.dust, 0.05F);
  milling.on(second, 0.5, 3e-9, false);
  milling.on(away, 1.5, 0, false);
  ASSERT_GT(wound.at(beside(second)).dust, there + 0.05F);
  ASSERT_GT(wound.at(face(second)).fresh, 0.5F);

  milling.undo(3e-9);
  EXPECT_EQ(wound.at(face(second)).fresh, 0);
  EXPECT_NEAR(wound.at(beside(second)).dust, there, 1e-6);
  EXPECT_NEAR(wound.at(beside(first)).dust, before.dust, 1e-6) << "the first stroke is still there";
  EXPECT_LT(wound.at(face(first)).fresh, fresh) << "but it dulled meanwhile";
  EXPECT_GT(wound.at(face(first)).fresh, 0.5F);
  milling.undo(2e-9);
  EXPECT_EQ(wound.at(beside(first)).dust, 0);
  EXPECT_EQ(wound.at(face(first)).fresh, 0);
  EXPECT_EQ(wound.in_the_air(), 0);

  // strokes longer ago than are kept take all dust with them; the next stroke leaves its own
  for (std::size_t n = 0; n < Wound::kStrokes + 2; ++n) {
    milling.on(first, 0.1, 1e-9, false);
    milling.on(away, 0.3, 0, false);
  }
  ASSERT_GT(wound.at(beside(first)).dust, 0);
  milling.undo(1e-9 * static_cast<double>(Wound::kStrokes + 1));
  EXPECT_EQ(wound.at(beside(first)).dust, 0);
  milling.on(first, 0.5, 2e-9, false);
  milling.on(away, 1.5, 0, false);
  EXPECT_GT(wound.at(beside(first)).dust, 0);
}

TEST(Wound, CoolantMakesAPasteOfDustAndRinsesItAwaySlowly) {
  Wound wound(kVoxel);
  Milling milling(wound);
  const Vec3 beside(kRadius + 2e-3, 0, 0);
  milling.on(Vec3::Zero(), 1, 4e-9, false);
  milling.on(Vec3::Zero(), 5, 0, false);
  const float lies = wound.at(beside).dust;
  ASSERT_GT(lies, 0.3F);
  milling.on(Vec3::Zero(), Wound::kRinseTime, 0, true);
  EXPECT_NEAR(wound.at(beside).dust, lies / std::exp(1), 0.02);
  milling.on(Vec3::Zero(), 8 * Wound::kRinseTime, 0, true);
  EXPECT_NEAR(wound.at(beside).dust, 0, 0.01);
  // what is cut under coolant leaves a paste, less than the dry dust of the same cut
  milling.on(Vec3::Zero(), 2, 4e-9, true);
  const float paste = wound.at(beside).dust;
  EXPECT_GT(wound.at(beside).wet, 0.5F);
  EXPECT_GT(paste, 0.05F);
  EXPECT_LT(paste, 0.6F * lies);
}

// ---- blood

constexpr volume::TissueId kHard = 1, kVessel = 2, kMarrow = 3;

// A flat surface of 20 x 20 mm through the origin, a vertex every 0.25 mm, facing n.
surface::Patch flat(const Vec3& n, const std::function<surface::Vertex(const Vec3&)>& vertex) {
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  surface::Patch patch;
  constexpr int kSide = 81;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Vec3 p = 0.25e-3 * ((i - kSide / 2) * u + (j - kSide / 2) * v);
      surface::Vertex one = vertex(p);
      one.p = p.cast<float>();
      one.n = n.cast<float>();
      patch.vertices.push_back(one);
      if (i + 1 == kSide || j + 1 == kSide) continue;
      const auto at = static_cast<std::uint32_t>(j * kSide + i), up = at + kSide;
      for (const std::uint32_t corner : {at, at + 1, up, at + 1, up + 1, up})
        patch.triangles.push_back(corner);
    }
  return patch;
}
Scene scene_of(const surface::Patch& patch) {
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, kBone, kBone, kBone};
  set_patch(scene, 0, patch);
  return scene;
}
Scene plate(volume::TissueId tissue, const Vec3& n = Vec3::UnitZ()) {
  return scene_of(flat(n, [&](const Vec3&) {
    surface::Vertex vertex;
    vertex.tissue = tissue;
    return vertex;
  }));
}
const std::vector<float> kBleeding = {0, 0, 1, 0.3F};

TEST(Wound, PasteRunsDownAWallAndLiesOnAFloorAndDryDustStaysWhereItIs) {
  // how much of the dust on a plate is below its middle, after a while
  const auto below = [](const Vec3& n, bool wet) {
    Scene scene = plate(kHard, n);
    Wound wound(kVoxel);
    Milling milling(wound);
    const Vec3 tip = kRadius * n;
    milling.on(tip, 0.5, 3e-9, wet);
    wound.stain(scene);  // it learns where the surface is
    for (int n_s = 0; n_s < 3; ++n_s) milling.on(tip + 30e-3 * n, 1, 0, false);
    double low = 0, all = 0;
    for (int x = -36; x <= 36; x += 2)
      for (int y = -36; y <= 36; ++y) {
        const Vec3 p = 0.25e-3 * Vec3(x, n.y() > 0.5 ? 0 : y, n.y() > 0.5 ? y : 0);
        const double dust = y == 0 ? 0 : static_cast<double>(wound.at(p).dust);
        all += dust;
        if (y < 0) low += dust;
      }
    EXPECT_GT(all, 1);
    return low / all;
  };
  const Vec3 wall = Vec3::UnitY(), floor = Vec3::UnitZ();
  EXPECT_GT(below(wall, true), 0.515);
  EXPECT_NEAR(below(wall, false), 0.5, 0.005);
  EXPECT_NEAR(below(floor, true), 0.5, 0.005);
}

// Lets a burr rest where it has just cut, for some seconds, with ten pictures a second.
void watch(Wound& wound, Milling& milling, Scene& scene, const Vec3& tip, double seconds,
           bool irrigated = false, double added = 0) {
  for (int n = 0; n < std::lround(10 * seconds); ++n) {
    milling.on(tip, 0.1, 0, irrigated, added / (10 * seconds));
    wound.stain(scene);
  }
}
double blood_on(const Wound& wound) {
  double sum = 0;
  for (int j = -9; j <= 9; ++j)
    for (int i = -9; i <= 9; ++i)
      sum += static_cast<double>(wound.at({i * 1e-3, j * 1e-3, 0}).blood);
  return sum;
}

TEST(Wound, OnlyWhatBleedsBleedsAndTheMoreTheFaster) {
  double seen[4] = {};
  for (const volume::TissueId tissue : {kHard, kMarrow, kVessel}) {
    Wound wound(kVoxel, kBleeding);
    Milling milling(wound);
    Scene scene = plate(tissue);
    const Vec3 tip(0, 0, 0.9 * kRadius);
    watch(wound, milling, scene, tip, 1);
    EXPECT_EQ(blood_on(wound), 0) << "touched, not cut";
    milling.on(tip, 0.1, 1e-9, false);
    watch(wound, milling, scene, tip, 2);
    seen[tissue] = blood_on(wound);
  }
  EXPECT_EQ(seen[kHard], 0);
  EXPECT_GT(seen[kMarrow], 0.5);
  EXPECT_GT(seen[kVessel], 2 * seen[kMarrow]);
}

TEST(Wound, AVesselBleedsWhenItIsReachedNotThroughThinBone) {
  for (const bool reached : {true, false}) {
    const double deep = reached ? 0.3e-3 : 0.4e-3;  // inside the canal; or so much bone is left
    Wound wound(kVoxel, kBleeding);
    Milling milling(wound);
    Scene scene = scene_of(flat(Vec3::UnitZ(), [](const Vec3&) {
      surface::Vertex wall;
      wall.tissue = kHard;
      wall.beneath = kVessel;
      wall.wall = 255;
      return wall;
    }));
    const Vec3 tip(0, 0, kRadius + (reached ? -deep : deep));
    milling.on(tip, 0.1, 0, false);
    milling.on(tip, 0.1, 1e-9, false);
    watch(wound, milling, scene, tip, 2);
    if (reached)
      EXPECT_GT(blood_on(wound), 1) << "opened";
    else
      EXPECT_EQ(blood_on(wound), 0) << "bone of 0.4 mm is left";
  }
}

TEST(Wound, BloodRunsDownAlongTheSurface) {
  Wound wound(kVoxel, kBleeding);
  Milling milling(wound);
  // a wall: up is along it
  Scene scene = scene_of(flat(Vec3::UnitX(), [](const Vec3& p) {
    surface::Vertex vertex;
    vertex.tissue = p.norm() < 1e-3 ? kVessel : kHard;
    return vertex;
  }));
  const Vec3 tip(0.9 * kRadius, 0, 0);
  milling.on(tip, 0.1, 0, false);
  milling.on(tip, 0.1, 1e-9, false);
  watch(wound, milling, scene, tip + Vec3(0.02, 0, 0), 6);
  double above = 0, below = 0;
  for (int n = 3; n <= 8; ++n) {
    above += static_cast<double>(wound.at({0, 0, n * 1e-3}).blood);
    below += static_cast<double>(wound.at({0, 0, -n * 1e-3}).blood);
  }
  EXPECT_GT(below, 2);
  EXPECT_GT(below, 4 * above);
  EXPECT_EQ(wound.at({4e-3, 0, -3e-3}).blood, 0) << "there is no surface in the air";
}

TEST(Wound, WaxStopsBloodAndCoolantOnlyWashesIt) {
  Wound wound(kVoxel, kBleeding);
  Milling milling(wound);
  Scene scene = plate(kVessel);
  const Vec3 tip(0, 0, 0.9 * kRadius);
  milling.on(tip, 0.1, 0, false);
  milling.on(tip, 0.1, 1e-9, false);
  watch(wound, milling, scene, tip, 3);
  const double bled = blood_on(wound);
  ASSERT_GT(bled, 3);
  watch(wound, milling, scene, tip, 2, true);
  const double washed = blood_on(wound);
  EXPECT_LT(washed, 0.5 * bled);
  watch(wound, milling, scene, tip, 3);
  EXPECT_GT(blood_on(wound), washed + 0.3 * bled) << "it comes again";
  watch(wound, milling, scene, tip, 0.2, false, 1e-9);  // wax
  watch(wound, milling, scene, tip, 1, true);
  const double sealed = blood_on(wound);
  watch(wound, milling, scene, tip, 3);
  EXPECT_LE(blood_on(wound), sealed + 1e-6);
}

TEST(Wound, BloodClotsAndClears) {
  Wound wound(kVoxel, kBleeding);
  Milling milling(wound);
  Scene scene = plate(kVessel);
  const Vec3 tip(0, 0, 0.9 * kRadius);
  milling.on(tip, 0.1, 0, false);
  milling.on(tip, 0.1, 1e-9, false);
  watch(wound, milling, scene, tip, 5);
  const double bled = blood_on(wound);
  ASSERT_GT(bled, 3);
  Wound::Tick tick = milling.last();
  for (int second = 0; second < 900; ++second) {
    tick.t += 1;
    wound.see(tick);
    if (second % 10 == 0) wound.stain(scene);
  }
  EXPECT_LT(blood_on(wound), 0.01 * bled);
}

TEST(Wound, AStillShowsWhatIsOpenThoughNobodyLookedOn) {
  Wound wound(kVoxel, kBleeding);
  Milling milling(wound);
  Scene scene = plate(kVessel);
  const Vec3 tip(0, 0, 0.9 * kRadius);
  milling.on(tip, 0.1, 0, false);
  milling.on(tip, 0.1, 1e-9, false);
  milling.on(tip + Vec3(0, 0, 5e-3), 5, 0, false);
  EXPECT_EQ(blood_on(wound), 0) << "no surface has told";
  wound.stain_still(scene);
  EXPECT_GT(blood_on(wound), 3);
  ASSERT_NE(scene.patches[0].stains, nullptr);
  EXPECT_TRUE(std::any_of(scene.patches[0].stains->begin(), scene.patches[0].stains->end(),
                          [](const Stain& stains) { return stains.blood > 200; }));
}

TEST(Wound, DustLiesOnWhatFacesUpNotUnderAnEdge) {
  for (const double side : {1.0, -1.0}) {
    Wound wound(kVoxel);
    Milling milling(wound);
    Scene scene = plate(kHard, Vec3(0, 0, side));
    milling.on({0, 0, kRadius}, 0.1, 0, false);
    milling.on({0, 0, kRadius}, 3, 5e-9, false);
    milling.on({0, 0, kRadius}, 3, 0, false);
    wound.stain(scene);
    ASSERT_NE(scene.patches[0].stains, nullptr);
    const bool any = std::any_of(scene.patches[0].stains->begin(), scene.patches[0].stains->end(),
                                 [](const Stain& stains) { return stains.dust > 40; });
    EXPECT_EQ(any, side > 0);
  }
}

TEST(Wound, BloodIsRedAndDustPaleAndInHeaps) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball();
  const auto see = [&](Stain stains) {
    stain_all(scene, stains);
    const auto image = gpu.image(scene, kWide, kHigh);
    EXPECT_TRUE(image.ok());
    return middle_of(*image);
  };
  const Seen clean = see({}), blood = see({.blood = 255}), some = see({.dust = 90}),
             much = see({.dust = 255});
  EXPECT_GT(blood.mean[0], 60);
  EXPECT_LT(blood.mean[1], 30);
  EXPECT_LT(blood.mean[2], 30);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_GT(much.mean[c], clean.mean[c] + 30) << c;
  EXPECT_GT(some.mean[0], clean.mean[0] + 5);
  EXPECT_LT(some.mean[0], much.mean[0] - 10);
  scene.look = Look();
  scene.look.gloss = 0;
  const Seen heaps = see({.dust = 90});
  EXPECT_GT(heaps.most - heaps.least, 25) << "heaps, and bone between them";
}

TEST(Wound, AFlutedBurrLeavesRidgesAcrossItsWayAndADiamondPolishesThemAway) {
  BURR_NEEDS_GPU(gpu);
  Wound wound(kVoxel);
  Scene scene = plate(kHard);
  scene.camera = {};
  scene.camera.elevation = 1.5707;
  scene.camera.distance = 0.03;
  double t = 0, removed = 0;
  const auto drag = [&](bool diamond) {
    for (int n = 0; n <= 40; ++n)
      wound.see({.t = t += 0.01,
                 .tip = Vec3((n - 20) * 0.2e-3, 0, 0.98 * kRadius),
                 .radius = kRadius,
                 .removed = removed += 1e-12,
                 .diamond = diamond});
    wound.stain(scene);
  };
  drag(false);
  ASSERT_NE(scene.patches[0].stains, nullptr);
  const auto& mesh = *scene.patches[0].mesh;
  // along the way of the burr the length grows as the way does; across it stays
  double worst = 0;
  int ridged = 0;
  const Stain* first = nullptr;
  double first_x = 0;
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    const Stain& stain = (*scene.patches[0].stains)[v];
    const math::Vec3f& p = mesh.vertices()[v].p;
    if ((stain.ridges & 255U) == 0 || std::abs(p.x()) > 3e-3F) continue;
    ++ridged;
    const double x = static_cast<double>(p.x());
    if (first == nullptr) {
      first = &stain;
      first_x = x;
    }
    const double along = Stain::kAlong * (static_cast<double>(stain.ridges >> 8) -
                                          static_cast<double>(first->ridges >> 8));
    worst = std::max(worst, std::abs(along - (x - first_x)));
  }
  EXPECT_GT(ridged, 20);
  EXPECT_LT(worst, 20e-6);
  // and they are still there when all else has faded
  wound.see({.t = t += 100, .tip = Vec3(0, 0, 5 * kRadius), .radius = kRadius, .removed = removed});
  wound.stain(scene);
  ASSERT_NE(scene.patches[0].stains, nullptr);
  EXPECT_FALSE((*scene.patches[0].stains)[0].passing());
  const auto with = gpu.image(scene, kWide, kHigh);
  drag(true);
  wound.stain(scene);
  ASSERT_NE(scene.patches[0].stains, nullptr);
  for (const Stain& stain : *scene.patches[0].stains) EXPECT_EQ(stain.ridges & 255U, 0U);
  const auto without = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(with.ok() && without.ok());
  EXPECT_NE(with->rgb, without->rgb);
}

// The grid that holds water, dust and blood ends; what is seen of them does not end in a straight
// edge there.
TEST(Wound, NothingEndsInAnEdgeWhereTheGridEnds) {
  Wound wound(kVoxel);
  Milling milling(wound);
  milling.on(Vec3::Zero(), 0.1, 1e-12, true);
  // as near to the border as the tool comes before the grid follows it
  for (int n = 1; n <= 95; ++n) milling.on(Vec3(n * 0.1e-3, 0, 0), 0.05, 1e-12, true);
  double most = 0, steepest = 0;
  float before = wound.at(Vec3(9e-3, 0, 0)).wet;
  for (double x = 9e-3; x < 20e-3; x += 0.02e-3) {
    const float wet = wound.at(Vec3(x, 0, 0)).wet;
    steepest = std::max(steepest, static_cast<double>(std::abs(wet - before)));
    most = std::max(most, static_cast<double>(wet));
    before = wet;
  }
  EXPECT_GT(most, 0.9);
  EXPECT_EQ(before, 0);
  EXPECT_LT(steepest, 0.03);
}

}  // namespace
}  // namespace burr::render
