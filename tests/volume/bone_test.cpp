#include "burr/volume/bone.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

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
