// A burr that stands in more bricks than one tick may touch: they are cut in slices of time, none
// is left out, and the account balances.
#include <gtest/gtest.h>

#include <cmath>

#include "burr/edit/carve.h"
#include "burr/haptics/contact.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/rt/flags.h"
#include "burr/volume/volume_of.h"

namespace burr::edit {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;
constexpr int kMostBricks = 1024;

struct Crowd {
  Crowd()
      : bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-7 * kMm), Vec3::Constant(7 * kMm), 0.1 * kMm), {},
            phantom::slab({0, 0, 1}, {0, 0, 20 * kMm}))),
        surface(*bone, {}, 1, quiet),
        undo(*bone, 8192),
        writer(*bone, surface, undo, nullptr),
        carver(writer, {.advance_m = 0,
                        .advance_least = 0,
                        .margin_m = 0,
                        .margin_least = 0,
                        .margin_most = 0}) {
    undo.begin_stroke(0);
    cut.centre = bone->grid().grid_from_world({0.03 * kMm, -0.02 * kMm, 0.01 * kMm});
    cut.push = Vec3(0, 0, -1);
    cut.radius = 60;
  }
  // Material removed below and above the middle  [voxel]
  std::pair<double, double> gone_below_and_above() const {
    double below = 0, above = 0;
    const math::Ijk& n = bone->grid().size;
    for (int k = 0; k < n.z(); ++k)
      for (int j = 0; j < n.y(); ++j)
        for (int i = 0; i < n.x(); ++i)
          (k < n.z() / 2 ? below : above) += 1 - bone->field(i, j, k) / 65535.0;
    return {below, above};
  }
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  UndoStore undo;
  BoneWriter writer;
  Carver carver;
  Cut cut;
};

TEST(Crowd, BricksThatAreTooManyForATickAreCutInTurnsAndEvenly) {
  Crowd crowd;
  const double before = volume::volume_of(*crowd.bone);
  crowd.cut.energy = 1e9 * 4.0 / 3 * M_PI * 216e-9 / 100;  // a hundredth of the ball per tick
  int turned = 0;
  constexpr int kTicks = 60;
  for (int n = 0; n < kTicks; ++n) {
    std::uint32_t flags = 0;
    crowd.carver.carve(crowd.cut, flags);
    EXPECT_LE(crowd.carver.bricks_last(), kMostBricks);
    turned += (flags & rt::kFlagPutOff) != 0 ? 1 : 0;
    const Ledger ledger = crowd.carver.ledger();
    EXPECT_NEAR(ledger.asked, ledger.removed + ledger.debt + ledger.not_cut, 1e-6 * ledger.asked);
  }
  EXPECT_EQ(turned, kTicks - 1) << "the first tick cannot know";
  const Ledger ledger = crowd.carver.ledger();
  EXPECT_NEAR(before - volume::volume_of(*crowd.bone), ledger.removed, 1e-6 * ledger.removed);
  EXPECT_GT(ledger.removed, 0.9 * ledger.asked) << "what is put off is done, not dropped";
  const auto [below, above] = crowd.gone_below_and_above();
  EXPECT_NEAR(below, above, 0.15 * above);
}

TEST(Crowd, TurnsEndWhenTheBurrStandsInFewAgain) {
  Crowd crowd;
  crowd.cut.energy = 1;
  std::uint32_t flags = 0;
  for (int n = 0; n < 10; ++n) crowd.carver.carve(crowd.cut, flags);
  EXPECT_NE(flags & rt::kFlagPutOff, 0U);
  crowd.cut.radius = 10;
  crowd.cut.centre += Vec3(0, 0, 40);
  for (int n = 0; n < 10; ++n) crowd.carver.carve(crowd.cut, flags);
  flags = 0;
  crowd.carver.carve(crowd.cut, flags);
  EXPECT_EQ(flags & rt::kFlagPutOff, 0U);
}

}  // namespace
}  // namespace burr::edit
