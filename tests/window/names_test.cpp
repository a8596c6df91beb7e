// Names of structures: which one lies under the pointer, how far each is, and where pinned names
// stand.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "burr/phantom/build.h"
#include "burr/phantom/phantoms.h"
#include "burr/render/bone_scene.h"
#include "burr/render/unseen.h"
#include "burr/volume/distance_to.h"
#include "shared/word_names.h"
#include "user.h"
#include "window/mill/orientation_cube.h"
#include "window/mill/pinned_labels.h"
#include "window/mill/structures.h"

namespace burr::app {
namespace {

using math::Vec3;
using volume::TissueId;

// A block of bone with a nerve along x, 4 mm deep and 3 mm thick.
class NamedBlock : public testing::Test {
 protected:
  void SetUp() override {
    volume::TissueTable tissues;
    tissues.tissues.push_back({.name = "facial nerve",
                               .kind = volume::TissueKind::soft,
                               .colour = {1, 1, 0},
                               .spare = true});
    volume::Grid grid;
    grid.size = {40, 40, 40};
    grid.voxel = 0.5e-3;
    const std::size_t count = 40 * 40 * 40;
    std::vector<volume::Field> field(count, 0);
    std::vector<TissueId> tissue(count, 0);
    for (int k = 0; k < 40; ++k)
      for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) {
          const auto n = static_cast<std::size_t>(i + 40 * (j + 40 * k));
          const double block = std::min({i - 3.5, 35.5 - i, j - 3.5, 35.5 - j, k - 3.5, 35.5 - k});
          const double nerve = 3 - std::hypot(j - 20.0, k - 24.0);
          field[n] = volume::field_from_depth(std::min(block, -nerve));
          if (block > -0.5) tissue[n] = nerve > 0 ? kNerve : kBone;
        }
    bone_ = volume::bone_from_arrays(grid, tissues, field, tissue, {}, 100);
    NoProgress quiet;
    scene_.tissue_colours = render::colours_of(bone_->tissues());
    ASSERT_TRUE(render::skin_bone(scene_, *bone_, 1, quiet));
  }
  // from above, at this place  [voxel]
  static render::Ray down(double i, double j) {
    return {{0.5e-3 * i, 0.5e-3 * j, 60e-3}, {0, 0, -1}};
  }
  static constexpr TissueId kBone = 1, kNerve = 2;
  std::unique_ptr<volume::Bone> bone_;
  render::Scene scene_;
};

TEST_F(NamedBlock, UnderThePointerIsTheSurfaceAndSeeThroughTheNerve) {
  Structures structures(*bone_, nullptr, nullptr);
  const auto opaque = structures.under(scene_, down(20, 20));
  ASSERT_TRUE(opaque);
  EXPECT_EQ(opaque->id, kBone);
  scene_.look.opacity = 0.35;
  const auto through = structures.under(scene_, down(20, 20));
  ASSERT_TRUE(through);
  EXPECT_EQ(through->id, kNerve);
  EXPECT_NEAR(through->at.z(), 0.5e-3 * 27, 0.6e-3) << "its upper rim";
  const auto beside = structures.under(scene_, down(20, 30));
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->id, kBone);
  EXPECT_FALSE(structures.under(scene_, down(60, 60))) << "no bone there";
}

TEST_F(NamedBlock, AHiddenStructureHasNoNameAndNoColour) {
  Structures structures(*bone_, nullptr, nullptr);
  scene_.look.opacity = 0.35;
  structures.toggle(kNerve);
  EXPECT_EQ(structures.under(scene_, down(20, 20))->id, kBone);
  std::vector<render::Colour> colours = render::colours_of(bone_->tissues());
  structures.hide_in(colours);
  EXPECT_TRUE(render::is_unseen(colours[kNerve]));
  EXPECT_FALSE(render::is_unseen(colours[kBone]));
  structures.toggle(kBone);
  EXPECT_EQ(structures.under(scene_, down(20, 30))->id, kBone) << "bone is never hidden";
  structures.toggle(kNerve);
  EXPECT_EQ(structures.under(scene_, down(20, 20))->id, kNerve);
}

TEST_F(NamedBlock, ASliceNamesWhatIsThereNow) {
  Structures structures(*bone_, nullptr, nullptr);
  EXPECT_EQ(structures.at(0.5e-3 * Vec3(20, 20, 24)), kNerve);
  EXPECT_EQ(structures.at(0.5e-3 * Vec3(20, 30, 10)), kBone);
  EXPECT_EQ(structures.at(0.5e-3 * Vec3(1, 1, 1)), 0);
  EXPECT_EQ(structures.at(Vec3(1, 1, 1)), 0) << "outside";
  // milled away: labels stay, the field does not
  volume::BrickField gone = {};
  const math::Ijk b = math::Ijk(20, 30, 10) / volume::kBrickEdge;
  bone_->write_brick(bone_->brick_at(b.x(), b.y(), b.z()), gone);
  EXPECT_EQ(structures.at(0.5e-3 * Vec3(20, 30, 10)), 0);
}

// truth: volume/distance_to.h, which has its own tests
TEST_F(NamedBlock, TheDistanceIsThatOfTheStrip) {
  StructureMap map(*bone_, {false, false, true});
  NoProgress quiet;
  const TissueId nerve[] = {kNerve};
  auto truth = volume::DistanceTo::make(*bone_, nerve, {}, quiet);
  ASSERT_TRUE(truth);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(0, 20e-3);
  for (int n = 0; n < 300; ++n) {
    const Vec3 p(place(random), place(random), place(random));
    const auto far = map.distance(kNerve, p);
    ASSERT_TRUE(far);
    EXPECT_NEAR(*far, truth->at(p).distance, 0.45e-3) << p.transpose();
  }
  EXPECT_FALSE(map.distance(kBone, Vec3::Zero())) << "not asked for";
  EXPECT_LT((*map.place(kNerve) - 0.5e-3 * Vec3(20, 20, 24)).norm(), 1e-3);
}

TEST(Names, AreInTheLanguageOfTheUser) {
  speak("sv");
  EXPECT_EQ(anatomy("facial nerve"), "ansiktsnerv");
  speak("en");
  EXPECT_EQ(anatomy("facial nerve"), "facial nerve");
  EXPECT_EQ(anatomy("Nervus_XY"), "Nervus_XY");
}

// Each soft or spared tissue of the built-in bones has a translation: a name with a note in brackets
// would otherwise be shown as it is.
TEST(Names, OfTheBuiltInBonesAreAllKnown) {
  speak("sv");
  const std::set<std::string> same = {"air", "dura", "diploe", "chorda tympani"};
  for (const phantom::Phantom& bone :
       {phantom::temporal_bone(1e-3), phantom::jaw(1e-3, phantom::Variant({"long"})),
        phantom::tooth(1e-3, phantom::Variant({"graded"})), phantom::spine(1e-3),
        phantom::skull(1e-3)})
    for (const volume::Tissue& tissue : bone.tissues.tissues)
      EXPECT_EQ(anatomy(tissue.name) == tissue.name, same.contains(tissue.name)) << tissue.name;
  speak("en");
}

TEST(Plates, NeverOverlapAndStayAtTheSides) {
  const std::uint64_t seed = std::random_device()();
  std::mt19937_64 random(seed);
  const PlateArea area = {100, 900, 10, 600};
  constexpr float kHigh = 22;
  for (int round = 0; round < 200; ++round) {
    std::uniform_real_distribution<float> x(area.left, area.right), y(area.top, area.bottom);
    std::vector<ImVec2> points;
    std::vector<float> widths;
    for (int n = 0; n < 20; ++n) {
      points.emplace_back(x(random), y(random));
      widths.push_back(60 + 4 * static_cast<float>(n));
    }
    const std::vector<Plate> plates = plates_for(points, widths, kHigh, area);
    ASSERT_EQ(plates.size(), points.size());
    for (const Plate& a : plates) {
      EXPECT_GE(a.at.y, area.top) << "seed " << seed;
      EXPECT_LE(a.at.y + kHigh, area.bottom) << "seed " << seed;
      EXPECT_EQ(a.left, points[a.pin].x < 500) << "seed " << seed;
      EXPECT_FLOAT_EQ(a.left ? a.at.x : a.at.x + widths[a.pin], a.left ? area.left : area.right);
      for (const Plate& b : plates)
        EXPECT_TRUE(a.pin == b.pin || a.left != b.left || std::abs(a.at.y - b.at.y) >= kHigh)
            << "seed " << seed;
    }
  }
}

TEST(Pins, ATissueHasOne) {
  PinnedLabels pins;
  EXPECT_TRUE(pins.toggle(3, Vec3::Zero()));
  EXPECT_TRUE(pins.pinned(3));
  EXPECT_FALSE(pins.toggle(3, Vec3(1, 0, 0)));
  EXPECT_TRUE(pins.empty());
}

// Each face looks at the user after the turn, whatever the view was.
TEST(Cube, AFaceTurnsTheViewToItself) {
  const ViewTurn::Clock::time_point start;
  for (const CubeFace& face : cube_faces())
    for (const double azimuth : {-2.9, -0.4, 1.3, 3.1}) {
      render::Camera camera;
      camera.azimuth = azimuth;
      camera.elevation = 0.5;
      ViewTurn turn;
      turn.begin(camera, face, start);
      for (int ms = 0; ms <= 400; ms += 16)
        turn.step(camera, start + std::chrono::milliseconds(ms));
      const Vec3 out(face.out[0], face.out[1], face.out[2]);
      EXPECT_GT(camera.backward().dot(out), 0.995) << face.letter << " from " << azimuth;
    }
}

}  // namespace
}  // namespace burr::app
