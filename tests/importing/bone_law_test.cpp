// Recordings of scans made before 2026-11-29 name no law: their bones are made as then, to the bit.
#include <gtest/gtest.h>

#include <vector>

#include "burr/importing/import.h"
#include "burr/importing/surface_field.h"
#include "burr/importing/tissue_volumes.h"
#include "scenes/thin_shapes.h"

namespace burr::importing {
namespace {

std::uint64_t hash_by_law(int law, bool labels, double noise) {
  const auto shapes = scenes::thin_shapes(7, math::Vec3::Constant(0.5), noise);
  std::vector<std::int16_t> grey;
  std::vector<std::uint8_t> label;
  for (const float value : shapes.scan.values) {
    grey.push_back(static_cast<std::int16_t>(value));
    label.push_back(value >= 300 ? 1 : 0);
  }
  InsideGrid inside;
  inside.size = shapes.scan.size;
  inside.law = law;
  if (labels) {
    inside.labels = label.data();
    inside.solid[1] = true;
    inside.tissue[1] = 1;
  } else {
    inside.grey = grey.data();
    inside.iso = 300;
    inside.soft = noise > 0 ? 4.0F : 1.0F;
  }
  leave_margins(inside);
  volume::Grid grid;
  grid.size = inside.size + 2 * inside.margin;
  grid.voxel = 0.5e-3;
  volume::TissueTable table;
  table.tissues.resize(2);
  table.tissues[1].kind = volume::TissueKind::solid;
  NoProgress progress;
  const auto bone = bone_from_inside(grid, table, inside, {}, 0, progress);
  if (labels) restore_tissue_volumes(*bone, {-1, 500}, law);
  return bone->content_hash();
}

TEST(BoneLaw, OneGivesTheBonesOfBefore) {
  // computed by the program of 2026-11-28 on the same arrays
  EXPECT_EQ(hash_by_law(1, false, 0), 0x2801cd9b131ca589U);
  EXPECT_EQ(hash_by_law(1, false, 40), 0x6a8ea75c96f99339U);
  EXPECT_EQ(hash_by_law(1, true, 0), 0xd41884b02957a211U);
  EXPECT_NE(hash_by_law(2, false, 0), hash_by_law(1, false, 0));
}

// The recipe of the recording decides: between thick slices law 1 overshoots, law 2 does not.
TEST(BoneLaw, IsTheRecipes) {
  io::Scan scan;
  scan.size = {16, 16, 8};
  scan.spacing_mm = {0.5, 0.5, 2};
  scan.hounsfield = true;
  for (int k = 0; k < 8; ++k)
    for (int v = 0; v < 16 * 16; ++v)
      scan.values.push_back(v == 100 && k == 2 ? 900.0F : k < 4 ? 280.0F : -1000.0F);
  scenario::BoneRecipe recipe;
  NoProgress progress;
  const auto now = import_bone(scan, recipe, progress);
  recipe.bone_law = 1;
  const auto before = import_bone(scan, recipe, progress);
  ASSERT_TRUE(now.ok() && before.ok());
  EXPECT_GT(before->summary.solid_mm3, 10 * now->summary.solid_mm3);
}

}  // namespace
}  // namespace burr::importing
