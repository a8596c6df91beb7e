// More contacts than the list holds: the burr is held, and never gets stuck.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "burr/haptics/proxy.h"
#include "burr/haptics/thin.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"

namespace burr::haptics {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

TEST(Crowd, ABurrInASocketOfItsOwnSizeStaysInItAndComesOutAgain) {
  // as if bone had returned around the burr: some 30 000 contacts at once; the list holds 16 384
  const double r = 3.5 * kMm, h = 0.05 * kMm;
  NoProgress quiet;
  const auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-4.5, -4.5, -4.5) * kMm, Vec3(4.5, 4.5, 0) * kMm, h), {},
      phantom::without(phantom::slab({0, 0, 1}, {0, 0, -1 * kMm}), phantom::ball(r)));
  const volume::IsoVertices surface(*bone, {.reserve_blocks = 1 << 10}, 1, quiet);
  Proxy proxy(surface, {.radius = r}, Vec3::Zero());
  proxy.place(Vec3::Zero());
  bool crowded = false;
  for (int n = 0; n < 50; ++n) {  // pressed into the bottom
    const Touch touch = proxy.step({0, 0, -1 * kMm});
    crowded |= touch.overflow;
    EXPECT_TRUE(touch.touching);
    EXPECT_NEAR(touch.proxy.norm(), 0, 0.5 * h) << n;
  }
  EXPECT_TRUE(crowded) << "the scene does not show what it is for";
  int ticks = 0;
  while ((proxy.position() - Vec3(0, 0, 2 * kMm)).norm() > 1e-9 && ++ticks < 500)
    (void)proxy.step({0, 0, 2 * kMm});
  EXPECT_LT(ticks, 500) << "glued at " << proxy.position().z() / kMm << " mm";
}

TEST(Crowd, ThinningKeepsTheNearestOfEachDirectionAndForgetsOnlyItsLikes) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<float> any;
  auto all = std::make_unique<Candidates>();
  for (int j = 0; j < 12'000; ++j) {
    const Vec3 n = Vec3(static_cast<double>(any(random)), static_cast<double>(any(random)),
                        static_cast<double>(any(random)))
                       .normalized();
    all->nx[j] = static_cast<float>(n.x());
    all->ny[j] = static_cast<float>(n.y());
    all->nz[j] = static_cast<float>(n.z());
    all->gap[j] = any(random);
  }
  all->count = 12'000;
  const auto before = std::make_unique<Candidates>(*all);
  thin(*all);
  EXPECT_LE(all->count, 6 * 16 * 16);
  EXPECT_GT(all->count, 6 * 16 * 16 / 2);
  for (int j = 0; j < before->count; ++j) {  // each is represented by one as near
    bool found = false;
    for (int k = 0; k < all->count && !found; ++k) {
      const float dot =
          before->nx[j] * all->nx[k] + before->ny[j] * all->ny[k] + before->nz[j] * all->nz[k];
      found = all->gap[k] <= before->gap[j] &&
              std::acos(std::min(1.0F, dot)) <= static_cast<float>(kThinAngle);
    }
    ASSERT_TRUE(found) << j;
  }
}

}  // namespace
}  // namespace burr::haptics
