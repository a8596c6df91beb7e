#include "burr/tool/tool.h"

#include <gtest/gtest.h>

#include <cmath>

namespace burr::tool {
namespace {

using math::Vec3;

double nearest(const Tool& tool, const Vec3& p, Role role) {
  double least = 1e9;
  for (int n = 0; n < tool.count; ++n) {
    const Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role == role)
      least = std::min(least, distance(part.shape, part.tool_from_part.inverse() * p).phi);
  }
  return least;
}

TEST(Tool, OfABurrOnlyTheHeadCutsAndTheShaftIsThickAsItIsDrawn) {
  for (const double r : {0.5e-3, 1.5e-3, 3.5e-3}) {
    Burr burr;
    burr.radius = r;
    const Tool tool = burr_with_shaft(burr);
    const double neck = std::min(burr.shaft_radius, 0.55 * r);
    EXPECT_NEAR(nearest(tool, {2 * r, 0, 0}, Role::cuts), r, 1e-12);
    EXPECT_NEAR(nearest(tool, {5e-3, 0, 2 * r}, Role::rubs), 5e-3 - neck, 0.2e-3);
    EXPECT_NEAR(nearest(tool, {0, 5e-3, 22e-3}, Role::rubs), 5e-3 - burr.shaft_radius, 1e-9);
    // the lower half of the head is clear of everything that rubs
    for (double angle = M_PI / 2; angle < M_PI; angle += 0.05)
      EXPECT_GT(nearest(tool, {r * std::sin(angle), 0, r * std::cos(angle)}, Role::rubs), 0.2 * r);
    EXPECT_NEAR(reach_of(tool), kShaftEnd + burr.shaft_radius, 1e-3);
  }
}

TEST(Tool, TakesNoMorePartsThanItHasRoomForAndNoneWithoutABody) {
  Tool tool;
  EXPECT_FALSE(add_part(tool, {{ShapeKind::ball, 0, 0, 0, -1}, {}, Role::cuts}));
  for (int n = 0; n < Tool::kMostParts; ++n)
    EXPECT_TRUE(add_part(tool, {{ShapeKind::ball, 0, 0, 0, 1e-3}, {}, Role::cuts}));
  EXPECT_FALSE(add_part(tool, {{ShapeKind::ball, 0, 0, 0, 1e-3}, {}, Role::cuts}));
  EXPECT_EQ(tool.count, Tool::kMostParts);
}

}  // namespace
}  // namespace burr::tool
