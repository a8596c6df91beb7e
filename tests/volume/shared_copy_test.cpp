// A copy taken while the bone is cut is the bone at one moment, not a mixture of several.
#include "burr/volume/shared_copy.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

#include "burr/phantom/build.h"
#include "burr/phantom/phantoms.h"
#include "burr/phantom/shapes.h"

namespace burr::volume {
namespace {

std::unique_ptr<Bone> ball() {
  return phantom::bone_from_distance(phantom::cube_grid(20e-3, 64), {}, phantom::ball(8e-3), 64);
}

TEST(SharedCopy, OfABoneAtRestIsTheSameBone) {
  const auto bone = ball();
  rt::ChangedBits& changed = bone->add_watcher();
  bone->set_tissue(32, 32, 32, 1);
  NoProgress quiet;
  const auto copy = shared_copy(*bone, changed, quiet);
  ASSERT_TRUE(copy) << copy.error().text;
  EXPECT_EQ((*copy)->content_hash(), bone->content_hash());
  EXPECT_LE((*copy)->memory_bytes(), bone->memory_bytes()) << "what is uniform takes no room";
}

// Nerves, pulp, named cavities: labels outside bone.
TEST(SharedCopy, KeepsWhatHasANameWithoutBeingBone) {
  NoProgress quiet;
  auto made = phantom::phantom("tooth", 0.4, quiet);
  ASSERT_TRUE(made) << made.error().text;
  rt::ChangedBits& changed = (*made)->add_watcher();
  const auto copy = shared_copy(**made, changed, quiet);
  ASSERT_TRUE(copy) << copy.error().text;
  ASSERT_EQ((*copy)->grid().size, (*made)->grid().size);
  const math::Ijk& size = (*made)->grid().size;
  int named = 0;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        const TissueId tissue = (*made)->shared_tissue(i, j, k);
        ASSERT_EQ((*copy)->shared_tissue(i, j, k), tissue) << i << ' ' << j << ' ' << k;
        named += (*made)->tissues()[tissue].kind == TissueKind::soft ? 1 : 0;
      }
  EXPECT_GT(named, 0);
}

// In its n-th round the writer sets every brick to n, one after the other. A copy of one moment
// contains at most two consecutive numbers, with the larger one in the bricks written first.
TEST(SharedCopy, WhileItIsCutIsTheBoneOfOneMoment) {
  const auto bone = ball();
  rt::ChangedBits& changed = bone->add_watcher();
  std::vector<BrickIndex> written;
  for (BrickIndex brick = 0; brick < bone->brick_count() && written.size() < 40; ++brick)
    if (bone->brick_field(brick) != nullptr) written.push_back(brick);
  ASSERT_EQ(written.size(), 40U);
  const auto write = [&](Field n) {
    BrickField field;
    std::fill(std::begin(field.voxel), std::end(field.voxel), n);
    for (const BrickIndex brick : written) bone->write_brick(brick, field);
  };
  write(1);
  std::atomic<bool> end = false;
  std::thread writer([&] {
    // rounds as fast as a servo in the worst case, with a pause as between two ticks
    for (Field n = 2; !end && n < 60'000; ++n) {
      write(n);
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
  });
  NoProgress quiet;
  Field last = 0;
  for (int round = 0; round < 30; ++round) {
    const auto copy = shared_copy(*bone, changed, quiet);
    ASSERT_TRUE(copy) << copy.error().text;
    std::vector<Field> numbers;
    for (const BrickIndex brick : written) {
      const Field* field = (*copy)->brick_field(brick);
      ASSERT_NE(field, nullptr);
      for (int v = 1; v < kBrickVoxels; ++v) ASSERT_EQ(field[v], field[0]) << "half a brick";
      numbers.push_back(field[0]);
    }
    EXPECT_LE(numbers.front() - numbers.back(), 1) << "bricks of different moments";
    EXPECT_TRUE(std::is_sorted(numbers.rbegin(), numbers.rend()));
    EXPECT_GE(numbers.front(), last);
    last = numbers.front();
  }
  end = true;
  writer.join();
  EXPECT_GT(last, 2) << "nothing was cut meanwhile: the test shows nothing";
}

}  // namespace
}  // namespace burr::volume
