// The vertices that the proxy uses, when their memory runs out.
#include "burr/volume/iso_vertices.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "burr/volume/bone.h"

namespace burr::volume {
namespace {

// Writes a brick and reports the change, as the carver does.
void write(Bone& bone, IsoVertices& surface, BrickIndex brick, const BrickField& content) {
  bone.write_brick(brick, content);
  surface.changed(brick, 65535, ~0ULL, 0xFFU);
}

TEST(IsoVertices, ABrickThatFindsNoRoomStaysStaleAndIsMadeAnewWhenItCan) {
  // a slab: 64 vertices per brick; then noise, some 750 per brick, far more than the room reserved
  Grid grid;
  grid.size = {32, 32, 16};
  std::vector<Field> field(32 * 32 * 16);
  for (std::size_t v = 0; v < field.size(); ++v) field[v] = v / (32 * 32) < 6 ? 65535 : 0;
  const auto bone = bone_from_arrays(grid, {}, field, {}, {}, 64);
  NoProgress quiet;
  IsoVertices surface(*bone, {.reserve_blocks = 16}, 1, quiet);
  std::vector<BrickField> before(static_cast<std::size_t>(bone->brick_count()));
  std::vector<int> counts;
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    ASSERT_TRUE(bone->copy_brick(b, before[static_cast<std::size_t>(b)]));
    counts.push_back(surface.count(b));
    ASSERT_GE(bone->ensure_slot(b), 0);
  }
  surface.refresh_all();
  ASSERT_FALSE(surface.exhausted());

  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  BrickField noise;
  for (BrickIndex b = 0; b < bone->brick_count(); ++b) {
    for (Field& voxel : noise.voxel) voxel = random() % 2 == 0 ? 0 : 65535;
    write(*bone, surface, b, noise);
  }
  for (int n = 0; n < 50; ++n) surface.refresh();
  EXPECT_TRUE(surface.exhausted());
  EXPECT_GT(surface.stale(), 0U) << "old vertices were taken for fresh: a wall of air";
  surface.refresh_all();
  EXPECT_GT(surface.stale(), 0U);
  EXPECT_GT(surface.worst_staleness(), 0);

  for (BrickIndex b = 0; b < bone->brick_count(); ++b)
    write(*bone, surface, b, before[static_cast<std::size_t>(b)]);
  for (int n = 0; n < 50; ++n) surface.refresh();
  EXPECT_EQ(surface.stale(), 0U);
  for (BrickIndex b = 0; b < bone->brick_count(); ++b)
    EXPECT_EQ(surface.count(b), counts[static_cast<std::size_t>(b)]) << b;
}

}  // namespace
}  // namespace burr::volume
