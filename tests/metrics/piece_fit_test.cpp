// Gap, step and contact of a box beside a box, against what was drawn.
#include "burr/metrics/piece_fit.h"

#include <gtest/gtest.h>

#include <memory>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"

namespace burr::metrics {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;

std::unique_ptr<volume::Bone> box_at(const Vec3& half_mm, const Vec3& at_mm,
                                     const Quat& turn = Quat::Identity()) {
  const phantom::Depth box = phantom::box(half_mm * kMm);
  const Pose there{at_mm * kMm, turn};
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3(-12, -8, -8) * kMm, Vec3(14, 8, 8) * kMm, kVoxel), {},
      [=](const Vec3& p) { return box(there.inverse() * p); });
}

TEST(PieceFit, AGapAndAStepAreAsDrawn) {
  // faces of 8 x 8 mm, 1.2 mm apart, shifted by 0.6 mm along z
  const auto other = box_at({5, 4, 4}, {-5, 0, 0}), piece = box_at({5, 4, 4}, {6.2, 0, 0.6});
  const PieceFit fit = piece_fit(*piece, *other);
  EXPECT_NEAR(fit.gap, 1.2 * kMm, 0.1 * kVoxel);
  EXPECT_NEAR(fit.gap_most, 1.2 * kMm, 0.5 * kVoxel);
  EXPECT_NEAR(fit.facing, 8 * 7.4 * kMm * kMm, 0.1 * 8 * 7.4 * kMm * kMm)
      << "the edges, which voxels round off, face nothing";
  EXPECT_EQ(fit.contact, 0);
  ASSERT_TRUE(fit.has_step);
  // two of the four sides are shifted
  EXPECT_NEAR(fit.step, 0.3 * kMm, 0.08 * kMm);
  EXPECT_NEAR(fit.step_most, 0.6 * kMm, 0.1 * kMm);
}

TEST(PieceFit, FlushFacesTouchAndHaveNoStep) {
  const auto other = box_at({5, 4, 4}, {-5, 0, 0}), piece = box_at({5, 4, 4}, {5.1, 0, 0});
  const PieceFit fit = piece_fit(*piece, *other);
  EXPECT_NEAR(fit.gap, 0.1 * kMm, 0.2 * kVoxel);
  EXPECT_NEAR(fit.contact, 64 * kMm * kMm, 0.08 * 64 * kMm * kMm);
  EXPECT_LT(fit.step, 0.5 * kVoxel) << "voxels round the edges off";
}

TEST(PieceFit, OverlapIsAGapBelowZero) {
  const auto other = box_at({5, 4, 4}, {-5, 0, 0}), piece = box_at({5, 3, 3}, {4.5, 0, 0});
  const PieceFit fit = piece_fit(*piece, *other);
  EXPECT_LT(fit.gap, -0.3 * kMm);
}

TEST(PieceFit, FarAwayNothingFaces) {
  const auto other = box_at({4, 4, 4}, {-8, 0, 0}), piece = box_at({4, 4, 4}, {10, 0, 0});
  const PieceFit fit = piece_fit(*piece, *other);
  EXPECT_EQ(fit.facing, 0);
  EXPECT_FALSE(fit.has_step);
}

}  // namespace
}  // namespace burr::metrics
