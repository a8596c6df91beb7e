// Work in a mirror: the same on both sides to the bit, in every tick, wherever the plane cuts the
// bricks and however many slices they take; nothing is done twice; one undo takes both back.
#include "burr/edit/mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "burr/base/hash.h"
#include "burr/base/progress.h"
#include "burr/edit/brush.h"
#include "burr/edit/carve.h"
#include "burr/edit/laws/thesis_law.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/volume_of.h"
#include "support/rt_guard.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickIndex;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;
const math::Ijk kSize = {60, 56, 44};

volume::Grid grid() {
  volume::Grid grid;
  grid.size = kSize;
  grid.voxel = kVoxel;
  return grid;
}

// A symmetric bone of two tissues, to the bit: its formula is evaluated on one side only.
std::unique_ptr<volume::Bone> even_bone(const Mirror& mirror, std::size_t reserve = 512) {
  const auto fold = [mirror](const Vec3& p) {
    Vec3 q = (2 * p / kVoxel).array().round().matrix() / 2;
    q[mirror.axis] = std::abs(q[mirror.axis] - mirror.place());
    return q;
  };
  phantom::Formula formula;
  formula.depth = [fold, mirror](const Vec3& p) {  // hilly, below k = 24, or a plate
    const Vec3 q = fold(p);
    return kVoxel * 0.5 *
           ((mirror.axis == 2 ? 10 : 24) - q.z() + 2 * std::sin(0.4 * q.x() + 0.1 * q.y()) +
            std::cos(0.5 * q.y()));
  };
  formula.tissue = [fold](const Vec3& p, double) -> volume::TissueId {
    const Vec3 q = fold(p);
    return std::sin(0.3 * q.x() + 0.5 * q.y() + 0.2 * q.z()) > 0 ? 1 : 2;
  };
  volume::TissueTable tissues;
  tissues.tissues.resize(4, tissues.tissues.back());
  tissues.tissues[2].cutting_energy *= 1.7;
  NoProgress quiet;
  auto made = phantom::bone_from_formula(grid(), tissues, formula, reserve, 2, quiet);
  EXPECT_TRUE(made);
  return std::move(*made);
}

struct Work {
  explicit Work(const Mirror& plane, const CarveSettings& settings = {})
      : Work(plane, even_bone(plane), settings) {}
  Work(const Mirror& plane, std::unique_ptr<volume::Bone> of, const CarveSettings& settings)
      : mirror(plane),
        bone(std::move(of)),
        surface(*bone, {}, 1, quiet),
        undo(*bone, 4096),
        changed(*bone),
        writer(*bone, surface, undo, &changed),
        carver(writer, settings),
        brush(writer) {
    undo.begin_stroke(0);
  }
  [[nodiscard]] double volume() const { return volume::volume_of(*bone); }
  // Describes the first voxel that differs from its image.
  [[nodiscard]] std::string odd() const {
    const math::Ijk& size = bone->grid().size;
    for (int k = 0; k < size.z(); ++k)
      for (int j = 0; j < size.y(); ++j)
        for (int i = 0; i < size.x(); ++i) {
          math::Ijk of(i, j, k);
          of[mirror.axis] = mirror.twice - of[mirror.axis];
          if (!bone->grid().contains(of)) continue;
          if (bone->field(i, j, k) == bone->field(of.x(), of.y(), of.z()) &&
              bone->tissue(i, j, k) == bone->tissue(of.x(), of.y(), of.z()))
            continue;
          return "(" + std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k) +
                 "): " + std::to_string(bone->field(i, j, k)) + " against " +
                 std::to_string(bone->field(of.x(), of.y(), of.z()));
        }
    return {};
  }
  void carve(const Vec3& at, int slices = 1, bool in_mirror = true) {
    Cut cut;
    cut.centre = at;
    cut.push = Vec3(0.1, 0.2, -1).normalized();
    cut.radius = 6;
    cut.energy = 2e-2;
    cut.slices = slices;
    if (in_mirror) cut.mirror = mirror;
    carver.carve(cut, flags);
    surface.refresh();
  }
  void lower(const Vec3& at) {
    Cut cut;
    cut.centre = at;
    cut.push = Vec3(0.1, 0.2, -1).normalized();
    cut.radius = 6;
    cut.mirror = mirror;
    edit::lower(carver, cut, 700, flags);
    surface.refresh();
  }
  void add(const Vec3& at, int slices = 1) {
    Cut cut;
    cut.centre = at;
    cut.push = Vec3(0.1, 0.2, -1).normalized();
    cut.radius = 6;
    cut.volume = 4e-11;
    cut.material = 3;
    cut.slices = slices;
    cut.mirror = mirror;
    carver.deposit(cut, flags);
    surface.refresh();
  }
  void work_over(const Vec3& at, bool smooth, int slices = 1) {
    Brushing now;
    now.centre = at;
    now.push = Vec3(0.1, 0.2, -1).normalized();
    now.radius = 6;
    now.slices = slices;
    now.mirror = mirror;
    smooth ? brush.smooth(now, flags) : brush.restore(now, flags);
    surface.refresh();
  }
  void expect_balance(double before) const {
    const Ledger is = carver.ledger();
    EXPECT_NEAR(is.asked, is.removed + is.debt + is.not_cut, 1e-9 * is.asked);
    EXPECT_NEAR(volume() - before, is.added - is.removed, 1e-9 * (is.added + is.removed));
  }

  Mirror mirror;
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

// Across the plane and away from it, on either side, with its image inside the volume.
Vec3 place_of(const Mirror& mirror, int n) {
  Vec3 at(28.3 + 0.37 * (n % 11), 27.7 - 0.23 * (n % 7), 28.03 - 0.05 * (n % 50));
  at[mirror.axis] = mirror.place() + (mirror.axis == 2 ? 6 : 14) * std::sin(0.13 * n);
  return at;
}

// Planes on a voxel and between two, on brick borders and elsewhere.
std::vector<Mirror> planes() {
  std::vector<Mirror> planes;
  for (int axis = 0; axis < 3; ++axis)
    for (const int twice : {47, 52, 55, 57})
      planes.push_back({axis, axis == 2 ? twice - 8 : twice});
  return planes;
}

class InAMirror : public testing::TestWithParam<Mirror> {};
INSTANTIATE_TEST_SUITE_P(Planes, InAMirror, testing::ValuesIn(planes()),
                         [](const testing::TestParamInfo<Mirror>& plane) {
                           return "axis" + std::to_string(plane.param.axis) + "at" +
                                  std::to_string(plane.param.twice);
                         });

TEST_P(InAMirror, EveryTickOfCuttingLeavesTheBoneItsOwnImageHoweverManyTurns) {
  Work work(GetParam());
  ASSERT_EQ(work.odd(), "") << "the bone is not even: the test shows nothing";
  const double before = work.volume();
  for (int n = 0; n < 240; ++n) {
    work.carve(place_of(work.mirror, n), 1 << (n / 40 % 4));
    if (n % 5 == 0) {
      ASSERT_EQ(work.odd(), "") << n;
    }
  }
  ASSERT_EQ(work.odd(), "");
  EXPECT_GT(work.carver.ledger().removed, 2e-9);
  work.expect_balance(before);
}

TEST_P(InAMirror, AddingAndTheThesisLawLikewise) {
  Work work(GetParam());
  const double before = work.volume();
  for (int n = 0; n < 120; ++n) {
    work.add(place_of(work.mirror, n) + Vec3(0, 0, 6), 1 << (n / 30 % 4));
    if (n % 5 == 0) {
      ASSERT_EQ(work.odd(), "") << n;
    }
  }
  EXPECT_GT(work.carver.ledger().added, 0.3e-9);
  work.expect_balance(before);
  for (int n = 0; n < 60; ++n) {
    work.lower(place_of(work.mirror, 2 * n));
    if (n % 5 == 0) {
      ASSERT_EQ(work.odd(), "") << n;
    }
  }
  ASSERT_EQ(work.odd(), "");
  work.expect_balance(before);
}

TEST_P(InAMirror, SmoothingAndTheOriginalLikewise) {
  Work work(GetParam());
  const double before = work.volume();
  for (int n = 0; n < 40; ++n) work.carve(place_of(work.mirror, 3 * n));
  for (int n = 0; n < 40; ++n) work.add(place_of(work.mirror, 3 * n + 1) + Vec3(0, 0, 6));
  ASSERT_EQ(work.odd(), "");
  const std::uint64_t spoilt = work.bone->content_hash();
  for (int n = 0; n < 120; ++n) {
    work.work_over(place_of(work.mirror, n), true, 1 << (n / 30 % 4));
    if (n % 5 == 0) {
      ASSERT_EQ(work.odd(), "") << n;
    }
  }
  const std::uint64_t smoothed = work.bone->content_hash();
  EXPECT_NE(smoothed, spoilt);
  for (int n = 0; n < 120; ++n) {
    work.work_over(place_of(work.mirror, n), false, 1 << (n / 30 % 4));
    if (n % 5 == 0) {
      ASSERT_EQ(work.odd(), "") << n;
    }
  }
  ASSERT_EQ(work.odd(), "");
  EXPECT_NE(work.bone->content_hash(), smoothed);
  work.expect_balance(before);
}

// Often two neighbours weigh the same; the image must then choose the other one.
TEST_P(InAMirror, ATangleOfEqualNeighboursIsSmoothedLikewise) {
  const Mirror mirror = GetParam();
  Work work(mirror);
  for (BrickIndex b = 0; b < work.bone->brick_count(); ++b) {
    KeptBrick content = {};
    content.brick = b;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      math::Ijk p = work.bone->brick_ijk(b) + math::Ijk(v & 7, v >> 3 & 7, v >> 6);
      if (!work.bone->grid().contains(p)) continue;
      p[mirror.axis] = std::min(p[mirror.axis], mirror.twice - p[mirror.axis]);
      std::uint64_t hash = 1;
      for (int axis = 0; axis < 3; ++axis)
        hash = base::mix(hash, static_cast<std::uint64_t>(p[axis] + 100));
      content.field.voxel[v] =
          static_cast<volume::Field>(std::min<std::uint64_t>(hash % 9 * 8192, 65535));
      content.tissue[v] = static_cast<volume::TissueId>(hash >> 20 & 3);
    }
    work.writer.rewrite(content, work.flags);
  }
  ASSERT_EQ(work.odd(), "");
  for (int n = 0; n < 30; ++n) {
    work.work_over(place_of(mirror, 4 * n), true);
    ASSERT_EQ(work.odd(), "") << n;
  }
}

TEST(Mirror, BothSidesTogetherLoseExactlyTwiceWhatTheHandsSideLosesWithoutOne) {
  const Mirror mirror = {0, 57};
  Work both(mirror), alone(mirror);
  for (int n = 0; n < 80; ++n) {
    Vec3 at = rounded({12.3 + 0.05 * n, 27.2, 27 - 0.04 * n});
    // the same ball in both: with a mirror the advanced centre is rounded, and this push needs no
    // rounding
    Cut cut;
    cut.centre = at;
    cut.push = Vec3(0, 0, -1);
    cut.radius = 6;
    cut.energy = 2e-2;
    alone.carver.carve(cut, alone.flags);
    cut.mirror = mirror;
    both.carver.carve(cut, both.flags);
  }
  EXPECT_GT(alone.carver.ledger().removed, 1e-9);
  EXPECT_EQ(both.carver.ledger().removed, 2 * alone.carver.ledger().removed);
  EXPECT_EQ(both.carver.removed_by_image(), alone.carver.ledger().removed);
  EXPECT_EQ(both.carver.ledger().debt, alone.carver.ledger().debt) << "the hand pays its own alone";
  EXPECT_EQ(both.carver.ledger().energy, alone.carver.ledger().energy);
  EXPECT_EQ(both.odd(), "");
  for (int k = 0; k < kSize.z(); ++k)
    for (int j = 0; j < kSize.y(); ++j)
      for (int i = 0; 2 * i < mirror.twice; ++i)
        ASSERT_EQ(both.bone->field(i, j, k), alone.bone->field(i, j, k));
}

// The volume of the union of two equal balls, their centres `apart`  [any length]
double union_of_balls(double r, double apart) {
  const double ball = 4.0 / 3 * std::numbers::pi * r * r * r;
  if (apart >= 2 * r) return 2 * ball;
  const double lens = std::numbers::pi * (4 * r + apart) * std::pow(2 * r - apart, 2) / 12;
  return 2 * ball - lens;
}

TEST(Mirror, ABallOverThePlaneTakesTheUnionOfBothAndNothingTwice) {
  const CarveSettings plain = {.advance_m = 0,
                               .advance_least = 0,
                               .margin_m = 0,
                               .margin_least = 0,
                               .margin_most = 0,
                               .debt_timeout = 1e3};
  for (const double off : {0.0, 0.3, 2.5, 6.0, 9.9, 12.0})
    for (const int twice : {57, 58}) {
      const Mirror mirror = {0, twice};
      Work work(mirror, phantom::bone_from_distance(grid(), {}, [](const Vec3&) { return 1.0; }),
                plain);
      const double before = work.volume();
      Cut cut;
      cut.centre = Vec3(mirror.place() - off, 28.2, 22.1);
      cut.push = Vec3(0, 0, -1);
      cut.radius = 10;
      cut.energy = 1e6;
      cut.mirror = mirror;
      work.carver.carve(cut, work.flags);
      const double gone = before - work.volume();
      const double truth = union_of_balls(10, 2 * off) * std::pow(kVoxel, 3);
      EXPECT_NEAR(gone, truth, 4e-3 * truth) << off << " voxels from the plane";
      EXPECT_NEAR(gone, work.carver.ledger().removed, 1e-9 * gone);
      EXPECT_EQ(work.odd(), "");
    }
}

TEST(Mirror, MoreBricksThanATickBearsAreCutAndBroughtBackAlikeOnBothSides) {
  volume::Grid wide = grid();
  wide.size = {132, 132, 232};
  const Mirror mirror = {2, 229};  // across the axis along which bricks are visited last
  Work work(mirror, phantom::bone_from_distance(wide, {}, [](const Vec3&) { return 1.0; }), {});
  const double before = work.volume();
  Cut cut;
  cut.centre = Vec3(64.7, 66.2, 58.3);
  cut.push = Vec3(0, 0, -1);
  cut.radius = 56;
  cut.energy = 3000;
  cut.mirror = mirror;
  for (int n = 0; n < 16; ++n) {
    work.carver.carve(cut, work.flags);
    ASSERT_EQ(work.odd(), "") << n;
  }
  EXPECT_NE(work.flags & 1U << 15, 0U) << "nothing was put off: the test shows nothing";
  EXPECT_GT(work.carver.removed_by_image(), 0);
  Brushing now;
  now.centre = cut.centre;
  now.push = cut.push;
  now.radius = 30;
  now.mirror = mirror;
  for (int n = 0; n < 24; ++n) {
    const std::uint64_t was = work.bone->content_hash();
    n % 2 == 0 ? work.brush.restore(now, work.flags) : work.brush.smooth(now, work.flags);
    EXPECT_LE(work.brush.bricks_last(), 2 * Brush::kMostBricks);
    if (n > 20 && n % 2 == 0) {
      EXPECT_NE(work.bone->content_hash(), was);
    }
    ASSERT_EQ(work.odd(), "") << n;
  }
  work.expect_balance(before);
}

TEST(Mirror, OneStrokeTakesBothSidesBackAndBringsThemAgain) {
  Work work({1, 55});
  const std::uint64_t start = work.bone->content_hash();
  for (int n = 0; n < 60; ++n) work.carve(place_of(work.mirror, n));
  work.undo.end_stroke();
  const std::uint64_t cut = work.bone->content_hash();
  ASSERT_NE(cut, start);
  UndoStore::Range range = work.undo.undo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.writer.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), start);
  EXPECT_FALSE(work.undo.can_undo()) << "it is one stroke";
  range = work.undo.redo();
  for (std::uint64_t n = 0; n < range.count; ++n)
    work.writer.swap(work.undo.entry(range.first + n));
  EXPECT_EQ(work.bone->content_hash(), cut);
}

TEST(Mirror, WhereTheBoneIsAnotherTheSameShapeIsCutIntoIt) {
  // the image's side is four voxels higher
  const Mirror mirror = {0, 57};
  Work work(
      mirror,
      phantom::bone_from_distance(
          grid(), {},
          [](const Vec3& p) { return kVoxel * (p.x() < 28.5 * kVoxel ? 24.0 : 28.0) - p.z(); }, 64,
          2, 8),
      {});
  const double before = work.volume();
  for (int n = 0; n < 300; ++n) work.carve({14, 28, 28}, 1);
  work.expect_balance(before);
  EXPECT_GT(work.carver.removed_by_image(), 1.5 * 0.5 * work.carver.ledger().removed);
  for (int n = -3; n <= 3; ++n)  // where both sides had bone the floor is equal
    for (int k = 0; k < 24; ++k)
      EXPECT_NEAR(work.bone->field(14 + n, 28, k), work.bone->field(57 - 14 - n, 28, k), 2);
}

TEST(Mirror, WhereTheHandsSideHasNothingLeftItsImageIsEmptiedToo) {
  const Mirror mirror = {0, 57};
  Work work(mirror,
            phantom::bone_from_distance(
                grid(), {}, [](const Vec3& p) { return p.x() - 30 * kVoxel; }, 64),
            {});
  const double before = work.volume();
  for (int n = 0; n < 3; ++n) work.carve({14, 28, 22});
  EXPECT_GT(work.carver.ledger().removed, 0.9 * union_of_balls(6, 12) / 2 * std::pow(kVoxel, 3));
  EXPECT_EQ(work.carver.removed_by_image(), work.carver.ledger().removed);
  work.expect_balance(before);
}

TEST(Mirror, PlanesAreWhereVoxelsHaveImages) {
  EXPECT_EQ(mirror_at(0, 12.26, kSize), (Mirror{0, 25}));
  EXPECT_EQ(mirror_at(1, 12.24, kSize), (Mirror{1, 24}));
  EXPECT_EQ(mirror_at(2, -5, kSize), (Mirror{2, 0}));
  EXPECT_EQ(mirror_at(2, 1e9, kSize), (Mirror{2, 86}));
  EXPECT_EQ(mirror_at(2, 43, kSize).place(), 43);
}

TEST(Mirror, EveryVoxelIsInOneHalfAndHasTheTurnOfItsImage) {
  for (const Mirror& mirror : planes())
    for (const double off : {-3.2, 0.0, 0.2})
      for (const int slices : {1, 2, 8}) {
        Vec3 centre = Vec3::Zero();
        centre[mirror.axis] = mirror.place() + off;
        const Sides sides = sides_of(centre, mirror);
        ASSERT_EQ(sides.count, 2);
        std::vector<int> seen(80, 0);  // by voxel along the axis, at bricks (1, 2, 3) across it
        for (int slice = 0; slice < slices; ++slice)
          for (int b = 0; b < 10; ++b)
            for (const Half& half : sides.half) {
              math::Ijk brick(1, 2, 3);
              brick[mirror.axis] = b;
              const unsigned layers = layers_of(brick, half, slices, slice);
              for (int n = 0; n < 8; ++n) {
                if ((layers >> n & 1U) == 0) continue;
                seen[static_cast<std::size_t>(8 * b + n)] += 1 + 100 * slice;
              }
            }
        for (int v = 0; v < 80; ++v) {
          const int at = seen[static_cast<std::size_t>(v)], image = mirror.twice - v;
          EXPECT_EQ(at % 100, 1) << v;
          if (image < 0 || image >= 80) continue;
          EXPECT_EQ(at, seen[static_cast<std::size_t>(image)]) << v;
        }
      }
}

TEST(Mirror, TakesNeitherMemoryNorLock) {
  Work work({0, 55});
  work.carve(place_of(work.mirror, 0));
  const test::RtGuard guard;
  for (int n = 0; n < 40; ++n) {
    const Vec3 at = place_of(work.mirror, n);
    work.carve(at, 2);
    work.add(at + Vec3(0, 0, 6));
    work.lower(at);
    work.work_over(at, true);
    work.work_over(at, false, 4);
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

}  // namespace
}  // namespace burr::edit
