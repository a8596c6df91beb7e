// Depth of field, against the edge that a disc makes of a sharp one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/formula_surfaces.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr int kWide = 360, kHigh = 240;
constexpr double kEye = 0.25;     // above the plane z = 0 [m]
constexpr double kField = 24e-3;  // height of the picture there [m]

// A plate at height z that ends at x = 0 and fills the left half of a picture from +z.
Scene plate(double z) {
  surface::Patch patch;
  constexpr float kFar = 0.1F;
  for (const auto& [x, y] : {std::pair{-kFar, -kFar}, {0.F, -kFar}, {0.F, kFar}, {-kFar, kFar}})
    patch.vertices.push_back(
        {{x, y, static_cast<float>(z)}, math::Vec3f::UnitZ(), volume::TissueId{1}});
  patch.triangles = {0, 1, 2, 0, 2, 3};
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, {0.9F, 0.9F, 0.9F}};
  set_patch(scene, 0, patch);
  scene.camera.target = Vec3::Zero();
  scene.camera.elevation = 0.5 * std::numbers::pi - 1e-6;
  scene.camera.distance = kEye;
  scene.camera.field_of_view = 2 * std::atan(0.5 * kField / kEye);
  scene.look = still_look();
  scene.look.plain = true;
  scene.look.background_top = scene.look.background_bottom = {0, 0, 0};
  return scene;
}

double linear(std::uint8_t value) {
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Light along the middle row, 1 in the middle of the plate.
std::vector<double> row(const Image& image) {
  std::vector<double> light;
  for (int x = 0; x < image.width; ++x)
    light.push_back(
        linear(image.rgb[static_cast<std::size_t>(3 * (image.height / 2 * image.width + x))]));
  const double plateau = light[static_cast<std::size_t>(image.width / 8)];
  for (double& one : light) one /= plateau;
  return light;
}

// The share of a disc of that radius around x that lies at x < 0.
double covered(double x, double radius) {
  const double u = std::clamp(x / radius, -1.0, 1.0);
  return 0.5 - (u * std::sqrt(1 - u * u) + std::asin(u)) / std::numbers::pi;
}

TEST(DepthOfField, AnEdgeIsAsWideAsTheDiscOfItsDepth) {
  for (const double z : {5e-3, 8e-3, -6e-3}) {
    SCOPED_TRACE(z);
    BURR_NEEDS_GPU(gpu);  // a new one, which has not yet got the patch of another height
    Scene scene = plate(z);
    const double depth = kEye - z;
    const Focus focus{kEye, 30e-3};
    scene.focus = focus;
    const auto image = gpu.image(scene, kWide, kHigh);
    ASSERT_TRUE(image.ok()) << image.error().text;
    // from the plane in focus to pixels; a point at x = 0 stays in the middle
    const double radius = 0.5 * focus.aperture * std::abs(depth - kEye) / depth * kHigh / kField;
    ASSERT_GT(radius, 3);
    const std::vector<double> light = row(*image);
    double worst = 0;
    for (int x = kWide / 8; x < kWide; ++x) {
      const double at = x + 0.5 - kWide / 2;
      worst = std::max(worst, std::abs(light[static_cast<std::size_t>(x)] - covered(at, radius)));
    }
    EXPECT_LT(worst, 0.09) << "disc of " << radius << " pixels";
    // and it is that wide, no more and no less: from 90 to 10 %
    const auto crosses = [&](double level) {
      int x = kWide / 8;
      while (light[static_cast<std::size_t>(x)] > level) ++x;
      return x;
    };
    constexpr double kTenth = 0.687;  // of the radius: covered(0.687 r, r) = 0.1
    EXPECT_NEAR(crosses(0.1) - crosses(0.9), 2 * kTenth * radius, 1.6);
  }
}

TEST(DepthOfField, ThePlaneInFocusIsAsSharpAsWithoutIt) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = plate(0);
  const auto without = gpu.image(scene, kWide, kHigh);
  scene.focus = Focus{kEye, 12e-3};
  const auto with = gpu.image(scene, kWide, kHigh);
  ASSERT_TRUE(without.ok() && with.ok());
  int most = 0;
  for (std::size_t n = 0; n < with->rgb.size(); ++n)
    most = std::max(most, std::abs(int{with->rgb[n]} - int{without->rgb[n]}));
  EXPECT_LE(most, 12) << "the edge itself may differ by rounding";
}

TEST(DepthOfField, IsTheSameInTilesAndInTheWindow) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = plate(5e-3);
  set_patch(scene, 1, test::ball({3e-3, 0, -4e-3}, 3e-3, 30));
  scene.focus = Focus{kEye, 10e-3};
  scene.look.supersample = 1;
  const auto whole = gpu.image(scene, kWide, kHigh);
  const auto tiled = gpu.image(scene, kWide, kHigh, 96);
  ASSERT_TRUE(whole.ok() && tiled.ok());
  // the place of a look is rounded, in a tile from another corner
  int other = 0, most = 0;
  for (std::size_t n = 0; n < whole->rgb.size(); ++n) {
    const int off = std::abs(int{whole->rgb[n]} - int{tiled->rgb[n]});
    other += off > 0 ? 1 : 0;
    most = std::max(most, off);
  }
  EXPECT_LT(other, static_cast<int>(whole->rgb.size() / 200));
  EXPECT_LE(most, 8);
  gpu.resize_offscreen(kWide, kHigh);
  scene.quality.refine = true;
  ASSERT_TRUE(gpu.show(scene));
  ASSERT_TRUE(gpu.show(scene));  // the second time nothing has moved
  EXPECT_TRUE(gpu.shown().rgb == whole->rgb);
  scene.focus.reset();
  ASSERT_TRUE(gpu.show(scene));
  EXPECT_FALSE(gpu.shown().rgb == whole->rgb) << "sharp again, though only the lens changed";
}

}  // namespace
}  // namespace burr::render
