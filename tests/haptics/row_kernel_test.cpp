// Groups of points that cannot be near a part are passed over. The rows are those of a look at all of them.
#include "burr/haptics/six/row_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "burr/math/rotation.h"
#include "burr/math/turn.h"
#include "tools.h"

namespace burr::haptics {
namespace {

using math::Quat;
using math::Vec3;
using tool::ShapeKind;

constexpr double kHalf = 12;  // of the cube that holds the points  [voxel]

// The part's frame is the tool's.
PartThere placed(const tool::Shape& shape, const Quat& r, bool planes) {
  PartThere at;
  at.shape = shape;
  at.planes = planes;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 row = r * Vec3(Vec3::Unit(axis));
    for (int k = 0; k < 3; ++k) at.part_from_grid[3 * axis + k] = static_cast<float>(row[k]);
  }
  return at;
}

void forget(NearPoints& points) {
  for (float& clear : points.clear) clear = -std::numeric_limits<float>::infinity();
}

// Neighbours follow each other, as those of a brick do.
std::unique_ptr<NearPoints> random_points(std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(-kHalf, kHalf), beside(-0.8, 0.8), one(0, 1);
  auto points = std::make_unique<NearPoints>();
  while (points->count < 4000) {
    const Vec3 middle(anywhere(random), anywhere(random), anywhere(random));
    for (int n = 0; n < NearPoints::kGroup; ++n) {
      const int at = points->count++;
      const Vec3 normal = Vec3(beside(random), beside(random), beside(random)).normalized();
      points->x[at] = static_cast<float>(middle.x() + beside(random));
      points->y[at] = static_cast<float>(middle.y() + beside(random));
      points->z[at] = static_cast<float>(middle.z() + beside(random));
      points->mx[at] = static_cast<float>(normal.x());
      points->my[at] = static_cast<float>(normal.y());
      points->mz[at] = static_cast<float>(normal.z());
      points->rd[at] = static_cast<float>(0.5 * one(random));
    }
  }
  forget(*points);
  return points;
}

bool same(const Rows& a, const Rows& b) {
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(a.count);
  if (a.count != b.count || std::memcmp(a.gap, b.gap, bytes) != 0) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (std::memcmp(a.n[axis], b.n[axis], bytes) != 0 ||
        std::memcmp(a.m[axis], b.m[axis], bytes) != 0)
      return false;
  return true;
}

struct Passed {
  long groups = 0, over = 0, rows = 0;
};

// A part that wanders about: at each step its rows, with what is remembered of far points and without.
void wander(const tool::Shape& shape, bool planes, std::mt19937& random, Passed& passed) {
  const RowKernel kernel = row_kernel();
  const auto points = random_points(random), forgetful = random_points(random);
  *forgetful = *points;
  const auto rows = std::make_unique<Rows>(), all = std::make_unique<Rows>();
  std::normal_distribution<double> step(0, 0.06), turn(0, 0.002);
  const double lever = 2 * kHalf + 2;  // at least the distance of any point from c
  Vec3 c(0, 0, 0), move, by;
  Quat r(1, 0, 0, 0);
  for (int n = 0; n < 120; ++n) {
    if (n % 20 ==
        0) {  // straight on for a while, or the way would be much longer than the distance gone
      move = Vec3(step(random), step(random), step(random));
      by = Vec3(turn(random), turn(random), turn(random));
    }
    c += move;
    r = math::turned(r, by);
    points->way += static_cast<float>(move.norm() + lever * by.norm());
    const float from[3] = {static_cast<float>(c.x()), static_cast<float>(c.y()),
                           static_cast<float>(c.z())};
    const PartThere at = placed(shape, math::normalized(r.conjugate()), planes);
    RowBounds bounds = {0.2F, 0.004F, 0.1F, static_cast<float>(0.2 + 0.004 * lever + 0.01)};
    bounds.beyond = planes ? 0.4F : 0.0F;
    bounds.inverse_disc = 2;
    rows->count = all->count = 0;
    rows->full = all->full = false;
    for (int group = 0; group * NearPoints::kGroup < points->count; ++group) {
      ++passed.groups;
      passed.over +=
          points->clear[group] > bounds.most + bounds.beyond + 1.8F * points->way ? 1 : 0;
    }
    kernel.make(*points, from, at, bounds, *rows);
    forget(*forgetful);
    kernel.make(*forgetful, from, at, bounds, *all);
    ASSERT_FALSE(all->full);
    ASSERT_TRUE(same(*rows, *all)) << n << ": " << rows->count << " rows of " << all->count;
    passed.rows += all->count;
  }
}

TEST(RowKernel, PassesOverNoPointThatIsNear) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const tool::Shape shapes[] = {
      {ShapeKind::ball, 0, 0, 0, 5},       {ShapeKind::capsule, 0, 0, 6, 2},
      {ShapeKind::cylinder, 4, 0, 5, 0.5}, {ShapeKind::frustum, 4, 2, 5, 0.4},
      {ShapeKind::vesica, 2, 0, 7, 0.4},   {ShapeKind::box, 6, 3, 0.8, 0.3},
      {ShapeKind::wedge, 1, 4, 6, 0.3},    {ShapeKind::half_shell, 5, 1, 0, 0.4},
      {ShapeKind::tube, 5, 4, 4, 0.3},
  };
  for (const tool::Shape& shape : shapes)
    for (const bool planes : {false, true}) {
      if (planes && (!tool::convex(shape.kind) || shape.kind == ShapeKind::ball)) continue;
      SCOPED_TRACE("shape " + std::to_string(static_cast<int>(shape.kind)) +
                   (planes ? ", planes" : ""));
      Passed passed;
      wander(shape, planes, random, passed);
      EXPECT_GT(passed.rows, 500);
      EXPECT_GT(passed.over, passed.groups / 20);  // otherwise nothing is tested here
    }
}

}  // namespace
}  // namespace burr::haptics
