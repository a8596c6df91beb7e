#include "burr/volume/bone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "burr/volume/copy_of_bone.h"
#include "support/rt_guard.h"

namespace burr::volume {
namespace {

std::unique_ptr<Bone> small_bone() {
  Grid grid;
  grid.size = {20, 17, 9};
  std::vector<Field> field(20 * 17 * 9);
  field[3 + 20 * (4 + 17 * 5)] = 40000;
  return bone_from_arrays(grid, {}, field, {}, {}, 2);
}

TEST(Bone, KeepsOnlyBricksThatHoldSomething) {
  const auto bone = small_bone();
  EXPECT_EQ(bone->bricks(), math::Ijk(3, 3, 2));
  EXPECT_EQ(bone->used_slots(), 1U);
  EXPECT_EQ(bone->free_slots(), 2U);
  EXPECT_EQ(bone->field(3, 4, 5), 40000);
  EXPECT_EQ(bone->tissue(3, 4, 5), 1);
  EXPECT_EQ(bone->field(4, 4, 5), 0);
  EXPECT_EQ(bone->field(-1, 0, 0), 0) << "outside is air";
  EXPECT_EQ(bone->field(20, 0, 0), 0) << "outside is air";
}

TEST(Bone, TellsEveryWatcherWhichBrickChangedOnce) {
  const auto bone = small_bone();
  rt::ChangedBits& a = bone->add_watcher();
  rt::ChangedBits& b = bone->add_watcher();
  BrickField content{};
  content.voxel[7] = 123;
  bone->write_brick(0, content);
  bone->write_brick(0, content);
  for (rt::ChangedBits* watcher : {&a, &b}) {
    std::vector<std::size_t> seen;
    watcher->take_all([&](std::size_t brick) { seen.push_back(brick); });
    EXPECT_EQ(seen, std::vector<std::size_t>{0});
    watcher->take_all([&](std::size_t) { FAIL() << "taken twice"; });
  }
  EXPECT_EQ(bone->field(7, 0, 0), 123);
}

TEST(Bone, TheReserveEndsWithARefusalNotWithAnAllocation) {
  const auto bone = small_bone();
  EXPECT_GE(bone->ensure_slot(3), 0);
  EXPECT_GE(bone->ensure_slot(4), 0);
  EXPECT_EQ(bone->ensure_slot(5), kNoSlot);
  EXPECT_EQ(bone->ensure_slot(3), bone->ensure_slot(3));
}

TEST(CopyOfBone, IsTheSameBoneAndHasALifeOfItsOwn) {
  Grid grid;
  grid.size = {20, 17, 9};
  std::vector<Field> field(20 * 17 * 9);
  std::vector<TissueId> tissue(field.size(), 1);
  std::vector<std::int16_t> intensity(field.size());
  for (std::size_t n = 0; n < field.size(); ++n) {
    field[n] = static_cast<Field>(n < 1000 ? kSolid : 11 * n);
    tissue[n] = static_cast<TissueId>(n % 3);
    intensity[n] = static_cast<std::int16_t>(n);
  }
  const auto bone = bone_from_arrays(grid, {}, field, tissue, intensity, 2);
  const auto copy = copy_of(*bone);
  EXPECT_EQ(copy->content_hash(), bone->content_hash());
  EXPECT_EQ(copy->free_slots(), bone->free_slots());
  EXPECT_EQ(copy->memory_bytes(), bone->memory_bytes());
  EXPECT_EQ(copy->intensity(7, 5, 3), bone->intensity(7, 5, 3));
  const Field was = bone->field(7, 0, 0);
  BrickField content{};
  content.voxel[7] = 123;
  copy->write_brick(0, content);
  EXPECT_EQ(copy->field(7, 0, 0), 123);
  EXPECT_EQ(bone->field(7, 0, 0), was);
}

TEST(Bone, HashSeesTheFieldAndForgetsEmptyBricks) {
  const auto one = small_bone();
  const auto two = small_bone();
  EXPECT_EQ(one->content_hash(), two->content_hash());
  ASSERT_GE(two->ensure_slot(4), 0);
  EXPECT_EQ(one->content_hash(), two->content_hash());
  BrickField content{};
  content.voxel[0] = 1;
  two->write_brick(4, content);
  EXPECT_NE(one->content_hash(), two->content_hash());
}

// 4 x 4 x 4 bricks: solid except for two voxels, of tissue 2 with one voxel of tissue 3; only
// `reserve` bricks may be added.
std::unique_ptr<Bone> mostly_solid(std::size_t reserve) {
  Grid grid;
  grid.size = {32, 32, 32};
  TissueTable table;
  table.tissues.resize(4);
  std::vector<Field> field(32 * 32 * 32, kSolid);
  std::vector<TissueId> tissue(field.size(), 2);
  field[0] = 1000;
  field[31 + 32 * (31 + 32 * 31)] = 0;
  tissue[9] = 3;
  return bone_from_arrays(grid, table, field, tissue, {}, reserve);
}

TEST(Bone, UniformBricksShareOneSlotUntilTheyAreWritten) {
  const auto bone = mostly_solid(0);
  EXPECT_EQ(bone->used_slots(), 64U);
  EXPECT_FALSE(bone->is_uniform(0));
  EXPECT_TRUE(bone->is_uniform(1));
  EXPECT_FALSE(bone->is_uniform(63));
  EXPECT_EQ(bone->brick_field(1), bone->brick_field(2));
  EXPECT_EQ(bone->brick_tissue(0), bone->brick_tissue(2)) << "all of tissue 2";
  EXPECT_NE(bone->brick_tissue(1), bone->brick_tissue(2)) << "one voxel of 3";
  EXPECT_LT(bone->memory_bytes(), 64 * 1024U) << "64 bricks would take 96 KiB";

  const std::size_t before = bone->memory_bytes();
  const std::uint64_t hash = bone->content_hash();
  BrickField content{};
  content.voxel[511] = 40000;
  const test::RtGuard guard;
  bone->write_brick(5, content);
  bone->set_tissue(16, 0, 0, 3);
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
  EXPECT_EQ(bone->field(15, 15, 7), 40000);
  EXPECT_EQ(bone->field(8, 8, 0), 0);
  EXPECT_EQ(bone->field(16, 8, 0), kSolid) << "the next brick shares on";
  EXPECT_EQ(bone->tissue(16, 0, 0), 3);
  EXPECT_EQ(bone->tissue(17, 0, 0), 2);
  EXPECT_EQ(bone->tissue(24, 0, 0), 2);
  EXPECT_EQ(bone->shared_tissue(16, 0, 0), 3);
  EXPECT_EQ(bone->memory_bytes() - before, sizeof(BrickField) + sizeof(rt::Version) + kBrickVoxels);

  // and back: the same bone, whichever bricks share slots
  std::fill_n(content.voxel, kBrickVoxels, kSolid);
  bone->write_brick(5, content);
  bone->set_tissue(16, 0, 0, 2);
  EXPECT_EQ(bone->content_hash(), hash);
  bone->pack();
  EXPECT_EQ(bone->content_hash(), hash);
  EXPECT_EQ(bone->memory_bytes(), before);
}

TEST(Bone, EveryBrickThatSharesMayBeWrittenWhateverTheReserve) {
  const auto bone = mostly_solid(0);
  BrickField content;
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    std::fill_n(content.voxel, kBrickVoxels, static_cast<Field>(b + 1));
    bone->write_brick(b, content);
    const math::Ijk first = bone->brick_ijk(b);
    bone->set_tissue(first.x(), first.y(), first.z(), 1);
  }
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    const math::Ijk first = bone->brick_ijk(b);
    for (int v = 0; v < kBrickVoxels; ++v)
      ASSERT_EQ(bone->brick_field(b)[v], b + 1) << "brick " << b << " voxel " << v;
    ASSERT_EQ(bone->tissue(first.x(), first.y(), first.z()), 1);
    ASSERT_EQ(bone->tissue(first.x() + 7, first.y(), first.z()), 2);
  }
}

TEST(Bone, AReaderOfASharedBrickSeesItBeforeOrAfterItsFirstWrite) {
  for (int round = 0; round < 20; ++round) {
    const auto bone = mostly_solid(0);
    std::atomic<bool> done = false;
    std::thread writer([&] {
      BrickField content;
      std::fill_n(content.voxel, kBrickVoxels, Field{1234});
      for (BrickIndex b = 1; b < 63; ++b) {
        const math::Ijk first = bone->brick_ijk(b);
        bone->set_tissue(first.x() + 3, first.y(), first.z(), 3);
        bone->write_brick(b, content);
      }
      done = true;
    });
    BrickField seen;
    for (bool last = false; !last;) {
      last = done;
      for (BrickIndex b = 1; b < 63; ++b) {
        if (!bone->copy_brick(b, seen)) continue;
        ASSERT_TRUE(seen.voxel[0] == kSolid || seen.voxel[0] == 1234);
        for (const Field voxel : seen.voxel) ASSERT_EQ(voxel, seen.voxel[0]);
        const math::Ijk first = bone->brick_ijk(b);
        if (seen.voxel[0] == 1234) {
          ASSERT_EQ(bone->shared_tissue(first.x() + 3, first.y(), first.z()), 3);
        }
        ASSERT_EQ(bone->shared_tissue(first.x() + 4, first.y(), first.z()), 2);
      }
    }
    writer.join();
  }
}

TEST(Bone, AReaderNeverSeesHalfAWrite) {
  const auto bone = small_bone();
  std::atomic<bool> stop = false;
  std::thread writer([&] {
    BrickField content;
    for (int round = 0; !stop; ++round) {
      for (Field& voxel : content.voxel) voxel = static_cast<Field>(round);
      bone->write_brick(0, content);
      if (round % 64 == 0) std::this_thread::yield();
    }
  });
  BrickField seen;
  int good = 0;
  for (int i = 0; i < 2'000'000 && good < 20'000; ++i) {
    if (!bone->copy_brick(0, seen)) continue;
    if (++good == 1) continue;  // the first may still be the bone as built
    for (const Field voxel : seen.voxel) {
      if (seen.voxel[0] == 0) break;
      ASSERT_EQ(voxel, seen.voxel[0]);
    }
  }
  stop = true;
  writer.join();
  EXPECT_GT(good, 0);
}

}  // namespace
}  // namespace burr::volume
