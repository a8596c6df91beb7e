// Chips of an edge: their volume, where they come down, and what takes them away.
#include "burr/render/chips.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burr/render/wound.h"
#include "render/formula_surfaces.h"

namespace burr::render {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kMm3 = 1e-9;

// A face at the height z, 20 mm wide, with a vertex each 0.25 mm.
surface::Patch face(double z) {
  surface::Patch patch;
  constexpr int kWide = 80;
  for (int j = 0; j <= kWide; ++j)
    for (int i = 0; i <= kWide; ++i)
      patch.vertices.push_back(
          {(Vec3(0.25 * i - 10, 0.25 * j - 10, 0) * kMm + Vec3(0, 0, z)).cast<float>(),
           math::Vec3f::UnitZ(), 1});
  for (std::uint32_t j = 0; j < kWide; ++j)
    for (std::uint32_t i = 0; i < kWide; ++i) {
      const std::uint32_t at = j * (kWide + 1) + i;
      for (const std::uint32_t v : {0U, 1U, kWide + 2U, 0U, kWide + 2U, kWide + 1U})
        patch.triangles.push_back(at + v);
    }
  return patch;
}

Chips::Edge edge_at(double t) {
  return {t, Vec3(0, 0, 1 * kMm), Vec3::UnitX(), Vec3(0, 4 * kMm, 0), Vec3::UnitZ()};
}
double volume(const Chips::Chip& chip) { return chip.size.x() * chip.size.y() * chip.size.z(); }

TEST(Chips, HaveTheVolumeThatWasRemoved) {
  Chips chips;
  for (int n = 0; n < 1000; ++n) chips.throw_from(edge_at(n * 1e-3), 0.005 * kMm3);
  double sum = 0, least = 1, most = 0;
  for (const Chips::Chip& chip : chips.all()) {
    sum += volume(chip);
    least = std::min(least, volume(chip));
    most = std::max(most, volume(chip));
  }
  EXPECT_LE(sum, 5 * kMm3 * (1 + 1e-9));
  EXPECT_GT(sum, 5 * kMm3 - 1.6 * Chips::kVolume);
  EXPECT_GT(most, 1.5 * least) << "no two are alike";
  for (int n = 0; n < 1000; ++n) chips.throw_from(edge_at(2), 0.1 * kMm3);
  EXPECT_EQ(chips.all().size(), Chips::kMost);
}

TEST(Chips, FlyAheadOfTheEdgeAndLieOnTheSurfaceUnderThem) {
  Scene scene;
  set_patch(scene, 0, face(-2 * kMm));
  Chips chips;
  chips.throw_from(edge_at(1), 3 * kMm3);
  ASSERT_GT(chips.all().size(), 8U);
  chips.lie(scene, 1 + 0.5 * Chips::kFlight);
  ASSERT_NE(scene.chips, nullptr);
  for (const Chips::Chip& chip : chips.all()) {
    EXPECT_FALSE(chip.lies);
    EXPECT_GT(chip.at.z(), 0) << "in the air";
  }
  chips.lie(scene, 1 + 2 * Chips::kFlight);
  const auto mesh = scene.chips;
  EXPECT_EQ(mesh->vertices.size(), 88 * chips.all().size());
  for (const Chips::Chip& chip : chips.all()) {
    EXPECT_TRUE(chip.lies);
    EXPECT_NEAR(chip.at.z(), -2 * kMm, 1e-6);
    EXPECT_GT(chip.at.x(), 1 * kMm);
    EXPECT_LT(chip.at.x(), 5 * kMm);
    EXPECT_LT(std::abs(chip.at.y()), 5.1 * kMm);
  }
  double low = 1;
  for (const surface::Vertex& vertex : mesh->vertices)
    low = std::min(low, static_cast<double>(vertex.p.z()));
  EXPECT_NEAR(low, -2 * kMm, 0.05 * kMm) << "they rest on it";
  chips.lie(scene, 5);
  EXPECT_EQ(scene.chips, mesh) << "what lies is not sent again";
  // the bone under them is cut away
  set_patch(scene, 0, face(-3 * kMm));
  chips.lie(scene, 6);
  for (const Chips::Chip& chip : chips.all()) EXPECT_NEAR(chip.at.z(), -3 * kMm, 1e-6);
  set_patch(scene, 0, face(-40 * kMm));
  chips.lie(scene, 7);
  EXPECT_TRUE(chips.all().empty()) << "fallen out of the wound";
  chips.lie(scene, 8);
  EXPECT_EQ(scene.chips, nullptr);
}

// An edge that is driven straight down has a chip on either side.
TEST(Chips, OfAnEdgeThatIsDrivenDownFlyToBothSides) {
  Chips chips;
  Chips::Edge edge = edge_at(0);
  edge.forward = -Vec3::UnitZ();
  chips.throw_from(edge, 5 * kMm3);
  int left = 0, right = 0;
  for (const Chips::Chip& chip : chips.all()) (chip.over.x() < 0 ? left : right) += 1;
  EXPECT_GT(left, 5);
  EXPECT_GT(right, 5);
}

TEST(Chips, GoWithSuctionCoolantAndUndo) {
  Scene scene;
  set_patch(scene, 0, face(0));
  Chips chips;
  const auto thrown = [&] {
    chips.forget();
    chips.throw_from(edge_at(1), 3 * kMm3);
    chips.throw_from(edge_at(2), 3 * kMm3);
    chips.lie(scene, 4);
    return chips.all().size();
  };
  const std::size_t all = thrown();
  chips.suck(Vec3(0, 0, 40 * kMm), 10 * kMm);
  EXPECT_EQ(chips.all().size(), all);
  const Vec3 mouth = chips.all()[3].at;
  chips.suck(mouth, 1 * kMm);
  EXPECT_LT(chips.all().size(), all);
  for (const Chips::Chip& chip : chips.all()) EXPECT_GE((chip.at - mouth).norm(), 1 * kMm);
  EXPECT_EQ(thrown(), all) << "the same again";
  chips.rinse(Vec3::Zero(), 20 * kMm, 0.9 * Chips::kRinse);
  EXPECT_EQ(chips.all().size(), all);
  chips.rinse(Vec3::Zero(), 20 * kMm, 0.2 * Chips::kRinse);
  EXPECT_TRUE(chips.all().empty());
  thrown();
  chips.back_to(1.5);
  ASSERT_FALSE(chips.all().empty());
  for (const Chips::Chip& chip : chips.all()) EXPECT_EQ(chip.t, 1);
}

// The wound hands them what a chisel removes, and takes them away where the stroke is undone.
TEST(Chips, LieInTheWoundOfAChiselAndGoWithItsStroke) {
  Scene scene;
  set_patch(scene, 0, face(0));
  Wound wound(0.25 * kMm);
  Wound::Tick tick;
  tick.tip = Vec3(0, 0, 1 * kMm);
  tick.radius = 1 * kMm;
  tick.dust = 0;
  tick.forward = Vec3::UnitX();
  tick.edge = Vec3(0, 3 * kMm, 0);
  const auto cut = [&](double until, double removed) {
    for (const double from = tick.t; tick.t < until; tick.t += 0.02) {
      tick.removed += removed * 0.02 / (until - from);
      wound.see(tick);
    }
    wound.stain(scene);
  };
  cut(1, 2 * kMm3);
  EXPECT_TRUE(wound.chips().all().empty()) << "a tool that makes dust";
  tick.chips = true;
  cut(2, 0);
  cut(3, 2 * kMm3);
  cut(4, 0);
  const std::size_t first = wound.chips().all().size();
  EXPECT_GT(first, 5U);
  ASSERT_NE(scene.chips, nullptr);
  cut(5, 2 * kMm3);
  EXPECT_GT(wound.chips().all().size(), first);
  tick.undone += 2 * kMm3;
  tick.t += 0.5;
  wound.see(tick);
  EXPECT_EQ(wound.chips().all().size(), first) << "the last stroke";
  wound.forget();
  wound.stain(scene);
  EXPECT_EQ(scene.chips, nullptr);
}

}  // namespace
}  // namespace burr::render
