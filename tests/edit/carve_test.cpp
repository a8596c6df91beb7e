// Cutting compared with formulas: docs/understand/cutting_truths.md, "Ground truths" (plunge, slot,
// scallop, ledger), with a burr moved by the test, without touch.
#include "burr/edit/carve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "burr/base/hash.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/rt/simd.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"
#include "support/rt_guard.h"

namespace burr::edit {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kMm3 = 1e-9;

struct Work {
  Work(const phantom::Depth& depth, double h_mm, double half_mm = 6, std::size_t reserve = 0)
      : h(h_mm * kMm),
        bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-half_mm * kMm), Vec3::Constant(half_mm * kMm), h), {},
            depth, reserve)),
        surface(*bone, {}, 1, quiet),
        undo(*bone, 4096),
        changed(*bone),
        writer(*bone, surface, undo, &changed),
        carver(writer, {.advance_m = 0,
                        .advance_least = 0,
                        .margin_m = 0,
                        .margin_least = 0,
                        .margin_most = 0,
                        .debt_timeout = 1e3}) {
    undo.begin_stroke(0);
  }
  // Removes everything inside a ball at c (world), whatever energy that takes.
  void cut_whole_ball(const Vec3& c, double r) {
    std::uint32_t flags = 0;
    Cut cut;
    cut.centre = bone->grid().grid_from_world(c);
    cut.push = Vec3(0, 0, -1);
    cut.radius = r / h;
    cut.energy = 1e6;
    carver.carve(cut, flags);
  }
  double h;
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  UndoStore undo;
  ChangedQueue changed;
  BoneWriter writer;
  Carver carver;
};

class Carving : public testing::TestWithParam<double> {};  // voxel [mm]

TEST_P(Carving, APlungeTakesTheCapOfTheBall) {
  const double r = 2 * kMm, depth = 0.2 * kMm;
  Work work(phantom::slab(), GetParam());
  const double before = volume::volume_of(*work.bone);
  work.cut_whole_ball({0.1 * kMm, -0.2 * kMm, r - depth}, r);
  const double cap = std::numbers::pi * depth * depth * (r - depth / 3);  // 0.24295 mm^3
  const double taken = before - volume::volume_of(*work.bone);
  EXPECT_NEAR(cap / kMm3, 0.24295, 1e-4);
  EXPECT_NEAR(taken, cap, (GetParam() > 0.4 ? 0.15 : 0.03) * cap);
  EXPECT_NEAR(work.carver.ledger().removed, taken, 1e-9 * cap)
      << "the ledger is the volume's own difference";
}

TEST_P(Carving, ABuriedBallTakesItsWholeVolume) {
  const double r = 2 * kMm;
  Work work(phantom::slab({0, 0, 1}, {0, 0, 5 * kMm}), GetParam());
  work.cut_whole_ball({0.13 * kMm, 0.07 * kMm, -0.11 * kMm}, r);
  const double ball = 4.0 / 3 * std::numbers::pi * r * r * r;
  EXPECT_NEAR(work.carver.ledger().removed, ball, 0.01 * ball);
}

TEST_P(Carving, ASlotHasTheSegmentsCrossSection) {
  const double r = 2 * kMm, depth = 0.2 * kMm, length = 6 * kMm;
  Work work(phantom::slab(), GetParam());
  for (double s = 0; s <= length; s += 0.05 * kMm)
    work.cut_whole_ball({s - length / 2, 0, r - depth}, r);
  const double area =
      r * r * std::acos(1 - depth / r) - (r - depth) * std::sqrt(2 * r * depth - depth * depth);
  EXPECT_NEAR(area / (kMm * kMm), 0.23490, 1e-4);
  const double swept = area * length + std::numbers::pi * depth * depth *
                                           (r - depth / 3);  // and half a cap at each end
  EXPECT_NEAR(work.carver.ledger().removed, swept, (GetParam() > 0.4 ? 0.15 : 0.03) * swept);
}

TEST_P(Carving, AScallopStandsBetweenTwoPasses) {
  if (GetParam() > 0.4) GTEST_SKIP() << "a scallop of 0.0635 mm is an eighth of a voxel of 0.5 mm";
  const double r = 2 * kMm, step = 1 * kMm, depth = 0.6 * kMm;
  const double middle =
      GetParam() / 2 *
      kMm;  // the ridge runs along voxels; between them a cusp is cut off like any edge
  Work work(phantom::slab(), GetParam());
  for (double s = -3 * kMm; s <= 3 * kMm; s += 0.05 * kMm)
    for (const double y : {-step / 2, step / 2}) work.cut_whole_ball({s, y + middle, r - depth}, r);
  // height of the ridge over the slots' floor, found by bisection of the field along z
  const auto surface_at = [&](double y) {
    double solid = -4 * kMm, air = 1 * kMm;
    for (int n = 0; n < 40; ++n) {
      const double z = 0.5 * (solid + air);
      (volume::sample(*work.bone, work.bone->grid().grid_from_world({middle, y, z})) >= 0.5 ? solid
                                                                                            : air) =
          z;
    }
    return solid;
  };
  const double ridge = surface_at(middle) - (-depth);
  EXPECT_NEAR(ridge, r - std::sqrt(r * r - step * step / 4), 0.1 * work.h);  // 0.06351 mm
}

TEST_P(Carving, TheLedgerBalancesOverAHundredThousandTicks) {
  constexpr unsigned kSeed = 99;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> side(-4 * kMm, 4 * kMm), share(0, 1);
  Work work(phantom::slab(), GetParam());
  const double before = volume::volume_of(*work.bone);
  const int ticks = GetParam() < 0.2 ? 20'000 : 100'000;
  for (int n = 0; n < ticks; ++n) {
    std::uint32_t flags = 0;
    Cut cut;
    cut.centre = work.bone->grid().grid_from_world(
        {side(random), side(random), 0.5 * kMm + 0.5 * side(random)});
    cut.push = Vec3(0, 0, -1);
    cut.radius = (0.8 + 1.2 * share(random)) * kMm / work.h;
    cut.energy = 4e-4 * share(random);
    work.carver.carve(cut, flags);
    if (n % 16 == 0) work.surface.refresh();
  }
  const Ledger ledger = work.carver.ledger();
  EXPECT_GT(ledger.removed, 1 * kMm3);
  EXPECT_NEAR(ledger.asked, ledger.removed + ledger.debt + ledger.not_cut, 1e-6 * ledger.asked);
  EXPECT_NEAR(before - volume::volume_of(*work.bone), ledger.removed, 1e-9 * ledger.removed);
}

INSTANTIATE_TEST_SUITE_P(VoxelMm, Carving, testing::Values(0.5, 0.25, 0.125),
                         [](const auto& voxel) {
                           return std::to_string(static_cast<int>(1000 * voxel.param)) + "um";
                         });

TEST(Carver, TakesExactlyWhatIsAskedAndCarriesTheRest) {
  Work work(phantom::slab(), 0.2);
  double asked = 0;
  for (int n = 0; n < 500; ++n) {
    std::uint32_t flags = 0;
    Cut cut;
    cut.centre = work.bone->grid().grid_from_world({0, 0, 1.2 * kMm});
    cut.push = Vec3(0, 0, -1);
    cut.radius = 2 * kMm / work.h;
    cut.energy = 1e9 * 1e-3 * kMm3;  // a thousandth of a cubic millimetre of cortical bone
    asked += 1e-3 * kMm3;
    work.carver.carve(cut, flags);
    ASSERT_NEAR(work.carver.ledger().asked, asked, 1e-6 * asked);
    ASSERT_NEAR(work.carver.ledger().removed, asked, 0.02 * kMm3 * 0.05);
  }
}

TEST(Carver, HardTissueGivesLessForTheSameWork) {
  for (const double harder : {1.0, 2.0, 10.0}) {
    volume::TissueTable table;
    table.tissues[1].cutting_energy = 1e9 * harder;
    const volume::Grid grid =
        phantom::box_grid(Vec3::Constant(-6 * kMm), Vec3::Constant(6 * kMm), 0.25 * kMm);
    auto bone = phantom::bone_from_distance(grid, table, phantom::slab());
    NoProgress quiet;
    volume::IsoVertices surface(*bone, {}, 1, quiet);
    UndoStore undo(*bone, 1024);
    undo.begin_stroke(0);
    BoneWriter writer(*bone, surface, undo, nullptr);
    Carver carver(writer, {});
    std::uint32_t flags = 0;
    for (int n = 0; n < 100; ++n)
      carver.carve({.centre = grid.grid_from_world({0, 0, 1.5 * kMm}),
                    .push = {0, 0, -1},
                    .radius = 8,
                    .energy = 1e-3},
                   flags);
    EXPECT_NEAR(carver.ledger().asked, 0.1 / (1e9 * harder), 1e-12 / harder);
  }
}

TEST(Carver, ABlockedBurrDoesNotSaveUp) {
  Work work(phantom::slab(), 0.25);
  BoneWriter writer(*work.bone, work.surface, work.undo, nullptr);
  Carver carver(writer, {});
  std::uint32_t flags = 0;
  const Cut far{.centre = work.bone->grid().grid_from_world({0, 0, 4 * kMm}),
                .push = {0, 0, -1},
                .radius = 8,
                .energy = 1e-3};
  for (int n = 0; n < 1000; ++n) carver.carve(far, flags);  // nothing within reach
  EXPECT_TRUE(flags & (1U << 14));
  const Ledger ledger = carver.ledger();
  EXPECT_EQ(ledger.removed, 0);
  EXPECT_LE(ledger.debt, 6e-3 * 1e-3 / 1e9 / 1e-3);  // debt of five ticks, and one more
  EXPECT_NEAR(ledger.asked, ledger.debt + ledger.not_cut, 1e-9 * ledger.asked);
}

TEST(Carver, MaterialIsAddedUpToTheBurrAndIsItsOwnTissue) {
  Work work(phantom::slab(), 0.25, 6, 512);
  std::uint32_t flags = 0;
  const double r = 1.5 * kMm;
  const Vec3 centre(0, 0, r);
  for (int n = 0; n < 400; ++n)
    work.carver.deposit({.centre = work.bone->grid().grid_from_world(centre),
                         .push = {0, 0, -1},
                         .radius = r / work.h,
                         .volume = 0.01 * kMm3,
                         .material = 1},
                        flags);
  EXPECT_GT(work.carver.ledger().added, 0.05 * kMm3);
  EXPECT_EQ(flags, 0U);
  // nothing inside the burr
  for (double z = -r; z <= r; z += 0.1 * kMm)
    EXPECT_LT(volume::sample(*work.bone,
                             work.bone->grid().grid_from_world(centre + Vec3(0, 0, 0.97 * z))),
              0.5);
}

TEST(UndoStore, BringsBackToTheBitAndForthAgain) {
  Work work(phantom::slab(), 0.25);
  const std::uint64_t start = work.bone->content_hash();
  work.cut_whole_ball({0, 0, 0}, 2 * kMm);
  work.undo.end_stroke();
  const std::uint64_t one = work.bone->content_hash();
  work.undo.begin_stroke(0);
  work.cut_whole_ball({1 * kMm, 0, -1 * kMm}, 2 * kMm);
  work.undo.end_stroke();
  const std::uint64_t two = work.bone->content_hash();

  const auto swap_all = [&](UndoStore::Range range) {
    for (std::uint64_t n = 0; n < range.count; ++n)
      work.writer.swap(work.undo.entry(range.first + n));
  };
  ASSERT_TRUE(work.undo.can_undo());
  swap_all(work.undo.undo());
  EXPECT_EQ(work.bone->content_hash(), one);
  swap_all(work.undo.undo());
  EXPECT_EQ(work.bone->content_hash(), start);
  EXPECT_FALSE(work.undo.can_undo());
  swap_all(work.undo.redo());
  swap_all(work.undo.redo());
  EXPECT_EQ(work.bone->content_hash(), two);
  EXPECT_FALSE(work.undo.can_redo());
  // a new stroke after an undo drops the strokes that could be redone
  swap_all(work.undo.undo());
  work.undo.begin_stroke(0);
  work.cut_whole_ball({-1 * kMm, 0, 0}, 1 * kMm);
  work.undo.end_stroke();
  EXPECT_FALSE(work.undo.can_redo());
  swap_all(work.undo.undo());
  EXPECT_EQ(work.bone->content_hash(), one);
  for (std::size_t n = 0; n < work.undo.touched(); ++n) work.writer.restore(work.undo.original(n));
  EXPECT_EQ(work.bone->content_hash(), start) << "reset";
}

TEST(UndoStore, ForgetsTheOldestWhenFullAndSaysSo) {
  Work work(phantom::slab(), 0.25);
  UndoStore small(*work.bone, 64);
  BoneWriter writer(*work.bone, work.surface, small, nullptr);
  Carver carver(writer, {.advance_m = 0, .advance_least = 0, .margin_m = 0, .margin_least = 0});
  const std::uint64_t start = work.bone->content_hash();
  std::uint32_t flags = 0;
  for (int n = 0; n < 12; ++n) {
    small.begin_stroke(0);
    carver.carve({.centre = work.bone->grid().grid_from_world({(n - 6) * 0.5 * kMm, 0, 0}),
                  .push = {0, 0, -1},
                  .radius = 8,
                  .energy = 1e6},
                 flags);
    small.end_stroke();
  }
  EXPECT_TRUE(flags & (1U << 11));
  int strokes = 0;
  for (; small.can_undo(); ++strokes) {
    const UndoStore::Range range = small.undo();
    for (std::uint64_t n = 0; n < range.count; ++n) writer.swap(small.entry(range.first + n));
  }
  EXPECT_GT(strokes, 0);
  EXPECT_LT(strokes, 12);
  EXPECT_NE(work.bone->content_hash(), start);
  for (std::size_t n = 0; n < small.touched(); ++n) writer.restore(small.original(n));
  EXPECT_EQ(work.bone->content_hash(), start) << "the start is never forgotten";
}

TEST(Carver, TakesNeitherMemoryNorLock) {
  Work work(phantom::slab(), 0.25, 6, 256);
  std::uint32_t flags = 0;
  Cut cut{.centre = work.bone->grid().grid_from_world({0, 0, 1 * kMm}),
          .push = {0, 0, -1},
          .radius = 8,
          .energy = 1e-4};
  Cut put = cut;
  put.volume = 1e-12;
  const test::RtGuard guard;
  for (int n = 0; n < 500; ++n) {
    work.carver.carve(cut, flags);
    if (n % 7 == 0) work.carver.deposit(put, flags);
    work.surface.refresh();
    cut.centre.x() += 0.02;
    if (n % 100 == 99) {
      work.undo.end_stroke();
      const UndoStore::Range range = work.undo.undo();
      for (std::uint64_t e = 0; e < range.count; ++e)
        work.writer.swap(work.undo.entry(range.first + e));
      work.undo.begin_stroke(0);
    }
  }
  const long allocations = guard.allocations(), locks = guard.locks();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
}

// ---- every instruction set gives the same bits

TEST(Simd, EveryPathCutsTheSameBits) {
  std::uint64_t hashes[3] = {};
  const rt::Simd before = rt::simd();
  for (const rt::Simd which : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(which);
    Work work(phantom::gyroid(3 * kMm), 0.2, 5, 64);
    std::uint32_t flags = 0;
    for (int n = 0; n < 300; ++n) {
      work.carver.carve({.centre = work.bone->grid().grid_from_world(
                             {0.02 * n * kMm - 3 * kMm, 0.3 * kMm, 0.1 * kMm}),
                         .push = {0, 0, -1},
                         .radius = 7.3,
                         .energy = 3e-4},
                        flags);
      work.surface.refresh();
    }
    std::uint64_t hash = work.bone->content_hash();
    for (volume::BrickIndex b = 0; b < work.bone->brick_count(); ++b)
      for (const volume::VertexBlock& block : work.surface.blocks(b)) {
        std::uint64_t words[sizeof block / 8];
        std::memcpy(words, &block, sizeof words);
        hash = base::mix(hash, words);
      }
    hashes[static_cast<int>(which)] = hash;
  }
  rt::force_simd(before);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace burr::edit
