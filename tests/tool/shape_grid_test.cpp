// A mesh as a lattice of distances, against the formula of the same body; and the lattice itself.
#include "burr/tool/shape_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "burr/rt/lanes.h"
#include "burr/tool/shape.h"
#include "burr/tool/shape_formulas.h"
#include "support/mesh.h"

namespace burr::tool {
namespace {

using math::Vec3;
using test::ball_mesh;
using test::box_mesh;
using test::grid_shape;
using test::turned;

using Lanes = rt::lanes::SixteenNumbers;

struct Pair {
  const char* name;
  Triangles mesh;
  Shape truth;
};
std::vector<Pair> pairs() {
  return {
      {"ball", ball_mesh(2), {ShapeKind::ball, 0, 0, 0, 2}},
      {"box", box_mesh({1, 2, 3}, Vec3::Zero()), {ShapeKind::box, 1, 2, 3, 0}},
      {"cone", turned({{0, -3}, {1, -3}, {2, 3}, {0, 3}}, 192), {ShapeKind::frustum, 1, 2, 3, 0}}};
}

// Between the nodes the linear field differs from the distance where that bends: at edges and on the
// skeleton inside, by less than half of a cell.
TEST(ShapeGrid, OfAMeshIsTheDistanceOfTheSameBody) {
  std::mt19937 random(17);
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const auto grid = grid_of(pair.mesh, 0);
    ASSERT_TRUE(grid.ok());
    const Shape shape = grid_shape(*grid);
    ASSERT_NE(shape.grid, nullptr);
    EXPECT_NEAR(grid->middle.norm(), 0, 1e-9);
    EXPECT_NEAR(grid->volume, volume_inside(pair.mesh), 0.01 * volume_inside(pair.mesh));
    std::uniform_real_distribution<double> place(-4, 4);
    double worst = 0, worst_turn = 0, sum = 0;
    int count = 0;
    for (int n = 0; n < 20'000; ++n) {
      const Vec3 p(place(random), place(random), place(random));
      const Distance found = distance(shape, p), truth = distance(pair.truth, p);
      EXPECT_NEAR(found.gradient.norm(), 1, 1e-9);
      if (truth.phi > 3 * grid->cell) {  // outside of the lattice: never beyond the truth
        EXPECT_LE(found.phi, truth.phi + 0.1 * grid->cell);
        EXPECT_GT(found.phi, 0.5 * truth.phi);
        continue;
      }
      if (truth.phi < -3 * grid->cell) continue;
      worst = std::max(worst, std::abs(found.phi - truth.phi));
      sum += std::abs(found.phi - truth.phi);
      ++count;
      if (truth.phi > grid->cell)
        worst_turn =
            std::max(worst_turn, std::acos(std::min(1.0, found.gradient.dot(truth.gradient))));
    }
    EXPECT_LT(worst, 0.4 * grid->cell);
    EXPECT_LT(sum / count, 0.03 * grid->cell);
    EXPECT_LT(worst_turn, 0.5);
  }
}

TEST(ShapeGrid, IsTheSameInLanesAsOneByOne) {
  const auto grid = grid_of(ball_mesh(1.5), 0.2);
  ASSERT_TRUE(grid.ok());
  const Shape shape = grid_shape(*grid);
  const Sizes<float> sizes = sizes_of<float>(shape);
  std::mt19937 random(18);
  std::uniform_real_distribution<float> place(-4, 4);
  for (int n = 0; n < 500; ++n) {
    rt::lanes::Floats x, y, z;
    for (int lane = 0; lane < rt::lanes::kCount; ++lane) {
      x[lane] = place(random);
      y[lane] = place(random);
      z[lane] = place(random);
    }
    Field<Lanes> all;
    field_of<Lanes>(shape.kind, sizes, x, y, z, all);
    for (int lane = 0; lane < rt::lanes::kCount; ++lane) {
      const Distance one = distance(shape, Vec3(x[lane], y[lane], z[lane]));
      EXPECT_NEAR(one.phi, all.phi[lane], 1e-5);
      EXPECT_NEAR(one.gradient.x(), all.x[lane], 1e-3);
      EXPECT_NEAR(one.gradient.y(), all.y[lane], 1e-3);
      EXPECT_NEAR(one.gradient.z(), all.z[lane], 1e-3);
    }
  }
}

TEST(ShapeGrid, ItsBoxHoldsTheBodyAndIsTight) {
  const auto grid = grid_of(box_mesh({1, 2, 3}, {5, 6, 7}), 0);
  ASSERT_TRUE(grid.ok());
  EXPECT_NEAR((grid->middle - Vec3(5, 6, 7)).norm(), 0, 1e-9);
  const math::Aabb box = bounds(grid_shape(*grid));
  const Vec3 half(1, 2, 3);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(box.hi[axis], half[axis] - 0.01 * grid->cell);  // 256ths of a cell
    EXPECT_LE(box.hi[axis], half[axis] + 0.01 * grid->cell);
    EXPECT_LE(box.lo[axis], -half[axis] + 0.01 * grid->cell);
    EXPECT_GE(box.lo[axis], -half[axis] - 0.01 * grid->cell);
  }
}

// A tip of ten degrees ends between the nodes: the box holds all places where the field is 0.
TEST(ShapeGrid, ItsBoxHoldsASharpTip) {
  const auto grid = grid_of(turned({{0, 0}, {1, 5.7}, {0, 6}}, 96), 0.17);
  ASSERT_TRUE(grid.ok());
  const Shape shape = grid_shape(*grid);
  const math::Aabb box = bounds(shape);
  std::mt19937 random(19);
  std::uniform_real_distribution<double> across(-1.2, 1.2), along(-3.5, 3.5);
  double lowest = 0;
  for (int n = 0; n < 200'000; ++n) {
    const Vec3 p(0.05 * across(random), 0.05 * across(random), along(random));
    if (distance(shape, p).phi > 0) continue;
    lowest = std::min(lowest, p.z());
    EXPECT_TRUE(((p - box.lo).array() >= -1e-9).all() && ((box.hi - p).array() >= -1e-9).all());
  }
  EXPECT_NEAR(lowest, box.lo.z(), 0.1);
}

// The middle of the lattice is on the axis about which the tool turns.
TEST(ShapeGrid, OfATurningToolIsEvenAboutItsAxis) {
  const auto grid = grid_of(box_mesh({1, 1, 2}, {0.5, 0, 3}), 0, true);
  ASSERT_TRUE(grid.ok());
  EXPECT_NEAR(grid->middle.x(), 0, 1e-12);
  EXPECT_NEAR(grid->middle.y(), 0, 1e-12);
  EXPECT_NEAR(grid->middle.z(), 3, 1e-12);
  EXPECT_NEAR(bounds(grid_shape(*grid)).hi.x(), 1.5, grid->cell);
}

TEST(ShapeGrid, EqualLatticesAreKeptOnceAndComeBackWhole) {
  const auto grid = grid_of(ball_mesh(1.5), 0.3);
  ASSERT_TRUE(grid.ok());
  const ShapeGrid* kept = keep_grid(grid->cells);
  EXPECT_EQ(kept, keep_grid(grid->cells));
  EXPECT_EQ(cells_of(*kept), grid->cells);
}

TEST(ShapeGrid, NumbersThatAreNoBodyAreRefused) {
  const auto grid = grid_of(ball_mesh(1.5), 0.3);
  ASSERT_TRUE(grid.ok());
  const auto refused = [&](auto&& change) {
    GridCells cells = grid->cells;
    change(cells);
    return keep_grid(cells) == nullptr;
  };
  EXPECT_FALSE(refused([](GridCells&) {}));
  EXPECT_TRUE(refused([](GridCells& cells) { cells.phi.pop_back(); }));
  EXPECT_TRUE(refused([](GridCells& cells) { cells.size = {0, 0, 0}; }));
  EXPECT_TRUE(refused([](GridCells& cells) { cells.size[0] = -cells.size[0]; }));
  EXPECT_TRUE(refused([](GridCells& cells) { cells.phi.front() = -5; })) << "the border is inside";
  EXPECT_TRUE(refused([](GridCells& cells) {
    for (std::int16_t& value : cells.phi) value = std::max<std::int16_t>(value, 1);
  })) << "nothing is inside";
  EXPECT_TRUE(refused([](GridCells& cells) {
    cells.phi[cells.phi.size() / 2] =
        static_cast<std::int16_t>(cells.phi[cells.phi.size() / 2] - 600);
  })) << "a step that no distance has";
}

// Every edge belongs to two faces that run along it in opposite directions.
TEST(ShapeGrid, ItsSurfaceIsClosedAndLooksOut) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const auto grid = grid_of(pair.mesh, 0);
    ASSERT_TRUE(grid.ok());
    const GridSurface surface = surface_of(*keep_grid(grid->cells));
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t n = 0; n < surface.triangles.size(); n += 3)
      for (std::size_t e = 0; e < 3; ++e)
        edges.insert({surface.triangles[n + e], surface.triangles[n + (e + 1) % 3]});
    for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({a, b}), edges.count({b, a}));
    EXPECT_GT(grid->volume, 0);
  }
}

TEST(ShapeGrid, AMeshThatIsNoBodyIsRefusedWithAReason) {
  const auto why = [](const Triangles& mesh, double cell) {
    const auto grid = grid_of(mesh, cell);
    return grid.ok() ? std::string() : grid.error().text;
  };
  Triangles open = ball_mesh(2);
  open.faces.pop_back();
  EXPECT_NE(why(open, 0).find("3 open edges"), std::string::npos);
  Triangles inside_out = ball_mesh(2);
  for (auto& face : inside_out.faces) std::swap(face[1], face[2]);
  EXPECT_EQ(why(inside_out, 0), "") << "it is turned";
  Triangles wrong = ball_mesh(2);
  wrong.points[5].x() = std::nan("");
  EXPECT_NE(why(wrong, 0).find("not a number"), std::string::npos);
  Triangles far = ball_mesh(2);
  far.faces[3][0] = 1'000'000;
  EXPECT_NE(why(far, 0).find("does not have"), std::string::npos);
  const auto and_box = [](const Vec3& half, const Vec3& middle, bool inwards) {
    Triangles two = box_mesh({1, 1, 1}, Vec3::Zero());
    const auto first = static_cast<std::uint32_t>(two.points.size());
    for (const Vec3& point : box_mesh(half, middle).points) two.points.push_back(point);
    for (auto face : box_mesh(half, middle).faces) {
      if (inwards) std::swap(face[1], face[2]);
      two.faces.push_back({first + face[0], first + face[1], first + face[2]});
    }
    return two;
  };
  EXPECT_NE(why(and_box({1, 1, 1}, {1, 0.2, 0.1}, false), 0).find("overlap"), std::string::npos);
  EXPECT_NE(why(and_box({0.5, 0.5, 0.5}, {3, 0, 0}, true), 0).find("inwards"), std::string::npos);
  EXPECT_EQ(why(and_box({0.5, 0.5, 0.5}, {3, 0, 0}, false), 0), "");
  EXPECT_EQ(why(and_box({0.5, 0.5, 0.5}, {0, 0, 0}, true), 0), "") << "a hollow";
  EXPECT_NE(why({}, 0).find("no triangles"), std::string::npos);
  EXPECT_NE(why(ball_mesh(2), 0.001).find("larger"), std::string::npos);
  EXPECT_NE(why(box_mesh({5, 5, 0.01}, Vec3::Zero()), 0.5).find("thinner"), std::string::npos);
}

}  // namespace
}  // namespace burr::tool
