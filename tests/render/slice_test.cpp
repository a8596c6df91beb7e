// Slices compared with the shapes they cut: positions, sizes, tissues, and that they follow the
// cut.
#include "burr/render/slice.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <thread>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"

namespace burr::render {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

// A ball of 6 mm to the left, in front and above.
const Vec3 kCentre = {5 * kMm, -4 * kMm, 3 * kMm};
std::unique_ptr<volume::Bone> bone() {
  return phantom::bone_from_distance(phantom::cube_grid(30 * kMm, 100), {},
                                     phantom::ball(6 * kMm, kCentre), 64);
}

bool light(const Image& image, std::size_t at) { return image.rgb[3 * at] > 115; }

struct Seen {
  double area = 0;                                   // [m^2]
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // [pixel]
};
Seen look(const Image& image, const Slice& slice) {
  Seen seen;
  double count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!light(image, static_cast<std::size_t>(y * image.width + x))) continue;
      ++count;
      seen.middle += Eigen::Vector2d(x + 0.5, y + 0.5);
    }
  const double pixel = slice.height / image.height;
  seen.area = count * pixel * pixel;
  seen.middle /= std::max(1.0, count);
  return seen;
}

TEST(Slice, ShowsEachPlaneTheRightWayRound) {
  auto ball = bone();
  Slicer slicer(*ball);
  // the ball's middle, seen from the origin: right and up in the picture, as the header says
  const struct {
    Plane plane;
    double right, up, off;
  } cases[] = {{Plane::axial, 5, 4, 3}, {Plane::coronal, 5, 3, 4}, {Plane::sagittal, -4, 3, 5}};
  for (const auto& one : cases) {
    Slice slice;
    slice.plane = one.plane;
    slice.height = 24 * kMm;
    Image image{480, 360, {}};
    EXPECT_TRUE(slicer.draw(slice, image));
    const Seen seen = look(image, slice);
    const double per_mm = 360.0 / 24;
    EXPECT_NEAR(seen.middle.x(), 240 + per_mm * one.right, 1) << static_cast<int>(one.plane);
    EXPECT_NEAR(seen.middle.y(), 180 - per_mm * one.up, 1) << static_cast<int>(one.plane);
    // a plane at distance `off` from the middle of a ball cuts a smaller disc
    const double r2 = 36 - one.off * one.off;
    EXPECT_NEAR(seen.area, std::numbers::pi * r2 * kMm * kMm, 0.01 * r2 * 3 * kMm * kMm);
    // the position that the pixels show
    const Vec3 middle = point_of(slice, seen.middle, image.width, image.height);
    const Eigen::Vector2d again = pixel_of(slice, middle, image.width, image.height);
    EXPECT_NEAR((again - seen.middle).norm(), 0, 1e-9);
    EXPECT_NEAR((middle - kCentre).norm(), one.off * kMm, 0.1 * kMm);
  }
}

TEST(Slice, FollowsTheCut) {
  auto ball = bone();
  Slicer slicer(*ball);
  Slice slice;
  slice.through = kCentre;
  slice.height = 20 * kMm;
  Image before{200, 200, {}}, after = before, again = before;
  EXPECT_TRUE(slicer.draw(slice, before));
  // a brick within the ball is removed
  const Vec3 at = ball->grid().grid_from_world(kCentre);
  const volume::BrickIndex brick = ball->brick_at(
      static_cast<int>(at.x()) / 8, static_cast<int>(at.y()) / 8, static_cast<int>(at.z()) / 8);
  volume::BrickField nothing = {};
  ball->ensure_slot(brick);
  ball->write_brick(brick, nothing);
  EXPECT_TRUE(slicer.draw(slice, after));
  const double taken = look(before, slice).area - look(after, slice).area;
  const double edge = 8 * ball->grid().voxel;
  EXPECT_NEAR(taken, edge * edge, 0.35 * edge * edge);
  EXPECT_TRUE(slicer.draw(slice, again));
  EXPECT_EQ(after.rgb, again.rgb);
}

TEST(Slice, ColoursTissuesAndCanLeaveThatOut) {
  volume::TissueTable table;
  table.tissues[1].colour = {0, 0, 1};
  auto ball = phantom::bone_from_distance(phantom::cube_grid(30 * kMm, 60), table,
                                          phantom::ball(6 * kMm), 64);
  Slicer slicer(*ball);
  Slice slice;
  Image image{21, 21, {}};
  const std::size_t middle = 3 * (21 * 10 + 10);
  slicer.draw(slice, image);
  EXPECT_EQ(image.rgb[middle], 0);
  EXPECT_EQ(image.rgb[middle + 2], 255);
  slice.labels = false;
  slicer.draw(slice, image);
  EXPECT_GT(image.rgb[middle], 200);
}

// The scan has 1000 HU within 6 mm, 40 around it. It is shown as it was measured, except where bone
// was removed and where some was added.
TEST(Slice, ShowsWhatTheScanMeasuredAndWhatHasBecomeOfIt) {
  auto ball = bone();
  volume::Greys greys;
  greys.size = {60, 60, 60};
  greys.spacing = Vec3::Constant(0.5 * kMm);
  greys.origin = kCentre - Vec3::Constant(29.5 * 0.5 * kMm);
  greys.least = -1000;
  greys.top = 1000;
  greys.iso = 300;
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i) {
        const Vec3 p = greys.origin + 0.5 * kMm * Vec3(i, j, k);
        greys.stored.push_back((p - kCentre).norm() < 6 * kMm ? 2000 : 1040);
      }
  Slicer slicer(*ball);
  Slice slice;
  slice.through = kCentre;
  slice.height = 20 * kMm;
  slice.labels = false;
  slice.greys = &greys;
  slice.window = 2000;
  slice.level = 500;
  Image image{200, 200, {}};
  const auto grey_at = [&](const Vec3& p) {
    EXPECT_TRUE(slicer.draw(slice, image));
    const Eigen::Vector2d at = pixel_of(slice, p, 200, 200);
    return image.rgb[3 * static_cast<std::size_t>(static_cast<int>(at.y()) * 200 +
                                                  static_cast<int>(at.x()))] /
           255.0;
  };
  const Vec3 around = kCentre + Vec3(8 * kMm, 0, 0);
  EXPECT_NEAR(grey_at(kCentre), (1000 - 500) / 2000.0 + 0.5, 0.01);
  EXPECT_NEAR(grey_at(around), (40 - 500) / 2000.0 + 0.5, 0.01);
  slice.window = 400;
  slice.level = 40;
  EXPECT_NEAR(grey_at(kCentre), 1, 0.01);
  EXPECT_NEAR(grey_at(around), 0.5, 0.01);

  const auto brick_of = [&](const Vec3& p) {
    const Vec3 at = ball->grid().grid_from_world(p);
    return ball->brick_at(static_cast<int>(at.x()) / 8, static_cast<int>(at.y()) / 8,
                          static_cast<int>(at.z()) / 8);
  };
  const auto write = [&](volume::BrickIndex brick, volume::Field value) {
    volume::BrickField field = {};
    std::fill(std::begin(field.voxel), std::end(field.voxel), value);
    ball->ensure_slot(brick);
    ball->write_brick(brick, field);
  };
  write(brick_of(kCentre), 0);
  write(brick_of(around), volume::kSolid);
  EXPECT_LT(grey_at(kCentre), 0.1) << "what is gone is dark";
  EXPECT_NEAR(grey_at(around), 0.86, 0.02) << "what was added is bone";
  EXPECT_NEAR(grey_at(kCentre - Vec3(4 * kMm, 0, 0)), 1, 0.01) << "the rest is as it was";
}

// While another thread writes, no brick is ever shown half old and half new.
TEST(Slice, BesideAWriterEachBrickIsOneOrTheOther) {
  auto ball = bone();
  Slicer slicer(*ball);
  const Vec3 at = ball->grid().grid_from_world(kCentre);
  const volume::BrickIndex brick = ball->brick_at(
      static_cast<int>(at.x()) / 8, static_cast<int>(at.y()) / 8, static_cast<int>(at.z()) / 8);
  ball->ensure_slot(brick);
  std::jthread servo([&](const std::stop_token& stop) {
    volume::BrickField all = {}, none = {};
    std::fill(std::begin(all.voxel), std::end(all.voxel), volume::kSolid);
    // without a pause now and then, a reader on another core might never find a complete brick
    bool solid = true;
    for (int n = 1; !stop.stop_requested(); ++n, solid = !solid) {
      ball->write_brick(brick, solid ? all : none);
      if (n % 16 == 0) std::this_thread::sleep_for(std::chrono::microseconds(10));
    }
  });
  // voxel centres of one layer of the brick, no interpolation
  const math::Ijk corner = ball->brick_ijk(brick);
  const Vec3 middle = ball->grid().world_from_grid(corner.cast<double>() + Vec3(3.5, 3.5, 3));
  Slice slice;
  slice.through = middle;
  slice.height = 8 * ball->grid().voxel;
  Image image{8, 8, {}};
  int drawn = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (drawn < 1000 && std::chrono::steady_clock::now() < end) {
    if (!slicer.draw(slice, image)) continue;
    ++drawn;
    int lit = 0;
    for (std::size_t p = 0; p < 64; ++p) lit += light(image, p) ? 1 : 0;
    ASSERT_TRUE(lit == 0 || lit == 64) << lit;
  }
  EXPECT_EQ(drawn, 1000);
}

}  // namespace
}  // namespace burr::render
