// What the window shows of two recordings beside each other: distances, violations, losses, and where they cut
// differently, against bones and ways of known shape.
#include "window/replay/facts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "burr/record/player.h"
#include "burr/render/bone_scene.h"
#include "support/folder.h"
#include "support/test_places.h"
#include "window/replay/difference.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using math::Vec3;

// A slab of bone, 24 x 24 x 16 mm, whose lower 15 mm are to be spared, and a burr that is pushed
// straight down into it.
class SlabFacts : public testing::Test {
 protected:
  static constexpr double kTop =
      14.5e-3;  // of what is to be spared; voxels of 1 mm, the first at 0
  static std::unique_ptr<test::Folder>& own() {
    static std::unique_ptr<test::Folder> folder;
    return folder;
  }
  static const fs::path& folder() { return own()->path(); }
  static std::string recording() { return (folder() / "s.mcap").string(); }
  static void SetUpTestSuite() {
    own() = std::make_unique<test::Folder>();
    const fs::path slab = folder() / "slab.nrrd", table = folder() / "table.toml";
    std::ofstream(table) << "[[label]]\nvalue = 1\nname = \"bone\"\nkind = \"solid\"\n"
                            "[[label]]\nvalue = 2\nname = \"plate\"\nkind = \"solid\"\n"
                            "spare = true\n";
    std::ofstream file(slab, std::ios::binary);
    file << "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\n"
            "sizes: 24 24 24\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
            "space origin: (0,0,0)\nendian: little\nencoding: raw\n\n";
    for (int n = 0; n < 24 * 24 * 24; ++n) {
      const int k = n / (24 * 24);
      file.put(static_cast<char>(k < 15 ? 2 : k < 16 ? 1 : 0));
    }
    file.close();
    const std::string command = test::build_dir() + "/burr --quiet mill " + slab.string() +
                                " --tissues " + table.string() +
                                " --motion plunge --at 12,12,16 --into 0,0,-1 --burr-mm 5 "
                                "--seconds 8 --record " +
                                recording() + " > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    recipe().source = slab.string();
    recipe().labels = table.string();
  }
  static void TearDownTestSuite() { own().reset(); }
  static scenario::BoneRecipe& recipe() {
    static scenario::BoneRecipe recipe;
    return recipe;
  }
};

TEST_F(SlabFacts, AreThoseOfTheWayThatTheBurrWent) {
  NoProgress quiet;
  const auto facts = facts_of(recording(), recipe(), quiet);
  ASSERT_TRUE(facts) << facts.error().text;
  auto player = record::Player::open(recording());
  ASSERT_TRUE(player);
  double least = 1, from = -1, until = -1, deepest = 0, removed = 0;
  record::StepCursor steps = (*player)->steps();
  for (record::Step step; steps.next(step);) {
    const double t = static_cast<double>(step.row.tick) / (*player)->info().rate_hz;
    const double away = step.row.contact.proxy.z() - kTop - step.row.tool.radius;
    least = std::min(least, away);
    removed = step.row.ledger.removed;
    if (away > -0.5e-3) continue;
    if (from < 0) from = t;
    until = t;
    deepest = std::max(deepest, -away);
  }
  ASSERT_GT(from, 0) << "the burr did not get deep enough: the test shows nothing";
  EXPECT_TRUE(facts->spares);
  const auto told = facts->least();
  ASSERT_TRUE(told);
  EXPECT_NEAR(told->distance, std::max(least, -0.5e-3 - 2.5e-3), 0.05e-3);
  const double there = (*player)->tick_at(told->t)->contact.proxy.z() - kTop - 2.5e-3;
  EXPECT_NEAR(there, least, 0.05e-3) << "at " << told->t << " s";
  EXPECT_EQ(told->name, "plate");
  ASSERT_EQ(facts->violations.size(), 1U);
  EXPECT_EQ(facts->violations[0].name, "plate");
  EXPECT_NEAR(facts->violations[0].from, from, 0.1);
  EXPECT_NEAR(facts->violations[0].until, until, 0.1);
  // before the burr is near
  EXPECT_NEAR(static_cast<double>(facts->nearest_in(0, 0.001).distance),
              (*player)->tick_at(0)->contact.proxy.z() - kTop - 2.5e-3, 0.1e-3);
  // what was lost, tissue by tissue, is what was removed
  double lost = 0;
  for (const auto& one : facts->lost) lost += one.removed;
  EXPECT_NEAR(lost, removed, 0.02e-9);
  EXPECT_EQ(facts->lost.size(), 2U);
}

TEST_F(SlabFacts, SayWhyThereAreNone) {
  NoProgress quiet;
  const auto none = facts_of((folder() / "no.mcap").string(), {}, quiet);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("no.mcap"), std::string::npos) << none.error().text;
}

TEST(FactsTable, HoldsTheTissuesOfBothTheLargestFirst) {
  const auto rows =
      compared({{"bone", 10, false}, {"nerve", 1, true}}, {{"bone", 8, false}, {"dura", 20, true}});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].name, "dura");
  EXPECT_EQ(rows[0].left, 0);
  EXPECT_EQ(rows[0].right, 20);
  EXPECT_TRUE(rows[0].spare);
  EXPECT_EQ(rows[1].name, "bone");
  EXPECT_EQ(rows[1].left, 10);
  EXPECT_EQ(rows[1].right, 8);
  EXPECT_FALSE(rows[1].spare);
  EXPECT_EQ(rows[2].name, "nerve");
  EXPECT_EQ(rows[2].right, 0);
}

// ---- the difference

constexpr int kSide = 40;
constexpr double kVoxel = 0.5e-3;
// in voxels: the slab is below kFace; two balls cut into it overlap
constexpr double kFace = 24.3, kRadius = 8;
const Vec3 kLeftBall(15, 20, 24), kRightBall(25, 20, 24);

double depth(const Vec3& p, bool left, bool right) {
  double inside = kFace - p.z();
  if (left) inside = std::min(inside, (p - kLeftBall).norm() - kRadius);
  if (right) inside = std::min(inside, (p - kRightBall).norm() - kRadius);
  return inside;
}

std::shared_ptr<volume::Bone> slab(bool left, bool right) {
  const volume::Grid grid = {.size = {kSide, kSide, kSide}, .voxel = kVoxel, .frame = {}};
  std::vector<volume::Field> field;
  for (int n = 0; n < kSide * kSide * kSide; ++n)
    field.push_back(volume::field_from_depth(
        depth(Vec3(n % kSide, n / kSide % kSide, n / (kSide * kSide)), left, right)));
  const std::vector<volume::TissueId> bone(field.size(), 1);
  volume::TissueTable table;
  return volume::bone_from_arrays(grid, table, field, bone, {}, 100);
}

TEST(Difference, OfAPlaceIsWhoCutIt) {
  EXPECT_EQ(cut_in(true, false, true), Cut::left_only);
  EXPECT_EQ(cut_in(true, true, false), Cut::right_only);
  EXPECT_EQ(cut_in(true, false, false), Cut::both);
  EXPECT_EQ(cut_in(true, true, true), Cut::none);
  EXPECT_EQ(cut_in(false, false, false), Cut::none);
  EXPECT_EQ(cut_in(false, true, false), Cut::none) << "added is not cut";
}

TEST(Difference, PaintsBothBonesAsTheShapesSayAndTakesThePaintAway) {
  const auto before = slab(false, false), left = slab(true, false), right = slab(false, true);
  ASSERT_TRUE(before && left && right);
  NoProgress quiet;
  render::Scene left_scene, right_scene;
  ASSERT_TRUE(render::skin_bone(left_scene, *left, 1, quiet));
  ASSERT_TRUE(render::skin_bone(right_scene, *right, 1, quiet));
  const std::size_t tissues = left_scene.tissue_colours.size();
  ASSERT_TRUE(Difference::add_colours(left_scene.tissue_colours));
  ASSERT_TRUE(Difference::add_colours(right_scene.tissue_colours));
  EXPECT_EQ(left_scene.tissue_colours.size(), tissues + 3);
  const auto tissues_of = [](const render::Scene& scene) {
    std::vector<int> all;
    for (const render::ScenePatch& patch : scene.patches)
      if (patch.mesh != nullptr)
        for (const render::SkinVertex& v : patch.mesh->vertices())
          all.push_back(render::tissue_of(v));
    return all;
  };
  const auto plain = tissues_of(left_scene);

  Difference difference(before);
  difference.paint(left_scene, *left, right_scene, *right);
  ASSERT_TRUE(difference.painted());
  std::size_t looked = 0;
  for (const bool is_left : {true, false}) {
    const render::Scene& scene = is_left ? left_scene : right_scene;
    for (const render::ScenePatch& patch : scene.patches) {
      if (patch.mesh == nullptr) continue;
      for (const render::SkinVertex& v : patch.mesh->vertices()) {
        const Vec3 p = v.p.cast<double>() / kVoxel;
        if ((p.array() < 1).any() || (p.array() > kSide - 2).any()) continue;  // the scan's edge
        const double was = depth(p, false, false), other = depth(p, !is_left, is_left);
        if (std::abs(std::abs(was) - 0.4) < 0.3 || std::abs(std::abs(other) - 0.4) < 0.3)
          continue;  // near the border of what counts as the same
        const Cut mine = is_left ? Cut::left_only : Cut::right_only,
                  others = is_left ? Cut::right_only : Cut::left_only;
        const Cut truth = other < -0.4  ? others
                          : was < 0.4   ? Cut::none
                          : other > 0.4 ? mine
                                        : Cut::both;
        const int painted = render::tissue_of(v) - static_cast<int>(tissues) + 1;
        EXPECT_EQ(std::max(0, painted), static_cast<int>(truth)) << p.transpose();
        ++looked;
      }
    }
  }
  EXPECT_GT(looked, 2000U);
  for (const Cut cut : {Cut::left_only, Cut::right_only})
    EXPECT_GT(difference.counts()[static_cast<std::size_t>(cut)], 100U);

  difference.unpaint();
  EXPECT_EQ(tissues_of(left_scene), plain);
  EXPECT_FALSE(difference.painted());
  // the same cavity twice: only what both cut
  difference.paint(left_scene, *left, left_scene, *left);
  EXPECT_EQ(difference.counts()[static_cast<std::size_t>(Cut::left_only)], 0U);
  EXPECT_EQ(difference.counts()[static_cast<std::size_t>(Cut::right_only)], 0U);
  EXPECT_GT(difference.counts()[static_cast<std::size_t>(Cut::both)], 500U);
}

TEST(Difference, HasNoColoursForTooManyTissues) {
  std::vector<render::Colour> colours(254);
  EXPECT_FALSE(Difference::add_colours(colours));
  colours.resize(253);
  EXPECT_TRUE(Difference::add_colours(colours));
  EXPECT_EQ(colours.size(), 256U);
}

}  // namespace
}  // namespace burr::app
