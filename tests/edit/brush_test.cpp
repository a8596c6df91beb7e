// Restore and smooth, with a burr moved by the test, without touch.
#include "burr/edit/brush.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <cstdio>
#include <numbers>
#include <vector>

#include "burr/base/progress.h"
#include "burr/edit/carve.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"
#include "support/rt_guard.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickIndex;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm, kRadius = 2 * kMm;

struct Work {
  explicit Work(const phantom::Depth& depth, double half = 6 * kMm)
      : bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-half), Vec3::Constant(half), kVoxel), {}, depth,
            512)),
        surface(*bone, {}, 1, quiet),
        undo(*bone, 4096),
        changed(*bone),
        writer(*bone, surface, undo, &changed),
        carver(writer, {}),
        brush(writer) {}

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
  // Compares the present volume with the earlier one, by the ledger.
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
  BoneWriter writer;
  Carver carver;
  Brush brush;
  std::uint32_t flags = 0;
};

// Cuts a slot and adds a heap of another tissue beside it.
void spoil(Work& work) {
  work.undo.begin_stroke(0);
  for (double x = -2; x <= 2; x += 0.05) work.cut({x * kMm, 0, 1 * kMm});
  for (int n = 0; n < 200; ++n) work.add({0, 3 * kMm, 2 * kMm});
  work.undo.end_stroke();
}

// Moves the burr over the whole original surface.
void brush_all(Work& work, int ticks) {
  for (double x = -4; x <= 4; x += 1)
    for (double y = -4; y <= 5; y += 1)
      for (int n = 0; n < ticks; ++n)
        for (const double lower : {1.5, 1.0, 0.5, 0.0})
          work.back({x * kMm, y * kMm, kRadius - lower * kMm});
}

TEST(BackToTheOriginal, BrushedAllOverItIsTheOriginalToTheByteTissueAndAll) {
  Work work(phantom::slab());
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

  // this is a stroke like any other
  UndoStore::Range range = work.undo.undo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.writer.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), spoilt);
  range = work.undo.redo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.writer.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), hash);
}

TEST(BackToTheOriginal, IsBoundedAndStaysWithinItsReachAndOutOfTheBurr) {
  Work work(phantom::slab());
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
  const auto first = field();
  auto before = first;
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
          // where bricks take slices of time, some are up to that many ticks ahead
          ASSERT_LE(std::abs(now[v] - first[v]), (tick + 8) * most);
          ASSERT_LE(d, kRadius / kVoxel + Brush::kReach);
          if (by > 0) {
            ASSERT_LE(
                now[v],
                32768 + (d - kRadius / kVoxel + Brush::kOverlap) * volume::kFieldPerVoxel + 1);
          }
        }
    before = now;
    if (tick == 20) {
      ASSERT_GT(changed, 100);
    }
  }
}

TEST(BackToTheOriginal, WhereNothingWasChangedNothingHappens) {
  Work work(phantom::slab());
  const std::uint64_t hash = work.bone->content_hash();
  work.undo.begin_stroke(0);
  for (int n = 0; n < 100; ++n) work.back({0, 0, kRadius});
  EXPECT_EQ(work.bone->content_hash(), hash);
  EXPECT_EQ(work.undo.touched(), 0U);
  EXPECT_EQ(work.carver.ledger().added, 0);
}

TEST(BackToTheOriginal, TakesNeitherMemoryNorLock) {
  Work work(phantom::slab());
  spoil(work);
  work.undo.begin_stroke(0);
  const test::RtGuard guard;
  for (int n = 0; n < 300; ++n) work.back({0.01 * n * kMm, 0, 1 * kMm});
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

// ---- smoothing, with a burr that rests on all parts of a ball or a plane

constexpr double kBall = 4.5 * kMm;

void smooth(Work& work, const Vec3& on_surface, const Vec3& outward, double dt = 1e-3) {
  work.brush.smooth({.centre = work.grid(on_surface + kRadius * outward),
                     .push = -outward,
                     .radius = kRadius / kVoxel,
                     .dt = dt},
                    work.flags);
  work.surface.refresh();
}

// Directions spread evenly around a ball.
std::vector<Vec3> about(int count) {
  std::vector<Vec3> all;
  for (int n = 0; n < count; ++n) {
    const double z = 1 - (2 * n + 1.0) / count, turn = n * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    all.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return all;
}

// Distance of the surface from the middle, in a direction  [m]
double radius_at(const Work& work, const Vec3& way) {
  double solid = 2 * kMm, air = 5.8 * kMm;
  for (int n = 0; n < 40; ++n) {
    const double r = 0.5 * (solid + air);
    (volume::sample(*work.bone, work.grid(r * way)) >= 0.5 ? solid : air) = r;
  }
  return 0.5 * (solid + air);
}

struct Shape {
  double mean = 0, rough = 0;  // of the radius, and root mean square around it       [m]
};
Shape shape_of(const Work& work) {
  Shape is;
  double squares = 0;
  const auto ways = about(2000);
  for (const Vec3& way : ways) {
    const double r = radius_at(work, way);
    is.mean += r / static_cast<double>(ways.size());
    squares += r * r / static_cast<double>(ways.size());
  }
  is.rough = std::sqrt(std::max(0.0, squares - is.mean * is.mean));
  return is;
}

// A ball with hills and hollows of half a voxel, about two millimetres apart.
double rippled(const Vec3& p) {
  const double k = 2 * std::numbers::pi / (2 * kMm);
  return kBall - p.norm() +
         0.5 * kVoxel * std::sin(k * p.x()) * std::sin(k * p.y() + 1) * std::sin(k * p.z() + 2) * 2;
}

TEST(Smooth, ABallLosesItsRippleAndKeepsItsRadius) {
  Work work(rippled);
  const double before = work.volume();
  const Shape rough = shape_of(work);
  EXPECT_GT(rough.rough, 0.2 * kVoxel);
  work.undo.begin_stroke(0);
  for (int round = 0; round < 25; ++round)
    for (const Vec3& way : about(120))
      for (int n = 0; n < 4; ++n) smooth(work, kBall * way, way);
  const Shape is = shape_of(work);
  std::printf("rough %.4f -> %.4f voxel, radius %.4f -> %.4f voxel, volume %+.3f %%\n",
              rough.rough / kVoxel, is.rough / kVoxel, rough.mean / kVoxel, is.mean / kVoxel,
              100 * (work.volume() / before - 1));
  EXPECT_LT(is.rough, rough.rough / 4);
  EXPECT_NEAR(is.mean, kBall, 0.1 * kVoxel);
  EXPECT_NEAR(work.volume(), before, 0.01 * before);
  work.expect_balance(before);
  EXPECT_EQ(work.flags, 0U);
}

TEST(Smooth, ARoundBallStaysAsItIsHoweverLong) {
  Work work(phantom::ball(kBall));
  const double before = work.volume();
  work.undo.begin_stroke(0);
  for (int round = 0; round < 20; ++round)
    for (const Vec3& way : about(120))
      for (int n = 0; n < 4; ++n) smooth(work, kBall * way, way);
  const Shape is = shape_of(work);
  std::printf("rough %.4f voxel, radius %+.4f voxel, volume %+.3f %%\n", is.rough / kVoxel,
              (is.mean - kBall) / kVoxel, 100 * (work.volume() / before - 1));
  EXPECT_NEAR(is.mean, kBall, 0.1 * kVoxel);
  EXPECT_LT(is.rough, 0.05 * kVoxel);
  work.expect_balance(before);
}

TEST(Smooth, APlaneStaysToTheByteWhateverItsSlant) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(0.3, -0.2, 1), Vec3(2, 1, 0)}) {
    const Vec3 out = normal.normalized();
    Work work(phantom::slab(out, 0.07 * kMm * out));
    const std::uint64_t hash = work.bone->content_hash();
    work.undo.begin_stroke(0);
    for (int n = 0; n < 1000; ++n)
      // long ticks: the largest share that is possible
      smooth(work, 0.07 * kMm * out + 0.001 * n * kMm * out.unitOrthogonal(), out, 10e-3);
    EXPECT_EQ(work.bone->content_hash(), hash) << normal.transpose();
    EXPECT_EQ(work.carver.ledger().removed, 0);
    EXPECT_EQ(work.carver.ledger().added, 0);
  }
}

TEST(Smooth, AStepIsRoundedOverManyVoxelsAndTheRampComesAlong) {
  // two planes, four voxels apart in height: air at the foot of the step must become bone
  Work work([](const Vec3& p) { return std::max(-1 * kMm - p.z(), std::min(-p.z(), -p.x())); });
  const double before = work.volume();
  work.undo.begin_stroke(0);
  for (int n = 0; n < 4000; ++n)
    for (const double y : {-1.0, 0.0, 1.0}) smooth(work, {0, y * kMm, -0.5 * kMm}, {0, 0, 1});
  const auto steep = [&](double x) {  // depth per voxel, at the surface          [voxel]
    double solid = -3 * kMm, air = 2 * kMm;
    for (int n = 0; n < 40; ++n) {
      const double z = 0.5 * (solid + air);
      (volume::sample(*work.bone, work.grid({x, 0, z})) >= 0.5 ? solid : air) = z;
    }
    return 4 * volume::gradient(*work.bone, work.grid({x, 0, solid})).norm();
  };
  for (const double x : {-0.4, -0.2, 0.0, 0.2, 0.4})
    EXPECT_NEAR(steep(x * kMm), 1, 0.35) << x << " mm: a ramp as touch and mesh know it";
  EXPECT_GT(volume::sample(*work.bone, work.grid({0.25 * kMm, 0, -0.75 * kMm})), 0.5)
      << "air at the foot is bone now";
  EXPECT_NEAR(work.volume(), before, 0.01 * before);
  work.expect_balance(before);
}

TEST(Smooth, IsUndoneTakesNeitherMemoryNorLockAndStaysInItsBall) {
  Work work(rippled);
  const std::uint64_t hash = work.bone->content_hash();
  Work same(rippled);
  work.undo.begin_stroke(0);
  const Vec3 out = {0, 0, 1}, at = kBall * out;
  {
    const test::RtGuard guard;
    for (int n = 0; n < 200; ++n) smooth(work, at, out);
    const long allocations = guard.allocations(), locks = guard.locks();
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(locks, 0);
  }
  work.undo.end_stroke();
  ASSERT_NE(work.bone->content_hash(), hash);
  const volume::Grid& grid = work.bone->grid();
  const Vec3 centre = work.grid(at);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (work.bone->field(i, j, k) != same.bone->field(i, j, k)) {
          ASSERT_LE((Vec3(i, j, k) - centre).norm(), Brush::kShare * kRadius / kVoxel + 1e-3);
        }
  const UndoStore::Range range = work.undo.undo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.writer.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), hash);
}

TEST(Brush, NeitherAddedNorSmoothedBoneGrowsOutOfTheVolume) {
  Work work(phantom::slab(), 5.5 * kMm);
  const math::Ijk size = work.bone->grid().size, whole = work.bone->bricks() * 8;
  ASSERT_LT(size.x(), whole.x()) << "it does not end within a brick: the test shows nothing";
  work.undo.begin_stroke(0);
  const double before = work.volume();
  for (int n = 0; n < 400; ++n) {
    const Vec3 corner = {(n < 200 ? 4.1 : 5.4) * kMm, 0, 2 * kMm};
    work.add(corner);
    if (n % 2 == 0)
      work.brush.smooth({.centre = work.grid(corner), .push = {0, 0, -1}, .radius = 8}, work.flags);
  }
  EXPECT_GT(work.carver.ledger().added, 0.5e-9);
  work.expect_balance(before);
  for (BrickIndex b = 0; b < work.bone->brick_count(); ++b) {
    const volume::Field* field = work.bone->brick_field(b);
    if (field == nullptr) continue;
    const math::Ijk first = work.bone->brick_ijk(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const math::Ijk at = first + math::Ijk(v & 7, v >> 3 & 7, v >> 6);
      if (!work.bone->grid().contains(at)) {
        ASSERT_EQ(field[v], 0) << at.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace burr::edit
