// Back to the original: by hand, no touch involved.
#include "burr/edit/brush.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "burr/base/progress.h"
#include "burr/volume/volume_of.h"
#include "scenes/build.h"
#include "scenes/shapes.h"
#include "support/rt_guard.h"

namespace burr::edit {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm, kRadius = 2 * kMm;

struct Work {
  explicit Work(const scenes::Depth& depth)
      : bone(scenes::bone_from_distance(
            scenes::box_grid(Vec3::Constant(-6 * kMm), Vec3::Constant(6 * kMm), kVoxel), {}, depth,
            512)),
        surface(*bone, {}, 1, quiet),
        undo(*bone, 4096),
        changed(*bone),
        carver(*bone, surface, undo, &changed, {}),
        brush(*bone, undo, carver) {}

  [[nodiscard]] Vec3 grid(const Vec3& world) const { return bone->grid().grid_from_world(world); }
  void cut(const Vec3& c, double energy = 4e-2) {
    carver.carve(
        {.centre = grid(c), .push = {0, 0, -1}, .radius = kRadius / kVoxel, .energy = energy},
        flags);
    surface.refresh();
  }
  void add(const Vec3& c) {
    carver.deposit({.centre = grid(c),
                    .push = {0, 0, -1},
                    .radius = kRadius / kVoxel,
                    .volume = 1e-10,
                    .material = 2},
                   flags);
    surface.refresh();
  }
  void back(const Vec3& c) {
    brush.restore({.centre = grid(c), .push = {0, 0, -1}, .radius = kRadius / kVoxel}, flags);
    surface.refresh();
  }
  [[nodiscard]] double volume() const { return volume::volume_of(*bone); }
  // what is there now against what was there, by the ledger
  void expect_balance(double before) const {
    const Ledger is = carver.ledger();
    EXPECT_NEAR(is.asked, is.removed + is.debt + is.not_cut, 1e-9 * is.asked);
    EXPECT_NEAR(volume() - before, is.added - is.removed, 1e-9 * (is.added + is.removed));
  }

  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  UndoStore undo;
  ChangedQueue changed;
  Carver carver;
  Brush brush;
  std::uint32_t flags = 0;
};

// a slot and a heap of something else beside it
void spoil(Work& work) {
  work.undo.begin_stroke(0);
  for (double x = -2; x <= 2; x += 0.05) work.cut({x * kMm, 0, 1 * kMm});
  for (int n = 0; n < 200; ++n) work.add({0, 3 * kMm, 2 * kMm});
  work.undo.end_stroke();
}

// the burr above the original surface, everywhere
void brush_all(Work& work, int ticks) {
  for (double x = -4; x <= 4; x += 1)
    for (double y = -4; y <= 5; y += 1)
      for (int n = 0; n < ticks; ++n)
        for (const double lower : {1.5, 1.0, 0.5, 0.0})
          work.back({x * kMm, y * kMm, kRadius - lower * kMm});
}

TEST(BackToTheOriginal, BrushedAllOverItIsTheOriginalToTheByteTissueAndAll) {
  Work work(scenes::slab());
  const double before = work.volume();
  const std::uint64_t hash = work.bone->content_hash();
  spoil(work);
  EXPECT_GT(work.carver.ledger().removed, 1e-9);
  EXPECT_GT(work.carver.ledger().added, 1e-9);
  const std::uint64_t spoilt = work.bone->content_hash();
  ASSERT_NE(spoilt, hash);
  work.expect_balance(before);

  work.undo.begin_stroke(0);
  brush_all(work, 60);
  work.undo.end_stroke();
  EXPECT_EQ(work.bone->content_hash(), hash);
  EXPECT_NEAR(work.volume(), before, 1e-12 * before);
  work.expect_balance(before);
  EXPECT_EQ(work.flags & ~(1U << 14), 0U) << "nothing but what the burr was too blunt to cut";

  // and that is a stroke like any other
  UndoStore::Range range = work.undo.undo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.carver.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), spoilt);
  range = work.undo.redo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.carver.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), hash);
}

TEST(BackToTheOriginal, IsBoundedAndStaysWithinItsReachAndOutOfTheBurr) {
  Work work(scenes::slab());
  spoil(work);
  work.undo.begin_stroke(0);
  const volume::Grid& grid = work.bone->grid();
  const auto field = [&] {
    std::vector<int> all;
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) all.push_back(work.bone->field(i, j, k));
    return all;
  };
  const Vec3 at = {0.3 * kMm, 0.1 * kMm, 1 * kMm}, centre = work.grid(at);
  const double most = Brush::kSpeed * 1e-3 / kVoxel * volume::kFieldPerVoxel + 1;
  auto before = field();
  int changed = 0;
  for (int tick = 0; tick < 400; ++tick) {
    work.back(at);
    const auto now = field();
    std::size_t v = 0;
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i, ++v) {
          const int by = now[v] - before[v];
          if (by == 0) continue;
          ++changed;
          const double d = (Vec3(i, j, k) - centre).norm();
          ASSERT_LE(std::abs(by), most);
          ASSERT_LE(d, kRadius / kVoxel + Brush::kReach);
          if (by > 0) {
            ASSERT_LE(now[v],
                      32768 + (d - kRadius / kVoxel + Brush::kInto) * volume::kFieldPerVoxel + 1);
          }
        }
    before = now;
    if (tick == 20) {
      ASSERT_GT(changed, 100);
    }
  }
}

TEST(BackToTheOriginal, WhereNothingWasChangedNothingHappens) {
  Work work(scenes::slab());
  const std::uint64_t hash = work.bone->content_hash();
  work.undo.begin_stroke(0);
  for (int n = 0; n < 100; ++n) work.back({0, 0, kRadius});
  EXPECT_EQ(work.bone->content_hash(), hash);
  EXPECT_EQ(work.undo.touched(), 0U);
  EXPECT_EQ(work.carver.ledger().added, 0);
}

TEST(BackToTheOriginal, TakesNeitherMemoryNorLock) {
  Work work(scenes::slab());
  spoil(work);
  work.undo.begin_stroke(0);
  const test::RtGuard guard;
  for (int n = 0; n < 300; ++n) work.back({0.01 * n * kMm, 0, 1 * kMm});
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

}  // namespace
}  // namespace burr::edit
