// How far a part of a tool is from a body that is a lattice of distances, against the formulas of the same
// bodies.
#include "burr/haptics/six/lattice_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "burr/math/rotation.h"
#include "burr/math/turn.h"
#include "burr/tool/shape_grid.h"

namespace burr::haptics {
namespace {

using math::Quat;
using math::Vec3;
using tool::Shape;
using tool::ShapeKind;

// A body that is round or has the sides of a box, as a lattice of cells of 1.
Shape lattice_of(const Shape& body, int nodes) {
  tool::GridCells cells;
  cells.size = {nodes, nodes, nodes};
  const double middle = 0.5 * (nodes - 1);
  for (int z = 0; z < nodes; ++z)
    for (int y = 0; y < nodes; ++y)
      for (int x = 0; x < nodes; ++x)
        cells.phi.push_back(static_cast<std::int16_t>(std::lround(
            tool::kPerCell * tool::distance(body, Vec3(x - middle, y - middle, z - middle)).phi)));
  Shape shape;
  shape.kind = ShapeKind::grid;
  shape.a = 1;
  shape.grid = tool::keep_grid(cells);
  EXPECT_NE(shape.grid, nullptr);
  return shape;
}

const Shape kBall = {ShapeKind::ball, 0, 0, 0, 6}, kBox = {ShapeKind::box, 7, 6, 5, 0.5};

std::vector<PartGap> all_gaps(const PartPlace& a, const PartPlace& b, double within) {
  std::vector<PartGap> out(4096);
  const int count = lattice_gaps(a, b, within, out);
  EXPECT_LE(count, 4096);
  out.resize(static_cast<std::size_t>(std::max(0, count)));
  return out;
}

double least_of(const std::vector<PartGap>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const PartGap& gap : all) least = std::min(least, gap.gap);
  return least;
}

// A ball beside a ball, at any place and turn: the gap is that of the centres.
TEST(LatticeGap, OfTwoBallsIsThatOfTheirCentres) {
  const Shape lattice = lattice_of(kBall, 19);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 50; ++n) {
    const Vec3 way = Vec3(any(random), any(random), any(random)).normalized();
    const double apart = 1 + any(random);
    const Quat turn =
        math::turned(Quat::Identity(), 2 * Vec3(any(random), any(random), any(random)));
    const PartPlace body = {lattice, Vec3(3, 4, 5), turn},
                    ball = {Shape{ShapeKind::ball, 0, 0, 0, 4},
                            Vec3(3, 4, 5) + (6 + 4 + apart) * way, Quat::Identity()};
    // the points are a cell apart, so the nearest may lie this much beside the true one
    EXPECT_NEAR(lattice_gap(body, ball, 10), apart, 0.16);
    const std::vector<PartGap> gaps = all_gaps(ball, body, 4);
    ASSERT_FALSE(gaps.empty());
    EXPECT_DOUBLE_EQ(least_of(gaps), lattice_gap(body, ball, 10));
    for (const PartGap& gap : gaps) {
      EXPECT_LT(gap.gap, 4);
      EXPECT_NEAR(math::norm(gap.a - gap.b), std::abs(gap.gap), 1e-9);
      EXPECT_NEAR(math::dot(gap.normal, gap.a - gap.b), gap.gap, 1e-9) << "from b to a";
      EXPECT_NEAR(math::norm(gap.b - body.middle), 6, 0.05) << "on the body";
      EXPECT_NEAR(math::norm(gap.a - ball.middle), 4, 1e-9) << "on the ball";
    }
  }
}

// A flat face gives many points at the same gap: the other rests on it flat.
TEST(LatticeGap, AFaceHasManyPoints) {
  const Shape lattice = lattice_of(kBox, 21);
  const PartPlace body = {lattice, Vec3::Zero(), Quat::Identity()},
                  plate = {Shape{ShapeKind::box, 20, 20, 1, 0.1}, Vec3(0, 0, 5.5 + 1.1 + 0.3),
                           Quat::Identity()};
  const std::vector<PartGap> gaps = all_gaps(body, plate, 0.35);
  EXPECT_GT(gaps.size(), 100U);
  for (const PartGap& gap : gaps) {
    EXPECT_NEAR(gap.gap, 0.3, 0.01);
    EXPECT_NEAR(gap.normal.z(), -1, 1e-9);
  }
  // no more than `out` holds, but it says how many there were
  std::array<PartGap, 5> few;
  EXPECT_EQ(lattice_gaps(body, plate, 0.35, few), static_cast<int>(gaps.size()));
}

// Every point within the reach is found, whatever is passed over: against all points one by one.
TEST(LatticeGap, MissesNoPoint) {
  const Shape lattice = lattice_of(kBox, 21);
  const std::vector<Vec3>& points = tool::points_of(*lattice.grid).points;
  EXPECT_GT(points.size(), 500U);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const Shape& shape :
       {Shape{ShapeKind::capsule, 0, 0, 8, 1}, Shape{ShapeKind::cylinder, 5, 0, 0.5, 0.2},
        Shape{ShapeKind::wedge, 1, 3, 8, 0.2}, Shape{ShapeKind::half_shell, 3, 1, 0, 0.3}})
    for (int n = 0; n < 40; ++n) {
      const PartPlace body = {lattice, Vec3(any(random), any(random), any(random)),
                              math::turned(Quat::Identity(), Vec3(any(random), any(random), 1))},
                      part = {shape, 12 * Vec3(any(random), any(random), any(random)),
                              math::turned(Quat::Identity(), Vec3(any(random), 1, any(random)))};
      const double within = 2 + any(random);
      std::size_t near = 0;
      double least = 50;
      for (const Vec3& point : points) {
        const Vec3 p = body.middle + body.turn * point;
        const double phi = tool::distance(shape, part.turn.conjugate() * Vec3(p - part.middle)).phi;
        near += phi < within ? 1 : 0;
        least = std::min(least, phi);
      }
      EXPECT_EQ(all_gaps(part, body, within).size(), near);
      if (least > 0) {
        EXPECT_NEAR(lattice_gap(part, body, 50), least, 1e-9);
      }
    }
}

// A small tool within a large piece is beside none of its points, and yet not free.
TEST(LatticeGap, InsideIsNotFree) {
  const PartPlace body = {lattice_of(kBall, 19), Vec3::Zero(), Quat::Identity()},
                  ball = {Shape{ShapeKind::ball, 0, 0, 0, 1}, Vec3(0.5, 0, 0), Quat::Identity()};
  EXPECT_LT(lattice_gap(body, ball, 5), -3);
  EXPECT_LT(lattice_gap(ball, body, 5), -3);
}

// Two lattices: the points of each against the other.
TEST(LatticeGap, OfTwoLattices) {
  const Shape lattice = lattice_of(kBall, 19);
  for (const double apart : {0.4, 1.3}) {
    const PartPlace a = {lattice, Vec3::Zero(), Quat::Identity()},
                    b = {lattice, Vec3(12 + apart, 0, 0), Quat::Identity()};
    EXPECT_NEAR(lattice_gap(a, b, 10), apart, 0.02);
    const PartPlace alone = {kBall, b.middle, Quat::Identity()};
    EXPECT_GT(static_cast<double>(all_gaps(a, b, 3).size()),
              1.8 * static_cast<double>(all_gaps(a, alone, 3).size()))
        << "the points of both";
    bool of_a = false, of_b = false;
    for (const PartGap& gap : all_gaps(a, b, 3)) {
      EXPECT_LT(gap.normal.x(), 0);
      of_a = of_a || math::norm(gap.a) < 6.01;
      of_b = of_b || math::norm(gap.b - b.middle) < 6.01;
    }
    EXPECT_TRUE(of_a && of_b);
  }
}

// Neither comes first: the points of both are looked at, whichever is named first.
TEST(LatticeGap, OfTwoLatticesHasNoFirst) {
  const Shape ball = lattice_of(kBall, 19), box = lattice_of(kBox, 21);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  double of_points = 0;  // by which the points of the other would be too far away, at most
  for (int n = 0; n < 60; ++n) {
    const Vec3 way = Vec3(any(random), any(random), any(random)).normalized();
    const PartPlace a = {box, Vec3(any(random), any(random), any(random)),
                         math::turned(Quat::Identity(), Vec3(any(random), any(random), 1))},
                    b = {ball, a.middle + 15 * way,
                         math::turned(Quat::Identity(), Vec3(any(random), 1, any(random)))};
    const double least = lattice_gap(a, b, 50);
    EXPECT_EQ(least, lattice_gap(b, a, 50));
    EXPECT_EQ(all_gaps(a, b, 4).size(), all_gaps(b, a, 4).size());
    const PartPlace plain_box = {kBox, a.middle, a.turn}, plain_ball = {kBall, b.middle, b.turn};
    const double of_a = lattice_gap(a, plain_ball, 50), of_b = lattice_gap(plain_box, b, 50);
    EXPECT_LT(least, std::min(of_a, of_b) + 0.2) << "a lattice of cells of 1 is no formula";
    of_points = std::max(of_points, std::abs(of_a - of_b));
  }
  EXPECT_GT(of_points, 0.1) << "it makes a difference whose points are looked at";
}

}  // namespace
}  // namespace burr::haptics
