// The soft layer compared with formulas, with another way to find the same place, and in use: no
// jump of the surface under a milling burr may be felt.
#include "burr/haptics/soft_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "burr/haptics/proxy.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/rt/simd.h"

namespace burr::haptics {
namespace {

using math::Vec3;

void add(Candidates& all, const Vec3& n, double gap) {
  all.nx[all.count] = static_cast<float>(n.x());
  all.ny[all.count] = static_cast<float>(n.y());
  all.nz[all.count] = static_cast<float>(n.z());
  all.gap[all.count++] = static_cast<float>(gap);
}

Vec3 somewhere(std::mt19937& random) {
  std::normal_distribution<double> any;
  return {any(random), any(random), any(random)};
}

// Discs of a bowl that opens upwards; some of them stand out.
std::unique_ptr<Candidates> bowl(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> gap(0, 0.3);
  auto all = std::make_unique<Candidates>();
  for (int j = 0; j < count; ++j) {
    const Vec3 n = (somewhere(random) + Vec3(0, 0, 2)).normalized();
    add(*all, n, gap(random));
  }
  all->gap[0] = 0;
  return all;
}

TEST(SoftContact, OnAFlatOfManyDiscsTheBurrRestsWhereItWouldWithout) {
  // all discs are loaded equally, at the height where they carry the whole load
  constexpr double kLayer = 0.15;
  const SoftPush push = scan_kernel().soft_push;
  for (const int count : {1, 7, 16, 1000}) {
    auto all = std::make_unique<Candidates>();
    for (int j = 0; j < count; ++j) add(*all, {0, 0, 1}, 0);
    const double support = soft_support(*all, Vec3::Zero(), kLayer, push);
    EXPECT_NEAR(support, count * kLayer, 1e-5 * count);
    const SoftRest rest = soft_rest(*all, {0.3, -0.2, -8}, kLayer, support, push);
    EXPECT_NEAR(rest.place.x(), 0.3, 1e-4);
    EXPECT_NEAR(rest.place.y(), -0.2, 1e-4);
    EXPECT_NEAR(rest.place.z(), 0, 1e-3) << count;
    EXPECT_NEAR(rest.pressing, 8, 0.08);
  }
}

TEST(SoftContact, OneDiscOfManyThatGoesAwayIsHardlyFelt) {
  constexpr double kLayer = 0.15;
  const SoftPush push = scan_kernel().soft_push;
  auto all = std::make_unique<Candidates>();
  for (int j = 0; j < 100; ++j) add(*all, {0, 0, 1}, 0);
  const double support = soft_support(*all, Vec3::Zero(), kLayer, push);
  const Vec3 hand(0, 0, -8);
  const double before = soft_rest(*all, hand, kLayer, support, push).place.z();
  all->gap[3] = 0.1F;
  const double after = soft_rest(*all, hand, kLayer, support, push).place.z();
  // 99 discs carry what 100 carried: the burr sinks by at most a hundredth of the layer's thickness
  EXPECT_LT(std::abs(after - before), kLayer / 100);
  EXPECT_GT(std::abs(after - before), kLayer / 1000) << "nothing gave way: is anything soft?";
}

// Compares soft_rest() with another search for the minimum of its function, which works in a
// different way.
TEST(SoftContact, IsTheLeastOfItsFunctionWhereverThatLies) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  constexpr double kLayer = 0.15;
  const SoftPush push = scan_kernel().soft_push;
  for (int scene = 0; scene < 50; ++scene) {
    const auto all = bowl(random, 5 + 40 * (scene % 10));
    const Vec3 wanted = somewhere(random) + Vec3(0, 0, -2 - scene % 7);
    const double support = std::max(kLayer, soft_support(*all, Vec3::Zero(), kLayer, push));
    const double kappa = wanted.norm() / support;
    const auto value = [&](const Vec3& q) {
      double sum = (q - wanted).squaredNorm();
      for (int j = 0; j < all->count; ++j) {
        const Vec3 n(static_cast<double>(all->nx[j]), static_cast<double>(all->ny[j]),
                     static_cast<double>(all->nz[j]));
        const double s = std::max(0.0, kLayer - static_cast<double>(all->gap[j]) - n.dot(q));
        sum += kappa * s * s;
      }
      return sum;
    };
    // trial steps in all directions, smaller and smaller
    Vec3 best = Vec3::Zero();
    for (double step = 2; step > 1e-6;) {
      bool better = false;
      for (int way = 0; way < 40; ++way) {
        const Vec3 next = best + step * somewhere(random).normalized();
        if (value(next) < value(best)) {
          best = next;
          better = true;
        }
      }
      if (!better) step /= 2;
    }
    const Vec3 found = soft_rest(*all, wanted, kLayer, support, push).place;
    // sums of floats: correct to six digits
    EXPECT_LT(value(found), value(best) * (1 + 1e-5) + 1e-5)
        << scene << ": " << found.transpose() << " or " << best.transpose();
  }
}

TEST(SoftContact, EveryInstructionSetPushesTheSame) {
  std::mt19937 random(7);
  const rt::Simd before = rt::simd();
  for (const int count : {0, 1, 15, 16, 17, 500}) {
    const auto all = bowl(random, std::max(count, 1));
    all->count = count;
    SoftSums sums[3];
    for (const rt::Simd which : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
      rt::force_simd(which);
      const float p[3] = {0.01F, -0.02F, 0.005F};
      scan_kernel().soft_push(*all, p, 0.15F, sums[static_cast<int>(which)]);
    }
    EXPECT_EQ(std::memcmp(&sums[0], &sums[1], sizeof sums[0]), 0) << count;
    EXPECT_EQ(std::memcmp(&sums[0], &sums[2], sizeof sums[0]), 0) << count;
    EXPECT_EQ(sums[0].total > 0, count > 0);
  }
  rt::force_simd(before);
}

// Copied discs must be all discs of their blocks, and give the same candidates.
TEST(Scan, DiscsThatWereTakenAreSeenAsTheirBlocksAre) {
  NoProgress quiet;
  const auto bone =
      phantom::bone_from_distance(phantom::cube_grid(10e-3, 64), {}, phantom::gyroid(3e-3), 64);
  const volume::IsoVertices surface(*bone, {}, 1, quiet);
  const volume::BrickIndex brick = [&] {
    volume::BrickIndex most = 0;
    for (volume::BrickIndex b = 0; b < bone->brick_count(); ++b)
      if (surface.count(b) > surface.count(most)) most = b;
    return most;
  }();
  const rt::Simd before = rt::simd();
  for (const rt::Simd which : {rt::Simd::scalar, rt::Simd::avx2, rt::Simd::avx512}) {
    rt::force_simd(which);
    const ScanKernel kernel = scan_kernel();
    const math::Ijk first = bone->brick_ijk(brick);
    const std::int32_t at[3] = {first.x(), first.y(), first.z()};
    const Vec3 looked = first.cast<double>() + Vec3(-1, 9, 3),
               moved = looked + Vec3(0.3, -0.2, 0.1);
    constexpr float kRadius = 4, kWithin = 1.5F, kReach = kRadius + 3;
    std::vector<NearBlock> near(volume::IsoVertices::kMostBlocks);
    const int blocks = kernel.find_near(surface.blocks(brick).data(), surface.count(brick), at,
                                        looked.data(), kReach, near.data());
    ASSERT_GT(blocks, 1);
    auto by_block = std::make_unique<Candidates>(), by_disc = std::make_unique<Candidates>();
    kernel.scan(near.data(), blocks, moved.data(), kRadius, kWithin, surface.largest_disc(),
                *by_block);
    auto discs = std::make_unique<NearDiscs>();
    ASSERT_TRUE(kernel.take(near.data(), blocks, looked.data(), kReach, *discs));
    const float offset[3] = {0.3F, -0.2F, 0.1F};
    kernel.scan_discs(*discs, offset, kRadius, kWithin, surface.largest_disc(), *by_disc);
    ASSERT_GT(by_block->count, 20);
    ASSERT_EQ(by_disc->count, by_block->count);
    for (int j = 0; j < by_block->count; ++j) {
      EXPECT_NEAR(by_disc->gap[j], by_block->gap[j], 1e-5F);
      EXPECT_NEAR(by_disc->nx[j], by_block->nx[j], 1e-5F);
      EXPECT_NEAR(by_disc->ny[j], by_block->ny[j], 1e-5F);
      EXPECT_NEAR(by_disc->nz[j], by_block->nz[j], 1e-5F);
    }
  }
  rt::force_simd(before);
}

}  // namespace
}  // namespace burr::haptics
