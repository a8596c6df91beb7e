// Voxels change sides only where no part, cavity or tunnel comes or goes: checked by counting these in
// the mesh of random bones, before and after.
#include "burr/importing/settle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "burr/surface/mesher.h"
#include "burr/surface/shells.h"

namespace burr::importing {
namespace {

using math::Ijk;
using volume::Bone;

std::unique_ptr<Bone> bone_of(const Ijk& size, const std::vector<bool>& inside) {
  volume::Grid grid;
  grid.size = size;
  volume::TissueTable table;
  table.tissues.resize(2);
  table.tissues[1].kind = volume::TissueKind::solid;
  const Ijk bricks = (size.array() + 7) / 8;
  auto bone =
      std::make_unique<Bone>(grid, table, static_cast<std::size_t>(bricks.prod()), 0, false);
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        volume::Field* field = bone->build_field(bone->brick_at(i / 8, j / 8, k / 8));
        field[i % 8 + 8 * (j % 8 + 8 * (k % 8))] = volume::field_from_depth(
            inside[static_cast<std::size_t>(i + size.x() * (j + size.y() * k))] ? 0.4 : -0.4);
      }
  return bone;
}

// Parts, cavities, and vertices - edges + triangles, which counts the tunnels.
struct Form {
  std::size_t parts = 0, cavities = 0;
  long euler = 0;
  bool operator==(const Form&) const = default;
};
Form form_of(const Bone& bone) {
  NoProgress progress;
  const auto mesh = surface::whole_surface(bone, 1, progress);
  const surface::Shells shells = surface::shells_of(*mesh);
  std::set<std::uint32_t> vertices(mesh->triangles.begin(), mesh->triangles.end());
  const auto triangles = static_cast<long>(mesh->triangles.size() / 3);
  return {shells.parts, shells.cavities,
          static_cast<long>(vertices.size()) - 3 * triangles / 2 + triangles};
}

TEST(Settle, ChangesNoFormOfARandomBone) {
  const Ijk size(14, 13, 12);
  std::size_t moved = 0, kept = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<bool> inside(static_cast<std::size_t>(size.prod()));
    // from grains to a sponge; nothing at the border
    for (std::size_t v = 0; v < inside.size(); ++v) {
      const int n = static_cast<int>(v);
      const Ijk p(n % size.x(), n / size.x() % size.y(), n / (size.x() * size.y()));
      const bool border = p.minCoeff() == 0 || (p.array() == size.array() - 1).any();
      inside[v] = !border && random() % 100 < 10 + seed;
    }
    const auto bone = bone_of(size, inside);
    const Form before = form_of(*bone);
    std::vector<Flip> flips;
    for (int n = 0; n < 300; ++n) {
      const Ijk p(1 + static_cast<int>(random() % 12), 1 + static_cast<int>(random() % 11),
                  1 + static_cast<int>(random() % 10));
      const bool in = bone->field(p.x(), p.y(), p.z()) >= volume::kIso;
      flips.push_back({p, volume::field_from_depth(in ? -0.1 : 0.1)});
    }
    settle(*bone, flips);
    for (const Flip& flip : flips)
      ++(bone->field(flip.voxel.x(), flip.voxel.y(), flip.voxel.z()) == flip.field ? moved : kept);
    EXPECT_EQ(form_of(*bone), before);
  }
  // some could go, others could not
  EXPECT_GT(moved, 1000U);
  EXPECT_GT(kept, 1000U);
}

TEST(Settle, KnowsTheSimplePoint) {
  const auto bit = [](int x, int y, int z) { return 1U << (x + 3 * y + 9 * z); };
  constexpr std::uint32_t kAll = (1U << 27) - 1;
  EXPECT_FALSE(is_simple(0)) << "a grain";
  EXPECT_FALSE(is_simple(kAll)) << "a cavity";
  EXPECT_TRUE(is_simple(bit(0, 1, 1))) << "the end of a rod";
  EXPECT_FALSE(is_simple(bit(0, 1, 1) | bit(2, 1, 1))) << "the middle of a rod";
  EXPECT_TRUE(is_simple(bit(0, 1, 1) | bit(1, 0, 1) | bit(0, 0, 1))) << "a corner";
  EXPECT_FALSE(is_simple(bit(0, 1, 1) | bit(1, 0, 1))) << "two that meet in it only";
  std::uint32_t plate = 0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) plate |= bit(x, y, 1);
  EXPECT_FALSE(is_simple(plate)) << "the middle of a plate one voxel thin";
  std::uint32_t floor = 0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) floor |= bit(x, y, 0);
  EXPECT_TRUE(is_simple(floor)) << "on a floor";
  EXPECT_TRUE(is_simple(floor | plate)) << "of a floor";
}

}  // namespace
}  // namespace burr::importing
