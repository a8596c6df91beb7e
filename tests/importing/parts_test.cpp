// The separate parts of a bone: counted against a flood fill, and removed without a trace.
#include "burr/importing/parts.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"
#include "burr/surface/enclosed.h"
#include "burr/volume/volume_of.h"
#include "support/data.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;
using volume::Bone;

using InsideAt = std::function<bool(const Ijk&)>;

// The second method: one voxel after the other is painted, and its neighbours after it. Sizes, the
// largest first.
std::vector<std::int64_t> flood(const Ijk& size, const InsideAt& inside) {
  const auto at = [&](const Ijk& p) {
    return static_cast<std::size_t>(p.x()) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(p.y()) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(p.z()));
  };
  std::vector<bool> painted(static_cast<std::size_t>(size.prod()));
  std::vector<std::int64_t> sizes;
  std::vector<Ijk> next;
  const auto paint = [&](const Ijk& p) {
    if (p.minCoeff() < 0 || (p.array() >= size.array()).any()) return;
    if (painted[at(p)] || !inside(p)) return;
    painted[at(p)] = true;
    next.push_back(p);
  };
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        paint({i, j, k});
        if (next.empty()) continue;
        std::int64_t count = 0;
        while (!next.empty()) {
          const Ijk p = next.back();
          next.pop_back();
          ++count;
          for (int a = 0; a < 3; ++a) {
            paint(p + Ijk::Unit(a));
            paint(p - Ijk::Unit(a));
          }
        }
        sizes.push_back(count);
      }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

Parts parts_of(const Ijk& size, const InsideAt& inside) {
  NoProgress progress;
  auto parts = find_parts(
      size,
      [&](int j, int k, std::span<std::uint8_t> row) {
        for (int i = 0; i < size.x(); ++i)
          row[static_cast<std::size_t>(i)] = inside({i, j, k}) ? 1 : 0;
      },
      progress);
  EXPECT_TRUE(parts);
  return std::move(*parts);
}

TEST(FindParts, FindsWhatAFloodFillFinds) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Ijk size(3 + static_cast<int>(random() % 20), 2 + static_cast<int>(random() % 20),
                   1 + static_cast<int>(random() % 20));
    // from single voxels to one sponge; in between are parts of every shape
    const unsigned share = 15 + 5 * seed;
    std::vector<bool> in(static_cast<std::size_t>(size.prod()));
    for (std::size_t n = 0; n < in.size(); ++n) in[n] = random() % 100 < share;
    const InsideAt inside = [&](const Ijk& p) {
      return static_cast<bool>(
          in[static_cast<std::size_t>(p.x() + size.x() * (p.y() + size.y() * p.z()))]);
    };
    const Parts parts = parts_of(size, inside);
    EXPECT_EQ(parts.parts, flood(size, inside));
    // neighbours are of one part, and each part is as large as it says
    std::vector<std::int64_t> counted(parts.parts.size());
    for (int k = 0; k < size.z(); ++k)
      for (int j = 0; j < size.y(); ++j)
        for (int i = 0; i < size.x(); ++i) {
          const Ijk p(i, j, k);
          const auto part = parts.part_at(p);
          ASSERT_EQ(part.has_value(), inside(p));
          if (!part) continue;
          ++counted[*part];
          for (int a = 0; a < 3; ++a)
            if (const auto other = parts.part_at(p + Ijk::Unit(a))) {
              ASSERT_EQ(*part, *other);
            }
        }
    EXPECT_EQ(counted, parts.parts);
  }
}

TEST(FindParts, AnEdgeOrACornerDoesNotJoin) {
  EXPECT_EQ(parts_of({2, 2, 1}, [](const Ijk& p) { return p.x() == p.y(); }).parts.size(), 2U);
  EXPECT_EQ(parts_of({2, 2, 2}, [](const Ijk& p) { return p.x() == p.y() && p.y() == p.z(); })
                .parts.size(),
            2U);
  EXPECT_TRUE(parts_of({3, 3, 3}, [](const Ijk&) { return false; }).parts.empty());
}

// ---- a ball beside a table

constexpr double kRadius = 5.3;  // [mm], voxels of 1 mm

io::Scan scan_of(const Ijk& size, const std::function<double(const Vec3&)>& value) {
  io::Scan scan;
  scan.size = size;
  scan.origin_mm = {-20, 13, 7};
  scan.hounsfield = true;
  scan.format = "test";
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
        scan.values.push_back(static_cast<float>(std::round(value({i * 1.0, j * 1.0, k * 1.0}))));
  return scan;
}
const Vec3 kBall(16.2, 12.4, 15.7);  // in voxels; it ends at y = 17.7
double ball(const Vec3& p) {
  return -1000.0 * std::erf(((p - kBall).norm() - kRadius) / (std::sqrt(2.0) * 0.6));
}
// a slab from y = 21 on, of the densest metal, with a soft rim
double table(const Vec3& p) {
  if (p.x() < 3 || p.x() > 28 || p.z() < 3 || p.z() > 28) return -1000;
  return p.y() >= 21 && p.y() <= 24 ? 3000 : p.y() == 20 || p.y() == 25 ? -200 : -1000;
}
double both(const Vec3& p) { return std::max(ball(p), table(p)); }
const Ijk kSize(32, 32, 32);

scenario::BoneRecipe keeping(const scenario::Keep& keep) {
  scenario::BoneRecipe recipe;
  recipe.keep = keep;
  return recipe;
}
Imported made_of(const io::Scan& scan, const scenario::BoneRecipe& recipe) {
  NoProgress progress;
  auto made = import_bone(scan, recipe, progress);
  EXPECT_TRUE(made) << made.error().text;
  return made ? std::move(*made) : Imported{};
}
bool says(const ImportSummary& summary, const std::string& what) {
  return std::any_of(summary.notices.begin(), summary.notices.end(),
                     [&](const std::string& one) { return one.find(what) != std::string::npos; });
}

TEST(RemoveParts, ATableBesideABallGoesWithoutATrace) {
  const Imported alone = made_of(scan_of(kSize, ball), {}),
                 with = made_of(scan_of(kSize, both), {}),
                 kept = made_of(scan_of(kSize, both), keeping({0, {Vec3(-20, 13, 7) + kBall}}));
  ASSERT_TRUE(alone.bone && with.bone && kept.bone);
  // the test shows something: the two lie in one brick, and the table is the larger part
  ASSERT_LT(alone.summary.solid_mm3, 0.5 * with.summary.solid_mm3);
  ASSERT_GE(with.bone->field(16, 17, 16), volume::kIso);
  ASSERT_GE(with.bone->field(16, 21, 16), volume::kIso);
  EXPECT_EQ(17 / volume::kBrickEdge, 21 / volume::kBrickEdge);
  EXPECT_NEAR(kept.summary.solid_mm3 / alone.summary.solid_mm3, 1, 1e-6);
  // no film: the field is everywhere that of the ball alone
  ASSERT_EQ(kept.bone->grid().size, alone.bone->grid().size);
  for (int k = 0; k < kSize.z(); ++k)
    for (int j = 0; j < kSize.y(); ++j)
      for (int i = 0; i < kSize.x(); ++i)
        ASSERT_EQ(kept.bone->field(i, j, k), alone.bone->field(i, j, k))
            << i << " " << j << " " << k;
  ASSERT_TRUE(kept.summary.parts);
  EXPECT_EQ(kept.summary.parts->count, 2U);
  EXPECT_EQ(kept.summary.parts->removed, 1U);
  const double table = 1e9 * (surface::enclosed_volume(*with.bone) -
                              surface::enclosed_volume(*alone.bone));  // what its mesh encloses
  EXPECT_NEAR(kept.summary.parts->removed_mm3, table, 0.005 * table);
  EXPECT_TRUE(says(kept.summary, "One of 2 separate parts was removed")) << "no notice";
  EXPECT_TRUE(says(kept.summary, fmt::format("{:.0f} mm3", kept.summary.parts->removed_mm3)));
}

// One layer of air between them is the least that two parts can have.
TEST(RemoveParts, OneVoxelAwayTheSurfaceStaysWhereItWas) {
  const auto near = [](const Vec3& p) {
    return std::max(ball(p), p.y() >= 19 && p.y() <= 22 && p.x() > 2 && p.x() < 29 ? 2000.0 : -1e9);
  };
  const Vec3 at = Vec3(-20, 13, 7) + kBall;
  const Imported alone = made_of(scan_of(kSize, ball), {}),
                 kept = made_of(scan_of(kSize, near), keeping({0, {at}}));
  ASSERT_TRUE(alone.bone && kept.bone);
  EXPECT_EQ(kept.summary.parts->removed, 1U);
  EXPECT_NEAR(kept.summary.solid_mm3 / alone.summary.solid_mm3, 1, 1e-3);
}

// A ball of label 1 with a core of label 2, and maybe a box of label 2 beside it, in a bath of soft 3.
io::Scan labels(double slice, bool with_box) {
  io::Scan scan = scan_of({32, 32, static_cast<int>(32 / slice)}, [](const Vec3&) { return 0; });
  scan.spacing_mm.z() = slice;
  for (int k = 0; k < scan.size.z(); ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) {
        const double r = (Vec3(i, j, k * slice) - kBall).norm();
        const bool box = with_box && j >= 20 && j <= 27 && i >= 3 && i <= 28 && k >= 2 && k <= 12;
        scan.labels.push_back(r < 4 ? 2 : r < 6.5 ? 1 : box ? 2 : j > 4 ? 3 : 0);
      }
  scan.values.clear();
  scan.hounsfield = false;
  for (const auto& [value, name] : {std::pair{1, "cortical bone"}, {2, "bone"}, {3, "skin"}}) {
    io::Label label;
    label.value = value;
    label.name = name;
    scan.label_names.push_back(label);
  }
  return scan;
}

TEST(RemoveParts, OfLabelsGoWithoutATraceAndKeepTheVolumeOfWhatIsLeft) {
  for (const double slice : {1.0, 2.0}) {
    SCOPED_TRACE(slice);
    const io::Scan without = labels(slice, false), with = labels(slice, true);
    const Imported alone = made_of(without, {}), both = made_of(with, {}),
                   kept = made_of(with, keeping({0, {with.origin_mm + kBall}}));
    ASSERT_TRUE(alone.bone && both.bone && kept.bone);
    EXPECT_EQ(kept.summary.parts->count, 2U) << "all solid labels count together";
    EXPECT_EQ(kept.summary.parts->removed, 1U);
    EXPECT_GT(both.summary.solid_mm3, 2 * alone.summary.solid_mm3);
    // what was around the box is where it was, and the volumes of both labels are restored
    EXPECT_EQ(kept.bone->content_hash(), alone.bone->content_hash());
    for (std::size_t n = 0; n < alone.summary.tissues.size(); ++n)
      EXPECT_EQ(kept.summary.tissues[n].voxels, alone.summary.tissues[n].voxels);
  }
}

// ---- what can be asked for

// three balls, the smallest of 7 voxels, and a single voxel
double balls(const Vec3& p) {
  double value = -1000;
  for (const auto& [at, radius] :
       {std::pair{Vec3(8, 8, 8), 5.0}, {Vec3(22, 22, 22), 3.0}, {Vec3(22, 8, 8), 1.5}})
    value = std::max(value, -1000 * (((p - at).norm() - radius)));
  return (p - Vec3(8, 26, 26)).norm() < 0.1 ? 1000 : std::clamp(value, -1000.0, 1000.0);
}

TEST(ChooseParts, BySizePointAndVolume) {
  const io::Scan scan = scan_of(kSize, balls);
  scenario::BoneRecipe recipe;
  recipe.smooth = 0;
  NoProgress progress;
  const auto found = [&](const scenario::BoneRecipe& wanted) {
    auto plan = plan_import(scan, wanted);
    EXPECT_TRUE(plan) << plan.error().text;
    const Status counted = count_parts(scan, wanted, progress, *plan);
    EXPECT_TRUE(counted) << counted.error().text;
    return *plan;
  };
  EXPECT_EQ(found(recipe).parts->count, 4U);
  EXPECT_EQ(found(recipe).parts->removed, 0U);
  recipe.keep.largest = 1;
  EXPECT_EQ(found(recipe).parts->removed, 3U);
  EXPECT_TRUE(says(found(recipe), "3 of 4 separate parts were removed (`keep`)"));
  recipe.keep.at_mm = {scan.origin_mm + Vec3(22, 8, 8)};
  EXPECT_EQ(found(recipe).parts->removed, 2U) << "the largest, and that at the point";
  recipe.keep.largest = 9;
  EXPECT_EQ(found(recipe).parts->removed, 0U);
  EXPECT_TRUE(says(found(recipe), "has only 4 parts, so `keep` 9 keeps them all"));
  recipe.keep = {};
  recipe.drop_islands_mm3 = 1.5;
  EXPECT_EQ(found(recipe).parts->removed, 1U) << "the single voxel: an octahedron of half a voxel";
  const double reach = (1000 - 300) / 2000.0;  // from the voxel to the level, along each axis
  EXPECT_NEAR(found(recipe).parts->removed_mm3, 4.0 / 3 * reach * reach * reach, 0.002);
  EXPECT_TRUE(says(found(recipe), "(`drop_islands_mm3`): 0.05"));
  EXPECT_TRUE(says(found(recipe), "mm3, at -12,39,33 mm"));
  recipe.drop_islands_mm3 = 20;
  EXPECT_EQ(found(recipe).parts->removed, 2U);
}

TEST(ChooseParts, APointBesideBoneIsSaid) {
  const io::Scan scan = scan_of(kSize, balls);
  NoProgress progress;
  const auto at = [&](const Vec3& voxel) {
    scenario::BoneRecipe recipe = keeping({0, {scan.origin_mm + voxel}});
    recipe.smooth = 0;
    return import_bone(scan, recipe, progress);
  };
  const auto near = at({8, 8, 12.9});  // the last voxel of that ball is 8, 8, 12
  ASSERT_TRUE(near) << near.error().text;
  EXPECT_TRUE(says(near->summary, "the part 0.9 mm away is kept"));
  const auto far = at({8, 8, 16.5});
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().trouble, Trouble::usage);
  EXPECT_NE(far.error().text.find("nearest part is 4.5 mm away, at -12,21,19"), std::string::npos)
      << far.error().text;
  EXPECT_FALSE(at({1e9, 0, 0}));
  scenario::BoneRecipe recipe;
  recipe.drop_islands_mm3 = 1e6;
  const auto nothing = import_bone(scan, recipe, progress);
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().text.find("leaves nothing"), std::string::npos);
}

// ---- real scans

// The second method paints the voxels of the bone that an import makes, and looks for each voxel of the
// file in it: without smoothing, on the file's own voxels.
void counts_as_a_flood_fill(const char* file, const std::optional<scenario::Region>& region) {
  NoProgress progress;
  const auto scan = io::read_scan((test::data_dir() / file).string(), {}, progress);
  ASSERT_TRUE(scan) << scan.error().text;
  scenario::BoneRecipe recipe;
  recipe.region = region;
  recipe.smooth = 0;
  auto plan = plan_import(*scan, recipe);
  ASSERT_TRUE(plan) << plan.error().text;
  ASSERT_EQ(plan->size, plan->roi_size) << "resampled: the voxels are not those of the file";
  const Status counted = count_parts(*scan, recipe, progress, *plan);
  ASSERT_TRUE(counted) << counted.error().text;
  const Imported made = made_of(*scan, recipe);
  ASSERT_TRUE(made.bone);
  const Bone& bone = *made.bone;
  const auto inside = [&bone](const Ijk& p) {
    return bone.field(p.x(), p.y(), p.z()) >= volume::kIso;
  };
  const auto sizes = flood(bone.grid().size, inside);
  EXPECT_GT(sizes.size(), 5U) << "not much to count";
  EXPECT_EQ(plan->parts->count, sizes.size());
  // what a mesh encloses is near the sum of its voxels where a part is thick
  const double each = scan->spacing_mm.prod();
  EXPECT_NEAR(plan->parts->largest_mm3 / (static_cast<double>(sizes[0]) * each), 1, 0.1);
  // all bone of the file, and few voxels more: those that join crumbs
  std::int64_t lost = 0, own = 0;
  const Ijk margin = (bone.grid().size - plan->size) / 2;
  for (int k = 0; k < plan->size.z(); ++k)
    for (int j = 0; j < plan->size.y(); ++j)
      for (int i = 0; i < plan->size.x(); ++i) {
        const Ijk v = Ijk(i, j, k) + plan->roi_from;
        if (double{scan->values[static_cast<std::size_t>(
                v.x() + scan->size.x() * (v.y() + scan->size.y() * v.z()))]} < plan->iso)
          continue;
        ++own;
        if (!inside(Ijk(i, j, k) + margin)) ++lost;
      }
  EXPECT_EQ(lost, 0);
  EXPECT_LT(std::accumulate(sizes.begin(), sizes.end(), std::int64_t{0}), own + own / 50);
}

TEST(RealParts, OfAJawAreCountedAsAFloodFillCountsThem) {
  BURR_NEEDS_DATA("jaw_cbct/jaw_cbct_half_0.4mm.nii.gz");
  counts_as_a_flood_fill("jaw_cbct/jaw_cbct_half_0.4mm.nii.gz",
                         scenario::Region{{60, 199}, {20, 139}, {60, 139}});
}

}  // namespace
}  // namespace burr::importing
