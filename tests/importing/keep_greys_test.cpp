// The kept values of a scan compared with the scan itself.
#include "burr/importing/keep_greys.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

// 20 x 30 x 10 voxels at some place, oblique
io::Scan scan_of(const std::function<float(int, int, int)>& value) {
  io::Scan scan;
  scan.size = {20, 30, 10};
  scan.spacing_mm = {0.4, 0.5, 1.2};
  scan.axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  scan.origin_mm = {12, -40, 100};
  scan.hounsfield = true;
  for (int k = 0; k < scan.size.z(); ++k)
    for (int j = 0; j < scan.size.y(); ++j)
      for (int i = 0; i < scan.size.x(); ++i) scan.values.push_back(value(i, j, k));
  return scan;
}
Vec3 world(const io::Scan& scan, const Vec3& ijk) {
  return 1e-3 * (scan.origin_mm + scan.axes * ijk.cwiseProduct(scan.spacing_mm));
}

TEST(KeepGreys, KeepsWholeNumbersAndTheirPlaces) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> hu(-1024, 3071);
  const io::Scan scan = scan_of([&](int, int, int) { return static_cast<float>(hu(random)); });
  NoProgress quiet;
  const auto greys = keep_greys(scan, 300, quiet);
  ASSERT_NE(greys, nullptr);
  EXPECT_EQ(greys->iso, 300);
  EXPECT_TRUE(greys->hounsfield);
  std::size_t n = 0;
  double value = 0;
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 20; ++i, ++n) {
        ASSERT_TRUE(greys->at(world(scan, Vec3(i, j, k)), value));
        ASSERT_NEAR(value, static_cast<double>(scan.values[n]), 1e-6);
      }
  // half a voxel beyond the outermost centres still belongs to the scan
  EXPECT_TRUE(greys->at(world(scan, {-0.45, 29.45, 9.45}), value));
  EXPECT_FALSE(greys->at(world(scan, {-0.55, 10, 5}), value));
  EXPECT_FALSE(greys->at(world(scan, {10, 10, 9.55}), value));
}

// A linear field stays linear between voxels, within the steps, even where it is kept coarser.
TEST(KeepGreys, KeepsASlopeHoweverCoarse) {
  const auto slope = [](const Vec3& p) { return 3.7 * p.x() - 2.1 * p.y() + 11.3 * p.z() + 0.25; };
  const io::Scan scan =
      scan_of([&](int i, int j, int k) { return static_cast<float>(slope(Vec3(i, j, k))); });
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  NoProgress quiet;
  for (const std::size_t most : {std::size_t{10'000}, std::size_t{3000}, std::size_t{700}}) {
    SCOPED_TRACE(most);
    const auto greys = keep_greys(scan, 0, quiet, most);
    ASSERT_NE(greys, nullptr);
    EXPECT_LE(greys->stored.size(), most);
    EXPECT_GT(greys->stored.size(), most / 3) << "coarser than asked for";
    if (most == 3000) {
      EXPECT_TRUE((greys->size.array() == Ijk(10, 30, 10).array()).all());
    }
    if (most == 700) {  // then the middle axis is halved, then the first again
      EXPECT_TRUE((greys->size.array() == Ijk(5, 15, 10).array()).all() ||
                  (greys->size.array() == Ijk(5, 8, 10).array()).all());
    }
    for (int n = 0; n < 500; ++n) {
      // away from the border by the width of one kept voxel
      const Vec3 p(4 + 11 * any(random), 4 + 21 * any(random), 1 + 7 * any(random));
      double value = 0;
      ASSERT_TRUE(greys->at(world(scan, p), value));
      ASSERT_NEAR(value, slope(p), greys->step + 1e-3);
    }
  }
}

TEST(KeepGreys, HasNothingToKeepOfLabels) {
  io::Scan scan;
  scan.size = {2, 2, 2};
  scan.labels.assign(8, 1);
  NoProgress quiet;
  EXPECT_EQ(keep_greys(scan, 0, quiet), nullptr);
}

}  // namespace
}  // namespace burr::importing
