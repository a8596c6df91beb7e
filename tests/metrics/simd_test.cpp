// A bone that the burr cuts gives the same numbers, to the bit, whatever instruction set cut it.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "burr/edit/carve.h"
#include "burr/metrics/cover.h"
#include "burr/metrics/intact_solid.h"
#include "burr/metrics/new_surface.h"
#include "burr/metrics/opened.h"
#include "burr/metrics/overhang.h"
#include "burr/metrics/plane_fit.h"
#include "burr/metrics/removed.h"
#include "burr/metrics/skeletonised.h"
#include "burr/rt/simd.h"
#include "metrics/metric_bones.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using test::kMm;
using test::kUp;

constexpr double kVoxel = 0.4e-3;

// A nerve under a hard tube, and a closed room beside it.
test::Plan plan_of_bone() {
  test::Plan plan;
  const Vec3 left = {-20 * kMm, 0.1 * kMm, -3 * kMm}, right = {20 * kMm, 0.1 * kMm, -3 * kMm};
  const phantom::Depth nerve = phantom::capsule(left, right, 1 * kMm);
  const phantom::Depth room = phantom::ball(2 * kMm, {4.3 * kMm, 4.1 * kMm, 0});
  plan.bone = phantom::without(test::below(4 * kMm), phantom::either(nerve, room));
  plan.labels = {{nerve, test::kNerve},
                 {room, test::kCanal},
                 {phantom::capsule(left, right, 1.6 * kMm), test::kHard}};
  return plan;
}

// A trough towards the nerve, row by row with a burr of 2 mm, and a hole into the room.
void mill(volume::Bone& bone) {
  NoProgress quiet;
  volume::IsoVertices surface(bone, {}, 1, quiet);
  edit::UndoStore undo(bone, 4096);
  edit::BoneWriter writer(bone, surface, undo, nullptr);
  edit::Carver carver(writer, {});
  undo.begin_stroke(0);
  std::uint32_t flags = 0;
  const auto carve = [&](const Vec3& place) {
    carver.carve({.centre = bone.grid().grid_from_world(place),
                  .push = {0, 0, -1},
                  .radius = 2 * kMm / kVoxel,
                  .energy = 0.3},
                 flags);
  };
  for (double z = 5; z > 0.5; z -= 0.5)
    for (double y = -1.5; y < 2; y += 1)
      for (double x = -5; x <= 5; x += 0.5) carve(Vec3(x, y, z) * kMm);
  for (double z = 5; z > 0; z -= 0.2) carve(Vec3(4.3, 4.1, z) * kMm);
}

struct Numbers {
  std::vector<std::uint64_t> bits;
  void add(double number) { bits.push_back(std::bit_cast<std::uint64_t>(number)); }
  void add(const Mark& mark) {
    add(mark.value);
    add(mark.error);
  }
};

Numbers measured(const volume::Bone& before, const volume::Bone& after) {
  Numbers all;
  const std::vector<Vec3> towards = {kUp};
  const auto cover =
      cover_of(before, after, test::voxels_of(before, test::kNerve), {}, {.towards = towards});
  EXPECT_TRUE(cover) << cover.reason();
  for (const CoverSample& one : cover->samples) {
    all.add(one.cover);
    all.add(one.thickness);
  }
  const auto thin = skeletonised(*cover, 1, {});
  EXPECT_TRUE(thin) << thin.reason();
  all.add(thin->even);
  const auto solid = intact_solid(before, after, test::voxels_of(before, test::kHard), 1, {});
  EXPECT_TRUE(solid) << solid.reason();
  all.add(solid->mark);
  for (const SurfacePoint& one : new_surface(before, after, {})) {
    all.add(one.area);
    all.add(one.normal.x());
  }
  const std::array<volume::TissueId, 1> label = {test::kCanal};
  const VoxelSet room = VoxelSet::of_air(before, label, {});
  const auto open = opened(before, after, {.label = &room}, {.towards = towards});
  EXPECT_TRUE(open) << open.reason();
  EXPECT_TRUE(open->mark.met) << open->mark.value;
  all.add(open->mark);
  const auto under = overhang(before, after, {}, {.towards = towards});
  EXPECT_TRUE(under) << under.reason();
  all.add(under->mark);
  const auto plane = plane_fit(before, after, {{0, 0, -1 * kMm}, kUp}, {}, {});
  EXPECT_TRUE(plane) << plane.reason();
  all.add(plane->angle);
  all.add(plane->rms);
  const auto gone = removed_of(before, after, in_ball({0, 0, 2 * kMm}, 3 * kMm), {});
  EXPECT_TRUE(gone) << gone.reason();
  all.add(gone->share);
  all.add(gone->dice);
  return all;
}

TEST(Simd, ACutBoneGivesTheSameNumbersOnEverySet) {
  const test::Plan plan = plan_of_bone();
  const auto before = test::build(plan, plan.bone, kVoxel);
  const rt::Simd best = rt::simd();
  std::vector<std::uint64_t> first;
  for (const rt::Simd which : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(which);
    const auto after = test::build(plan, plan.bone, kVoxel);
    mill(*after);
    const Numbers numbers = measured(*before, *after);
    EXPECT_GT(numbers.bits.size(), 1000U);
    if (first.empty()) first = numbers.bits;
    EXPECT_EQ(numbers.bits, first) << rt::name(which);
  }
  rt::force_simd(best);
}

}  // namespace
}  // namespace burr::metrics
