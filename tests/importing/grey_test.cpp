// The grey values of a scan while bone is made of it: smoothing against its formula in double
// precision, and resampling of values that are known.
#include "burr/importing/grey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "burr/importing/smooth_kernel.h"
#include "burr/rt/simd.h"

namespace burr::importing {
namespace {

constexpr int kSide = 16;  // voxels of a cube
constexpr int kLanes = 8;
constexpr std::int16_t kUntouched = -32768;

// All neighbours within two voxels, as smooth_near() makes them for cubic voxels.
class SmoothKernel : public ::testing::Test {
 protected:
  void SetUp() override {
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> noise(-200, 200);
    for (int k = 0; k < kSide; ++k)
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
          values_.push_back(static_cast<std::int16_t>(150 * i + 80 * j - 60 * k + noise(random)));
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
          neighbours_.push_back({x + kSide * (y + std::ptrdiff_t{kSide} * z),
                                 static_cast<float>(std::exp(-(x * x + y * y + z * z) / 3.38)),
                                 static_cast<float>(x), static_cast<float>(y),
                                 static_cast<float>(z)});
    rule_.neighbours = neighbours_.data();
    rule_.count = static_cast<int>(neighbours_.size());
    rule_.range = 1.0F / (9 * 120 * 120);
    for (const SmoothNeighbour& o : neighbours_) {
      rule_.moment_x += o.weight * o.x * o.x;
      rule_.moment_y += o.weight * o.y * o.y;
      rule_.moment_z += o.weight * o.z * o.z;
    }
  }

  // The formula of smooth_kernel.inc for one voxel, with loops instead of lanes, in double.
  [[nodiscard]] double formula(const std::int16_t* at) const {
    std::array<double, 3> g = {};
    for (const SmoothNeighbour& o : neighbours_) {
      const double v = double{o.weight} * at[o.move];
      g[0] += v * double{o.x};
      g[1] += v * double{o.y};
      g[2] += v * double{o.z};
    }
    g[0] /= double{rule_.moment_x};
    g[1] /= double{rule_.moment_y};
    g[2] /= double{rule_.moment_z};
    const double slope = std::hypot(g[0], g[1], g[2]) + 1e-12;
    double sum = 0, weights = 0;
    for (const SmoothNeighbour& o : neighbours_) {
      const double across = (g[0] * double{o.x} + g[1] * double{o.y} + g[2] * double{o.z}) / slope;
      const double value = at[o.move] - slope * across, d = value - at[0];
      const double falls = (1 + d * d * double{rule_.range}) * (1 + 3 * across * across);
      const double w = double{o.weight} / (falls * falls);
      sum += w * value;
      weights += w;
    }
    return sum / weights;
  }

  [[nodiscard]] const std::int16_t* middle() const {
    return values_.data() + 4 + kSide * (kSide / 2 + std::ptrdiff_t{kSide} * (kSide / 2));
  }

  static constexpr unsigned kSeed = 11;
  std::vector<std::int16_t> values_;
  std::vector<SmoothNeighbour> neighbours_;
  SmoothRule rule_;
};

TEST_F(SmoothKernel, IsTheFormulaRoundedToTheNearestWholeNumberOnEveryInstructionSet) {
  std::vector<SmoothEight> kernels = {scalar::smooth_eight};
  if constexpr (rt::kWideKernels)
    if (rt::simd() != rt::Simd::scalar) kernels.push_back(avx2::smooth_eight);
  std::array<std::int16_t, kLanes> first = {};
  for (const SmoothEight kernel : kernels) {
    std::array<std::int16_t, kLanes> out = {};
    kernel(middle(), rule_, kLanes, out.data());
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      EXPECT_NEAR(out[lane], formula(middle() + lane), 0.5 + 0.02) << lane;
      EXPECT_GT(std::abs(out[lane] - middle()[lane]), 0) << "noise of 200 hardly ever stays";
    }
    if (kernel == kernels.front()) first = out;
    EXPECT_EQ(out, first);
  }
}

TEST_F(SmoothKernel, WritesOnlyTheLanesThatItMay) {
  std::array<std::int16_t, kLanes> out;
  out.fill(kUntouched);
  scalar::smooth_eight(middle(), rule_, 3, out.data());
  EXPECT_NE(out[2], kUntouched);
  EXPECT_TRUE(std::all_of(out.begin() + 3, out.end(), [](auto v) { return v == kUntouched; }));
}

// Catmull-Rom keeps a slope exactly, so what is left is the rounding: half a grey value, not one.
TEST(Resample, KeepsASlopeToTheNearestWholeNumber) {
  constexpr double kSlope = 3.7, kScale = 0.8, kFirst = 0.3;
  Grey grey;
  grey.size = {40, 6, 6};
  for (int n = 0; n < 40 * 6 * 6; ++n)
    grey.voxels.push_back(static_cast<std::int16_t>(std::lround(10 * kSlope * (n % 40))));
  NoProgress quiet;
  ASSERT_TRUE(resample(grey, {{40, 6, 6}, {kScale, 1, 1}, {kFirst, 0, 0}}, quiet));
  for (int i = 3; i < 40; ++i)
    EXPECT_NEAR(grey.voxels[static_cast<std::size_t>(i)], 10 * kSlope * (kFirst + kScale * i), 0.53)
        << i;
}

// A level that no 16-bit value reaches: there is no surface, and nothing is smoothed.
TEST(SmoothNear, LeavesAScanWithoutASurfaceAsItIs) {
  for (const double iso : {40000.0, -40000.0}) {
    Grey grey;
    grey.size = {12, 12, 12};
    for (int n = 0; n < 12 * 12 * 12; ++n) grey.voxels.push_back(static_cast<std::int16_t>(n));
    const std::vector<std::int16_t> before = grey.voxels;
    NoProgress quiet;
    ASSERT_TRUE(smooth_near(grey, iso, 10, {1, 1, 1}, false, quiet));
    EXPECT_EQ(grey.voxels, before) << iso;
  }
}

}  // namespace
}  // namespace burr::importing
