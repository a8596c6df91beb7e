// The figures of a label, on bodies whose figures are known and on real bones.
#include "burr/workshop/label_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/scenario/open_lesson.h"
#include "burr/workshop/open_bone.h"
#include "support/data.h"

namespace burr::workshop {
namespace {

using math::Vec3;
using volume::TissueId;
using volume::TissueKind;

constexpr double kVoxel = 0.25e-3;

// Tissues 1 (solid), 2 "nerve" and 3 "vein" (soft) in a cube of 80 voxels; `label` gives the tissue
// of a voxel by its place in voxels from the middle.
std::unique_ptr<volume::Bone> bone_of(const std::function<TissueId(const Vec3&)>& label) {
  constexpr int kEdge = 80;
  volume::Grid grid;
  grid.size = {kEdge, kEdge, kEdge};
  grid.voxel = kVoxel;
  volume::TissueTable table;
  table.tissues = {{.name = "air", .kind = TissueKind::air},
                   {.name = "bone"},
                   {.name = "nerve", .kind = TissueKind::soft},
                   {.name = "vein", .kind = TissueKind::soft}};
  std::vector<volume::Field> field(static_cast<std::size_t>(kEdge * kEdge * kEdge));
  std::vector<TissueId> tissue(field.size());
  for (std::size_t v = 0; v < field.size(); ++v) {
    const auto n = static_cast<int>(v);
    const Vec3 p(n % kEdge - 39.5, n / kEdge % kEdge - 39.5, n / kEdge / kEdge - 39.5);
    tissue[v] = label(p);
    // solid bone ends at x = 20, although its label reaches further
    field[v] = tissue[v] == 1 && p.x() < 20 ? volume::kSolid : volume::Field{0};
  }
  return volume::bone_from_arrays(grid, table, field, tissue, {}, 0);
}

LabelFigures figures_of(const volume::Bone& bone, TissueId id) {
  return label_figures(bone, std::span(&id, 1));
}

TEST(LabelFigures, OfABall) {
  const auto bone =
      bone_of([](const Vec3& p) { return p.norm() < 12 ? TissueId{2} : TissueId{0}; });
  const LabelFigures f = figures_of(*bone, 2);
  const double r = 12 * kVoxel;
  EXPECT_NEAR(f.volume, 4.0 / 3 * std::numbers::pi * r * r * r, 0.02 * f.volume);
  EXPECT_NEAR(f.inscribed, r, 1 * kVoxel);
  EXPECT_EQ(f.pieces, 1);
  EXPECT_NEAR(f.length, 2 * r, 2 * kVoxel);
  EXPECT_TRUE(f.neighbours.empty());
}

TEST(LabelFigures, TheInscribedRadiusTellsAFloodedNerveFromANerve) {
  const auto tube = [](const Vec3& p) { return std::hypot(p.x(), p.y()) < 4; };
  const auto sound = bone_of([&](const Vec3& p) { return tube(p) ? TissueId{2} : TissueId{0}; });
  const auto flooded = bone_of([&](const Vec3& p) {
    return tube(p) || (p - Vec3(0, 0, 20)).norm() < 13 ? TissueId{2} : TissueId{0};
  });
  EXPECT_NEAR(figures_of(*sound, 2).inscribed, 4 * kVoxel, 1.0 * kVoxel);
  EXPECT_NEAR(figures_of(*flooded, 2).inscribed, 13 * kVoxel, 1.0 * kVoxel);
  EXPECT_NEAR(figures_of(*sound, 2).length, 80 * kVoxel, 3 * kVoxel);
}

TEST(LabelFigures, PiecesAreCountedAndSpecksAreNot) {
  const auto bone = bone_of([](const Vec3& p) {
    const bool in = (p - Vec3(-20, 0, 0)).norm() < 8 || (p - Vec3(20, 0, 0)).norm() < 8 ||
                    (p - Vec3(0.5, 0.5, 30.5)).norm() < 1.2;
    return in ? TissueId{2} : TissueId{0};
  });
  EXPECT_EQ(figures_of(*bone, 2).pieces, 2);
}

TEST(LabelFigures, SolidTissueEndsAtTheSurfaceAndNeighboursAreFound) {
  const auto bone = bone_of([](const Vec3& p) {
    if (std::abs(p.y()) > 10 || std::abs(p.z()) > 10 || p.x() < -20) return TissueId{0};
    return p.x() < 0 ? TissueId{2} : TissueId{1};
  });
  const LabelFigures solid = figures_of(*bone, 1);
  EXPECT_EQ(solid.voxels, 20U * 20 * 20) << "the label reaches to x = 40, the bone to 20";
  EXPECT_EQ(solid.neighbours, std::vector<TissueId>{2});
  EXPECT_EQ(figures_of(*bone, 2).neighbours, std::vector<TissueId>{1});
  EXPECT_EQ(figures_of(*bone, 3).voxels, 0U);
  EXPECT_EQ(figures_of(*bone, 3).pieces, 0);
}

scenario::CaseLesson lesson_with(const std::string& structures) {
  const auto read = scenario::parse_lesson("format = 2\ntitle = \"t\"\n" + structures, "my.toml");
  EXPECT_TRUE(read) << read.error().text;
  return read ? *read : scenario::CaseLesson();
}

std::vector<LabelFinding> check(const std::string& structures, const volume::Bone& bone,
                                const std::vector<std::string>& accepted = {}) {
  NoProgress quiet;
  const auto found = check_labels(lesson_with(structures), bone, accepted, quiet);
  EXPECT_TRUE(found) << found.error().text;
  return found ? *found : std::vector<LabelFinding>();
}

TEST(LabelFigures, AFigureHasNoExponent) {
  EXPECT_EQ(figure(11813.4, 4), "11810");
  EXPECT_EQ(figure(20137, 3), "20100");
  EXPECT_EQ(figure(998.7, 3), "999");
  EXPECT_EQ(figure(9996, 3), "10000");
  EXPECT_EQ(figure(0.85, 3), "0.85");
  EXPECT_EQ(figure(99.96, 3), "100");
  EXPECT_EQ(figure(-12.346, 4), "-12.35");
  EXPECT_EQ(figure(1.2345e-6, 2), "0.0000012");
  EXPECT_EQ(figure(0, 3), "0");
  EXPECT_EQ(figure(3, 3), "3");
}

TEST(CheckLabels, ALargeFigureIsWrittenOut) {
  const auto bone =
      bone_of([](const Vec3& p) { return p.norm() < 35 ? TissueId{2} : TissueId{0}; });
  const auto found =
      check("[[structure]]\nname = \"nerve\"\nvolume_mm3 = [40, 200000]\npieces = [2, 3]\n", *bone);
  EXPECT_EQ(found.at(0).faults.at(0), "its pieces are 1, expected 2 to 3");
  const auto small = check("[[structure]]\nname = \"nerve\"\nvolume_mm3 = [1, 2]\n", *bone);
  EXPECT_EQ(small.at(0).faults.at(0).find("e+"), std::string::npos) << small.at(0).faults.at(0);
}

TEST(CheckLabels, SaysTheFigureAndTheExpectedRange) {
  const auto bone = bone_of([](const Vec3& p) {
    if (p.norm() < 12) return TissueId{2};
    return p.x() > 20 ? TissueId{3} : TissueId{0};
  });
  const auto faults = [&](const std::string& expectation) {
    const auto found = check(
        "[[structure]]\nname = \"nerve\"\n" + expectation + "\n[[structure]]\nname = \"vein\"\n",
        *bone);
    return found.at(0).faults;
  };
  EXPECT_TRUE(faults("volume_mm3 = [100, 130]\ninscribed_mm = [2, 4]\npieces = [1, 1]").empty());
  EXPECT_EQ(faults("volume_mm3 = [40, 60]").at(0), "its volume is 113 mm3, expected 40 to 60 mm3");
  EXPECT_NE(faults("inscribed_mm = [0.5, 1.6]").at(0).find("expected 0.5 to 1.6 mm"),
            std::string::npos);
  EXPECT_EQ(faults("pieces = [2, 3]").at(0), "its pieces are 1, expected 2 to 3");
  EXPECT_NE(faults("length_mm = 10").at(0).find("expected at least 10 mm"), std::string::npos);
  EXPECT_EQ(faults("touches = [\"vein\"]").at(0), "it does not touch \"vein\", but must");
  EXPECT_TRUE(faults("apart = [\"vein\"]").empty());
}

TEST(CheckLabels, ATouchThatMustNotBeIsAFault) {
  const auto bone = bone_of([](const Vec3& p) {
    if (p.norm() > 15) return TissueId{0};
    return p.x() < 0 ? TissueId{2} : TissueId{3};
  });
  const std::string both =
      "[[structure]]\nname = \"nerve\"\napart = [\"vein\"]\n"
      "[[structure]]\nname = \"vein\"\ntouches = [\"nerve\"]\n";
  const auto found = check(both, *bone);
  EXPECT_EQ(found.at(0).faults, std::vector<std::string>{"it touches \"vein\", but must not"});
  EXPECT_TRUE(found.at(1).faults.empty());
}

TEST(CheckLabels, AMissingLabelIsAFaultUnlessItIsOptional) {
  const auto bone = bone_of([](const Vec3&) { return TissueId{0}; });
  const auto found = check(
      "[[structure]]\nname = \"nerve\"\n[[structure]]\nname = \"drum\"\n"
      "[[structure]]\nname = \"vein\"\noptional = true\n",
      *bone);
  EXPECT_EQ(found.at(0).faults, std::vector<std::string>{"its label is empty"});
  EXPECT_EQ(found.at(1).faults, std::vector<std::string>{"the bone has no such label"});
  EXPECT_TRUE(found.at(2).faults.empty());
}

TEST(CheckLabels, SynonymsAreOneStructure) {
  const auto bone = bone_of([](const Vec3& p) {
    if (p.norm() > 15) return TissueId{0};
    return p.x() < 0 ? TissueId{2} : TissueId{3};
  });
  const auto found = check(
      "[[structure]]\nname = \"both\"\nnames = [\"nerve\", \"vein\", \"Nervus\"]\n"
      "pieces = [1, 1]\n",
      *bone);
  EXPECT_EQ(found.at(0).tissues, (std::vector<std::string>{"nerve", "vein"}));
  EXPECT_TRUE(found.at(0).faults.empty());
}

TEST(CheckLabels, AFaultMayBeAcceptedByName) {
  const auto bone = bone_of([](const Vec3&) { return TissueId{0}; });
  const auto found = check("[[structure]]\nname = \"nerve\"\n", *bone, {"nerve"});
  EXPECT_TRUE(found.at(0).accepted);
  EXPECT_FALSE(found.at(0).faults.empty()) << "accepted, not forgotten";
  NoProgress quiet;
  const auto wrong =
      check_labels(lesson_with("[[structure]]\nname = \"nerve\"\n"), *bone, {"nerves"}, quiet);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().trouble, Trouble::usage);
}

TEST(CheckLabels, TheSentenceNamesTheLineOfTheFirstFault) {
  const auto bone = bone_of([](const Vec3&) { return TissueId{0}; });
  // title and format take two lines
  const std::string three =
      "[[structure]]\nname = \"nerve\"\n\n[[structure]]\nname = \"vein\"\n"
      "[[structure]]\nname = \"drum\"\n";
  const Status all = as_expected(check(three, *bone), "my.toml");
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().trouble, Trouble::data);
  EXPECT_EQ(all.error().text,
            "my.toml: line 3: 3 labels are not as the case expects; \"nerve\": its label is empty; "
            "mend the label, give the case another range, or accept it with `accepted_labels` "
            "\"nerve\"");
  const Status some = as_expected(check(three, *bone, {"nerve", "drum"}), "my.toml");
  ASSERT_FALSE(some);
  EXPECT_EQ(some.error().text.rfind("my.toml: line 6: 1 label is not", 0), 0U) << some.error().text;
  EXPECT_TRUE(as_expected(check(three, *bone, {"nerve", "drum", "vein"}), "my.toml"));
}

// ---- real bones

LabelFigures facial_nerve_of(const std::string& file) {
  scenario::BoneRecipe recipe;
  recipe.source = (test::data_dir() / "temporal_bone" / file).string();
  NoProgress quiet;
  auto made = open_bone(recipe, quiet);
  EXPECT_TRUE(made) << made.error().text;
  if (!made) return {};
  scenario::Structure nerve;
  nerve.names = {"Facial_Nerve"};
  return label_figures(*made->bone, tissues_of(nerve, made->bone->tissues()));
}

TEST(RealLabels, TheFacialNerveOfRT147IsFlooded) {
  BURR_NEEDS_DATA("temporal_bone/RT147_256.seg.nrrd");
  const LabelFigures f = facial_nerve_of("RT147_256.seg.nrrd");
  EXPECT_GT(1e9 * f.volume, 900);
  EXPECT_LT(1e9 * f.volume, 1100);
  EXPECT_GT(1e3 * f.inscribed, 2.8);
}

TEST(RealLabels, TheFacialNerveOfLT151IsSound) {
  BURR_NEEDS_DATA("temporal_bone/LT151_256.seg.nrrd");
  const LabelFigures f = facial_nerve_of("LT151_256.seg.nrrd");
  EXPECT_GT(1e9 * f.volume, 40);
  EXPECT_LT(1e9 * f.volume, 200);
  EXPECT_GT(1e3 * f.inscribed, 0.5);
  EXPECT_LT(1e3 * f.inscribed, 1.6);
}

}  // namespace
}  // namespace burr::workshop
