// The pieces of a bone, compared with a flood over all voxels.
#include "burr/volume/pieces.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/volume/volume_of.h"

namespace burr::volume {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kMm = 1e-3;

Grid cube_of(int edge) {
  Grid grid;
  grid.size = Ijk::Constant(edge);
  grid.voxel = 0.25 * kMm;
  return grid;
}

std::unique_ptr<Bone> bone_of(int edge, const std::vector<Field>& field) {
  const std::vector<TissueId> tissue(field.size(), 1);
  return bone_from_arrays(cube_of(edge), {}, field, tissue, {}, 64);
}

// Sizes of the pieces by a flood, the largest first.
std::vector<std::int64_t> flood(const Bone& bone) {
  const Ijk size = bone.grid().size;
  std::vector<int> seen(static_cast<std::size_t>(size.prod()));
  const auto at = [&](const Ijk& v) {
    return static_cast<std::size_t>(v.x() + size.x() * (v.y() + size.y() * v.z()));
  };
  std::vector<std::int64_t> sizes;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        if (seen[at({i, j, k})] != 0 || bone.field(i, j, k) < kIso) continue;
        std::vector<Ijk> todo = {{i, j, k}};
        seen[at({i, j, k})] = 1;
        std::int64_t count = 0;
        while (!todo.empty()) {
          const Ijk v = todo.back();
          todo.pop_back();
          ++count;
          for (int side = 0; side < 6; ++side) {
            Ijk next = v;
            next[side / 2] += side % 2 == 0 ? 1 : -1;
            if ((next.array() < 0).any() || (next.array() >= size.array()).any()) continue;
            if (seen[at(next)] != 0 || bone.field(next.x(), next.y(), next.z()) < kIso) continue;
            seen[at(next)] = 1;
            todo.push_back(next);
          }
        }
        sizes.push_back(count);
      }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

std::vector<std::int64_t> sizes_of(const PieceFinder& finder) {
  std::vector<std::int64_t> sizes;
  for (const Piece& piece : finder.pieces()) sizes.push_back(piece.voxels);
  return sizes;
}

TEST(Pieces, AreThoseOfAFlood) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (const int percent :
       {20, 33, 50, 90}) {  // below and above the share at which all hangs together
    std::vector<Field> field(32 * 32 * 32);
    for (Field& f : field) f = random() % 100 < static_cast<unsigned>(percent) ? kSolid : Field{0};
    const auto bone = bone_of(32, field);
    EXPECT_EQ(sizes_of(PieceFinder(std::as_const(*bone))), flood(*bone)) << percent << " %";
  }
}

// Two blocks beside each other, with a bridge between them or none.
std::vector<Field> blocks(int bridge) {
  std::vector<Field> field(24 * 24 * 24);
  for (int k = 2; k < 22; ++k)
    for (int j = 2; j < 22; ++j)
      for (int i = 2; i < 22; ++i)
        if (i < 9 || i > 10 || (j < 2 + bridge && k == 12))
          field[static_cast<std::size_t>(i + 24 * (j + 24 * k))] = kSolid;
  return field;
}

TEST(Pieces, ABridgeOfOneVoxelHoldsAndNoneFrees) {
  const auto held = bone_of(24, blocks(1)), free = bone_of(24, blocks(0));
  EXPECT_EQ(PieceFinder(std::as_const(*held)).pieces().size(), 1U);
  const PieceFinder finder(std::as_const(*free));
  ASSERT_EQ(finder.pieces().size(), 2U);
  EXPECT_EQ(finder.pieces()[0].voxels, 11 * 20 * 20);
  EXPECT_EQ(finder.pieces()[1].voxels, 7 * 20 * 20);
  EXPECT_EQ(finder.pieces()[1].low, Ijk(2, 2, 2));
  EXPECT_EQ(finder.pieces()[1].high, Ijk(8, 21, 21));
  EXPECT_EQ(finder.piece_of({5, 5, 5}), 1);
  EXPECT_EQ(finder.piece_of({15, 5, 5}), 0);
  EXPECT_EQ(finder.piece_of({9, 5, 5}), PieceFinder::kNone);
}

TEST(Pieces, FollowTheCut) {
  const auto bone = bone_of(24, blocks(4));
  PieceFinder finder(*bone);
  EXPECT_EQ(finder.update(), 0U);
  ASSERT_EQ(finder.pieces().size(), 1U);
  // the bridge is cut away, voxel by voxel
  for (int j = 2; j < 6; ++j) {
    EXPECT_EQ(finder.pieces().size(), 1U) << "still held by " << 6 - j;
    for (int i = 9; i <= 10; ++i) {
      const BrickIndex brick = bone->brick_at(i / 8, j / 8, 12 / 8);
      BrickField field;
      ASSERT_TRUE(bone->copy_brick(brick, field));
      field.voxel[(i & 7) + 8 * (j & 7) + 64 * (12 & 7)] = 0;
      bone->write_brick(brick, field);
    }
    EXPECT_EQ(finder.update(), 0U);
  }
  EXPECT_EQ(sizes_of(finder), flood(*bone));
  EXPECT_EQ(finder.pieces().size(), 2U);
}

TEST(Pieces, AsBonesTheyAddUpToTheUnit) {
  // two balls that a slanted cut of 0.4 mm has parted
  const Vec3 n = Vec3(1, 0.4, 0.2).normalized();
  const phantom::Depth ball = phantom::ball(3 * kMm);
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-4 * kMm), Vec3::Constant(4 * kMm), 0.25 * kMm), {},
      [&](const Vec3& p) { return std::min(ball(p), std::abs(n.dot(p) - 0.5 * kMm) - 0.2 * kMm); });
  const PieceFinder finder(std::as_const(*bone));
  ASSERT_EQ(finder.pieces().size(), 2U);
  double sum = 0;
  std::map<int, double> volumes;
  for (std::size_t piece = 0; piece < 2; ++piece) {
    const auto alone = piece_as_bone(*bone, finder, piece);
    ASSERT_TRUE(alone.ok());
    EXPECT_EQ(PieceFinder(std::as_const(**alone)).pieces().size(), 1U);
    volumes[static_cast<int>(piece)] = volume_of(**alone);
    sum += volume_of(**alone);
  }
  EXPECT_NEAR(sum, volume_of(*bone), 1e-12 * sum);
  // caps of a ball: heights 3 - 0.7 and 3 + 0.3 mm
  const auto cap = [](double h) { return M_PI * h * h * (3 * kMm - h / 3); };
  EXPECT_NEAR(volumes[0], cap(3.3 * kMm), 0.01 * cap(3.3 * kMm));
  EXPECT_NEAR(volumes[1], cap(2.3 * kMm), 0.01 * cap(2.3 * kMm));
  EXPECT_FALSE(piece_as_bone(*bone, finder, 2).ok());
}

}  // namespace
}  // namespace burr::volume
