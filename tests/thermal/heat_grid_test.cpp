#include "burr/thermal/heat_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "thermal/blocks.h"

namespace burr::thermal {
namespace {

using math::Ijk;
using math::Vec3;
using std::numbers::pi;
using test::block;
using test::cut_out;
using test::everything;
using test::imbalance;

const Material kBone = HeatSettings{}.bone;
const double kAlpha = kBone.diffusivity();

// ---- compared with textbook solutions

// Rise at r from a source of 1 W at the origin after `seconds`, in a cube -L/2 .. L/2 with cold
// walls: the time integral of the product of three slabs, each a sum of images.
double rise_in_cold_cube(const Vec3& r, double edge, double seconds) {
  const auto slab = [&](double x, double t) {
    double sum = 0;
    for (int n = -40; n <= 40; ++n) {
      const double d = x - n * edge;
      sum += (n % 2 == 0 ? 1 : -1) * std::exp(-d * d / (4 * kAlpha * t));
    }
    return sum / std::sqrt(4 * pi * kAlpha * t);
  };
  // over the logarithm of time, by Simpson's rule
  const double from = std::log(1e-3), to = std::log(seconds);
  constexpr int kParts = 4000;
  double integral = 0;
  for (int i = 0; i <= kParts; ++i) {
    const double t = std::exp(from + (to - from) * i / kParts);
    const double weight = i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2;
    integral += weight * t * slab(r.x(), t) * slab(r.y(), t) * slab(r.z(), t);
  }
  return integral * (to - from) / kParts / 3 / kBone.capacity();
}

struct PointSource {
  // The measured rise `cells` away, P / (4 pi k R) of the infinite solid, and the solution in the
  // cube.
  struct Seen {
    double rise = 0, infinite = 0, cube = 0;
  };
  // half: cells on each side of the heated one.
  PointSource(int half, double cell, double seconds)
      : bone(block(Ijk::Constant(2 * half + 3), cell)),
        // one voxel of bone beyond the box on each side: the layer of cells that stay cold
        heat(*bone, everything(*bone).inflated(-cell), {.cell = cell, .longest_step = 1}),
        edge((2 * half + 2) * cell),
        middle(Ijk::Constant(half)),
        h(cell),
        after(seconds) {
    constexpr double kWatt = 0.1;
    const double kEach = heat.longest_stable_step();
    power = kWatt;
    for (int n = 0; n < static_cast<int>(std::lround(seconds / kEach)); ++n) {
      EXPECT_EQ(heat.deposit(heat.centre(middle), 0, kWatt * kEach), kWatt * kEach);
      heat.advance(kEach);
    }
  }
  [[nodiscard]] Seen at(const Ijk& cells) const {
    const Vec3 r = cells.cast<double>() * h;
    return {heat.temperature_c(middle + cells) - 37,
            power / (4 * pi * kBone.conductivity * r.norm()),
            power * rise_in_cold_cube(r, edge, after)};
  }
  std::unique_ptr<volume::Bone> bone;
  HeatGrid heat;
  double edge;
  Ijk middle;
  double h, after, power = 0;
};

TEST(HeatGrid, AroundASteadyPointSourceFallsOffAsOneOverTheDistance) {
  const PointSource source(15, 1e-3, 900);
  ASSERT_EQ(source.heat.box().count, Ijk::Constant(31));
  for (const Ijk& direction : {Ijk(1, 0, 0), Ijk(0, 0, -1), Ijk(0, -1, 1), Ijk(1, 1, -1)})
    for (const int n : {2, 3, 4, 6, 8, 10, 12}) {
      const Ijk cells = n * direction;
      const auto seen = source.at(cells);
      // discretisation error: along the axes a quarter of the square of the cells, and more terms
      EXPECT_NEAR(seen.rise, seen.cube, seen.infinite * (0.003 + 0.35 / cells.squaredNorm()))
          << cells.transpose();
      if (direction.x() == 1)
        std::printf("R %4.1f mm: rise %.4f K, cube %.4f (%+.2f %%), infinite solid %.4f\n",
                    cells.cast<double>().norm(), seen.rise, seen.cube,
                    100 * (seen.rise / seen.cube - 1), seen.infinite);
    }
  // near the source the cold walls lower all cells almost equally, so differences are those of the
  // infinite solid
  const auto near = source.at({4, 0, 0}), far = source.at({8, 0, 0});
  EXPECT_NEAR(near.rise - far.rise, near.infinite - far.infinite,
              0.05 * (near.infinite - far.infinite));
  EXPECT_LT(imbalance(source.heat.ledger()), 1e-9);
}

TEST(HeatGrid, ComesNearerToThePointSourceWhenCellsAreHalved) {
  // the same places, 2 and 4 mm away, after 60 s
  const PointSource coarse(10, 1e-3, 60), fine(21, 0.5e-3, 60);
  for (const int mm : {2, 4}) {
    const auto a = coarse.at({mm, 0, 0}), b = fine.at({2 * mm, 0, 0});
    const double was = std::abs(a.rise / a.cube - 1), is = std::abs(b.rise / b.cube - 1);
    std::printf("%d mm away: off by %.3f %% with 1 mm, %.3f %% with 0.5 mm\n", mm, 100 * was,
                100 * is);
    EXPECT_LT(is, 0.4 * was) << mm;  // with second order it would be 0.25
  }
}

double half_space_rise(double flux, double depth, double t) {
  const double root = std::sqrt(kAlpha * t);
  return 2 * flux / kBone.conductivity *
         (root / std::sqrt(pi) * std::exp(-depth * depth / (4 * kAlpha * t)) -
          depth / 2 * std::erfc(depth / (2 * root)));
}

// Relative error of the surface after 20 s; also checks the profile.
double heated_half_space(double cell, double allowed) {
  constexpr double kFlux = 2000;  // [W/m^2]
  const int deep = static_cast<int>(std::lround(30e-3 / cell));
  const auto bone = block({2, 2, deep}, cell);
  HeatGrid heat(*bone, everything(*bone), {.cell = cell, .longest_step = 0.02});
  constexpr double kEach = 0.02;
  for (int n = 0; n < 1000; ++n) {
    for (int i = 0; i < 4; ++i)
      heat.deposit(heat.centre({i % 2, i / 2, 0}), 0, kFlux * cell * cell * kEach);
    heat.advance(kEach);
  }
  const double surface = 2 * kFlux * std::sqrt(20 / (pi * kBone.conductivity * kBone.capacity()));
  EXPECT_NEAR(surface, half_space_rise(kFlux, 0, 20), 1e-9 * surface);
  for (int k = 0; k < deep; ++k) {
    const double depth = (k + 0.5) * cell;
    EXPECT_NEAR(heat.temperature_c({0, 1, k}) - 37, half_space_rise(kFlux, depth, 20),
                allowed * surface)
        << depth;
  }
  // between the middle of the first cell and the surface the flux gives the temperature
  const double seen = heat.temperature_c({1, 1, 0}) - 37 + kFlux * cell / 2 / kBone.conductivity;
  std::printf("%.2f mm: surface %.4f K, book %.4f\n", 1e3 * cell, seen, surface);
  return std::abs(seen / surface - 1);
}

TEST(HeatGrid, AHalfSpaceUnderConstantFluxWarmsWithTheRootOfTime) {
  const double coarse = heated_half_space(1e-3, 0.03), fine = heated_half_space(0.5e-3, 0.01);
  EXPECT_LT(coarse, 0.03);
  EXPECT_LT(fine, 0.01);
  EXPECT_LT(fine, 0.5 * coarse);
}

// ---- the coolant

// A rod in a mould that does not conduct, heated at one end, with the coolant at the other. Mean of
// the four rows of cells; the mould is tissue 2.
struct Rod {
  explicit Rod(double cell)
      : deep(static_cast<int>(std::lround(10e-3 / cell))),
        h(cell),
        bone(block(
            {4, 4, deep}, cell,
            [](int i, int j, int) { return i > 0 && i < 3 && j > 0 && j < 3 ? 1 : 2; },
            test::two_bones())),
        heat(*bone, everything(*bone),
             {.special = {{2, {.conductivity = 0}}}, .wet_radius = 3e-3, .cell = cell}) {}

  void burn(double watt, double seconds) {
    constexpr double kEach = 0.05;
    for (int n = 0; n < static_cast<int>(std::lround(seconds / kEach)); ++n) {
      for (int i = 0; i < 4; ++i)
        into += heat.deposit(heat.centre({1 + i % 2, 1 + i / 2, deep - 1}), 0, watt / 4 * kEach);
      heat.advance(kEach);
    }
  }
  [[nodiscard]] Vec3 wet_end() const { return {2 * h, 2 * h, 0}; }

  int deep;
  double h;
  std::unique_ptr<volume::Bone> bone;
  HeatGrid heat;
  double into = 0;
};

TEST(HeatGrid, AWetRodComesToTheSteadyStateOfTheBook) {
  Rod rod(0.5e-3);
  const HeatSettings settings;
  const double watt = 5e-3, area = std::pow(2 * rod.h, 2);
  rod.heat.irrigate(rod.wet_end());
  // with a radius of 1 cell the mould beside the rod is heated too, and keeps that heat
  rod.burn(watt, 3000);
  for (int k = 0; k < rod.deep - 1; ++k) {
    const double depth = (k + 0.5) * rod.h;
    const double book = settings.coolant_c + watt / area / settings.coolant_film +
                        watt / area * depth / kBone.conductivity;
    EXPECT_NEAR(rod.heat.temperature_c({1, 1, k}), book, 1e-3 * (book - settings.coolant_c)) << k;
    EXPECT_NEAR(rod.heat.temperature_c({2, 1, k}), rod.heat.temperature_c({1, 2, k}), 1e-9);
  }
  EXPECT_LT(imbalance(rod.heat.ledger()), 1e-9);
}

TEST(HeatGrid, TheCoolantLowersThePeak) {
  Rod dry(0.5e-3), wet(0.5e-3), dried(0.5e-3);
  wet.heat.irrigate(wet.wet_end());
  dried.heat.irrigate(dried.wet_end());
  dried.heat.dry();
  for (Rod* rod : {&dry, &wet, &dried}) rod->burn(5e-3, 300);
  HeatSummary was, is;
  dry.heat.summarise(was);
  wet.heat.summarise(is);
  EXPECT_LT(is.tissue[1].ever_c, was.tissue[1].ever_c - 5);
  EXPECT_EQ(was.ledger.convected, 0);
  EXPECT_GT(is.ledger.convected, 0);
  EXPECT_NEAR(dry.into, wet.into, 1e-12);
  EXPECT_EQ(dried.heat.ledger().convected, 0);
}

TEST(HeatGrid, OnlyWhatIsWithinReachOfTheCoolantIsCooled) {
  const auto bone = block({20, 4, 4}, 1e-3);
  HeatGrid heat(*bone, everything(*bone), {.wet_radius = 3e-3});
  heat.irrigate(heat.centre({0, 2, 2}));
  heat.advance(0.05);
  EXPECT_LT(heat.temperature_c({0, 0, 0}), 37);
  EXPECT_EQ(heat.temperature_c({8, 0, 0}), 37);
  EXPECT_LT(heat.temperature_c({2, 0, 2}), 37);
  EXPECT_EQ(heat.temperature_c({3, 0, 0}), 37) << "in the corner of the cube around the ball";
  EXPECT_EQ(heat.temperature_c({0, 2, 2}), heat.temperature_c({0, 1, 2}));
}

// The open area of a plane is its true area for any orientation.
TEST(HeatGrid, ASlantedPlaneIsAsLargeAsItIs) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 1, 1), Vec3(1, 2, 3)}) {
    const Vec3 n = normal.normalized();
    for (const int voxels : {1, 2}) {
      volume::Grid grid;
      grid.size = Ijk::Constant(64);
      grid.voxel = 1e-3 / voxels;
      std::vector<volume::Field> field;
      for (int k = 0; k < 64; ++k)
        for (int j = 0; j < 64; ++j)
          for (int i = 0; i < 64; ++i)
            field.push_back(volume::field_from_depth(-n.dot(Vec3(i - 31.7, j - 31.8, k - 31.6))));
      const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);
      // a box in the middle of the plane: its open area is that part of the plane
      const double half = 8e-3;
      const Vec3 middle = grid.world_from_grid(Vec3::Constant(31.5));
      const HeatGrid heat(*bone, {middle - Vec3::Constant(half), middle + Vec3::Constant(half)},
                          {.cell = 1e-3});
      ASSERT_EQ(heat.box().count, Ijk::Constant(16));
      // area of the plane within the cube, by counting points
      const double h = 2e-4;
      double inside = 0;
      const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
      for (double a = -0.03; a < 0.03; a += h)
        for (double b = -0.03; b < 0.03; b += h)
          if (((a * u + b * v).array().abs() < half).all()) inside += h * h;
      EXPECT_NEAR(heat.wet_area(), inside, 0.06 * inside) << normal.transpose() << " " << voxels;
    }
  }
}

// ---- invariants

// Lumps with cavities, of two materials, in a box smaller than the bone.
std::unique_ptr<volume::Bone> lumps(std::mt19937& random) {
  volume::Grid grid;
  grid.size = {40, 33, 27};
  grid.voxel = 0.5e-3;
  grid.frame.p = {-0.031, 0.12, 0.047};
  grid.frame.q = math::Quat(Eigen::AngleAxisd(0.6, Vec3(1, 2, -0.5).normalized()));
  std::vector<volume::Field> field;
  std::vector<volume::TissueId> tissue;
  const double phase = std::uniform_real_distribution<>(0, 6)(random);
  for (int k = 0; k < 27; ++k)
    for (int j = 0; j < 33; ++j)
      for (int i = 0; i < 40; ++i) {
        const double depth =
            4 * (std::sin(i / 3.0 + phase) + std::sin(j / 4.0) + std::sin(k / 5.0)) + 2;
        field.push_back(volume::field_from_depth(depth));
        tissue.push_back(static_cast<volume::TissueId>(field.back() == 0 ? 0 : 1 + (i / 10) % 2));
      }
  return volume::bone_from_arrays(grid, test::two_bones(), field, tissue, {}, 64);
}

Vec3 somewhere(const volume::Bone& bone, std::mt19937& random) {
  std::uniform_real_distribution<> in(0, 1);
  const Vec3 size = bone.grid().size.cast<double>();
  return bone.grid().world_from_grid(
      {size.x() * in(random), size.y() * in(random), size.z() * in(random)});
}

math::Aabb middle_of(const volume::Bone& bone) {
  const Vec3 p = bone.grid().world_from_grid(bone.grid().bounds_grid().centre());
  return {p - Vec3::Constant(6e-3), p + Vec3::Constant(6e-3)};
}

// Endless milling: heat, coolant, cuts and added material, in random order.
void wander(HeatGrid& heat, volume::Bone& bone, std::mt19937& random, int rounds) {
  for (int n = 0; n < rounds; ++n) {
    heat.deposit(somewhere(bone, random), 2e-3, 0.05);
    if (n % 7 == 0) heat.irrigate(somewhere(bone, random));
    if (n % 11 == 0) heat.dry();
    if (n % 5 == 0) {
      const Ijk at(static_cast<int>(random() % 40), static_cast<int>(random() % 33),
                   static_cast<int>(random() % 27));
      cut_out(bone, at, at + Ijk::Constant(3));
    }
    if (n % 17 == 0) {
      const auto brick =
          static_cast<volume::BrickIndex>(random() % static_cast<unsigned>(bone.brick_count()));
      volume::BrickField full;
      std::fill_n(full.voxel, volume::kBrickVoxels, volume::Field{50000});
      if (bone.ensure_slot(brick) != volume::kNoSlot) bone.write_brick(brick, full);
    }
    EXPECT_TRUE(heat.read_changes());
    heat.advance(0.11);
  }
}

TEST(HeatGrid, NoHeatIsMadeOrLostWhateverHappens) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto bone = lumps(random);
    HeatGrid heat(*bone, middle_of(*bone),
                  {.special = {{2, {.conductivity = 2, .density = 1000, .specific_heat = 600}}}});
    wander(heat, *bone, random, 200);
    const HeatLedger ledger = heat.ledger();
    EXPECT_GT(ledger.into, 1);
    EXPECT_GT(ledger.missed, 0);
    EXPECT_NEAR(ledger.into + ledger.missed, 200 * 0.05, 1e-9);
    for (const double part : {ledger.stored, ledger.convected, ledger.conducted, ledger.removed})
      EXPECT_GT(std::abs(part), 1e-3);
    EXPECT_LT(imbalance(ledger), 1e-9);
  }
}

TEST(HeatGrid, NothingGetsWarmerThanTheWarmestNorColderThanTheCoolant) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto bone = lumps(random);
    HeatGrid heat(*bone, middle_of(*bone), {.coolant_film = 1e9, .longest_step = 100});
    for (int n = 0; n < 50; ++n) heat.deposit(somewhere(*bone, random), 1e-3, 0.2);
    heat.irrigate(heat.centre(heat.box().count / 2));
    HeatSummary summary;
    heat.summarise(summary);
    double highest = summary.hottest_c;
    EXPECT_GT(highest, 40);
    for (int n = 0; n < 40; ++n) {
      heat.advance(heat.longest_stable_step());
      heat.summarise(summary);
      EXPECT_LE(summary.hottest_c, highest + 1e-9);
      highest = summary.hottest_c;
      for (int i = 0; i < heat.box().count.x(); ++i)
        for (int j = 0; j < heat.box().count.y(); ++j)
          for (int k = 0; k < heat.box().count.z(); ++k)
            ASSERT_GE(heat.temperature_c({i, j, k}), 22 - 1e-9);
    }
    EXPECT_LT(heat.longest_stable_step(), std::pow(heat.box().edge, 2) / (6 * kAlpha));
    EXPECT_GT(heat.longest_stable_step(), 0.85 * std::pow(heat.box().edge, 2) / (12 * kAlpha));
  }
}

TEST(HeatGrid, TheSameCallsGiveTheSameBits) {
  const auto run = [] {
    std::mt19937 random(3);
    const auto bone = lumps(random);
    HeatGrid heat(*bone, middle_of(*bone), {});
    wander(heat, *bone, random, 60);
    std::vector<double> all;
    for (int i = 0; i < heat.box().count.x(); ++i)
      for (int j = 0; j < heat.box().count.y(); ++j)
        for (int k = 0; k < heat.box().count.z(); ++k)
          all.insert(all.end(), {heat.temperature_c({i, j, k}), heat.cem43_min({i, j, k})});
    return all;
  };
  const auto first = run(), second = run();
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

// Read in pieces while being cut, the cells equal those read as a whole at the end.
TEST(HeatGrid, WhatIsCutMeanwhileIsAsIfItHadNeverBeenThere) {
  std::mt19937 random(5);
  const auto bone = lumps(random);
  HeatGrid heat(*bone, middle_of(*bone), {});
  for (int n = 0; n < 30; ++n) {
    const Ijk at(static_cast<int>(random() % 40), static_cast<int>(random() % 33),
                 static_cast<int>(random() % 27));
    cut_out(*bone, at, at + Ijk::Constant(5));
    EXPECT_TRUE(heat.read_changes());
  }
  HeatGrid fresh(*bone, middle_of(*bone), {});
  EXPECT_EQ(heat.wet_area(), fresh.wet_area());
  for (HeatGrid* each : {&heat, &fresh}) {
    each->irrigate(each->centre(each->box().count / 2));
    for (int n = 0; n < 20; ++n) {
      std::mt19937 same(static_cast<unsigned>(n));
      each->deposit(somewhere(*bone, same), 2e-3, 0.05);
      for (int i = 0; i < 5; ++i) each->advance(0.02);
    }
  }
  for (int i = 0; i < heat.box().count.x(); ++i)
    for (int j = 0; j < heat.box().count.y(); ++j)
      for (int k = 0; k < heat.box().count.z(); ++k) {
        ASSERT_EQ(heat.has_matter({i, j, k}), fresh.has_matter({i, j, k}));
        ASSERT_NEAR(heat.temperature_c({i, j, k}), fresh.temperature_c({i, j, k}), 1e-9);
      }
}

// ---- removed and added bone

TEST(HeatGrid, BoneThatIsCutTakesItsHeatAlong) {
  const auto bone = block({16, 8, 8}, 0.5e-3);
  HeatGrid heat(*bone, everything(*bone), {});
  ASSERT_EQ(heat.box().voxels, 2);
  heat.deposit(heat.centre({1, 1, 1}), 0, 0.1);
  heat.deposit(heat.centre({6, 1, 1}), 0, 0.3);
  const double other = heat.temperature_c({6, 1, 1});
  cut_out(*bone, {0, 0, 0}, {8, 8, 8});
  EXPECT_TRUE(heat.read_changes());
  EXPECT_FALSE(heat.has_matter({1, 1, 1}));
  EXPECT_EQ(heat.temperature_c({1, 1, 1}), 37);
  EXPECT_EQ(heat.temperature_c({6, 1, 1}), other);
  EXPECT_NEAR(heat.ledger().removed, 0.1, 1e-12);
  EXPECT_NEAR(heat.ledger().stored, 0.3, 1e-12);
  EXPECT_EQ(heat.deposit(heat.centre({1, 1, 1}), 0, 0.5), 0);
  EXPECT_EQ(heat.ledger().missed, 0.5);
}

TEST(HeatGrid, HalfACellTakesHalfItsHeatAndIsNoWarmer) {
  const auto bone = block({8, 8, 8}, 0.5e-3);
  HeatGrid heat(*bone, everything(*bone), {});
  heat.deposit(heat.centre({1, 1, 1}), 0, 0.1);
  const double t = heat.temperature_c({1, 1, 1});
  cut_out(*bone, {2, 2, 2}, {3, 4, 4});
  EXPECT_TRUE(heat.read_changes());
  EXPECT_NEAR(heat.temperature_c({1, 1, 1}), t, 1e-12);
  EXPECT_NEAR(heat.ledger().removed, 0.05, 1e-12);
}

TEST(HeatGrid, ASplinterIsHeatedAsMuchAsAWholeCell) {
  const auto bone = block({8, 8, 8}, 0.5e-3);
  cut_out(*bone, {0, 0, 0}, {2, 2, 1});
  cut_out(*bone, {0, 0, 1}, {1, 2, 2});  // a quarter of cell (0,0,0) remains
  HeatGrid heat(*bone, everything(*bone), {});
  const Vec3 between = 0.5 * (heat.centre({0, 0, 0}) + heat.centre({1, 1, 1}));
  EXPECT_EQ(heat.deposit(between, 1e-3, 0.05), 0.05);
  EXPECT_GT(heat.temperature_c({0, 0, 0}), 38);
  EXPECT_NEAR(heat.temperature_c({0, 0, 0}), heat.temperature_c({1, 1, 1}), 1e-9);
  EXPECT_NEAR(heat.ledger().stored, 0.05, 1e-12);
}

TEST(HeatGrid, WhatIsPutBackIsAsWarmAsAtTheStart) {
  const auto bone = block({8, 8, 8}, 1e-3);
  volume::BrickField before;
  ASSERT_TRUE(bone->copy_brick(0, before));
  HeatGrid heat(*bone, everything(*bone), {});
  heat.deposit(heat.centre({1, 1, 1}), 0, 0.1);
  cut_out(*bone, {0, 0, 0}, {4, 8, 8});
  EXPECT_TRUE(heat.read_changes());
  bone->write_brick(0, before);
  EXPECT_TRUE(heat.read_changes());
  EXPECT_TRUE(heat.has_matter({1, 1, 1}));
  EXPECT_EQ(heat.temperature_c({1, 1, 1}), 37);
  EXPECT_EQ(heat.cem43_min({1, 1, 1}), 0);
  EXPECT_LT(imbalance(heat.ledger()), 1e-12);
}

TEST(HeatGrid, HeatDoesNotCrossAir) {
  const auto bone = block({16, 4, 4}, 1e-3, [](int i, int, int) { return i == 7 ? 0 : 1; });
  HeatGrid heat(*bone, everything(*bone), {});
  heat.deposit(heat.centre({4, 2, 2}), 0, 0.5);
  heat.advance(600);
  EXPECT_GT(heat.temperature_c({6, 2, 2}), 37.1);
  EXPECT_EQ(heat.temperature_c({8, 2, 2}), 37);
  EXPECT_NEAR(heat.ledger().stored, 0.5, 1e-12);
}

// Two halves in steady state: the flux is that of two resistances in series.
TEST(HeatGrid, TwoMaterialsConductOneAfterTheOther) {
  const auto bone = block(
      {26, 3, 3}, 1e-3, [](int i, int, int) { return i < 13 ? 1 : 2; }, test::two_bones());
  const Material other = {.conductivity = 2, .density = 3000, .specific_heat = 1500};
  // on the right the box ends one voxel before the bone: cold there
  const math::Aabb work = {Vec3::Zero(), {25e-3, 3e-3, 3e-3}};
  HeatGrid heat(*bone, work, {.special = {{2, other}}, .longest_step = 1});
  const double watt = 0.01, area = 9e-6;
  for (int n = 0; n < 25000; ++n) {
    for (int c = 0; c < 9; ++c) heat.deposit(heat.centre({0, c % 3, c / 3}), 0, watt / 9 * 0.3);
    heat.advance(0.3);
  }
  const auto rise = [&](int i) { return heat.temperature_c({i, 1, 1}) - 37; };
  const double in_first = watt / area * 1e-3 / kBone.conductivity;  // per cell
  const double in_second = watt / area * 1e-3 / other.conductivity;
  EXPECT_NEAR(rise(3) - rise(4), in_first, 1e-3 * in_first);
  EXPECT_NEAR(rise(20) - rise(21), in_second, 1e-3 * in_second);
  EXPECT_NEAR(rise(12) - rise(13), (in_first + in_second) / 2, 1e-3 * in_first);
  EXPECT_NEAR(rise(24), in_second, 1e-3 * in_second);
}

// ---- the summary

TEST(HeatGrid, TellsEachTissueApart) {
  auto tissues = test::two_bones();
  tissues.tissues.push_back({.name = "nerve", .kind = volume::TissueKind::soft});
  // a nerve one voxel thick along the middle of two bones, cells of two voxels
  const auto bone = block(
      {16, 8, 8}, 0.5e-3, [](int i, int j, int k) { return j == 4 && k == 4 ? 3
                                                           : i < 8          ? 1
                                                                            : 2; },
      tissues);
  HeatSettings settings;
  HeatGrid heat(*bone, everything(*bone), settings);
  ASSERT_EQ(heat.box().voxels, 2);
  const double shared = 1e-9 * (0.75 * settings.bone.capacity() + 0.25 * settings.soft.capacity());
  heat.deposit(heat.centre({1, 2, 2}), 0, 20 * shared);  // 57, with the nerve
  heat.deposit(heat.centre({6, 0, 0}), 0, 5 * 1e-9 * settings.bone.capacity());  // 42, without
  HeatSummary summary;
  heat.summarise(summary);
  EXPECT_NEAR(summary.tissue[1].now_c, 57, 1e-3);
  EXPECT_NEAR(summary.tissue[3].now_c, 57, 1e-3);
  EXPECT_NEAR(summary.tissue[2].now_c, 42, 1e-3);
  EXPECT_NEAR(summary.tissue[1].warm_m3, 0.75e-9, 1e-15);
  EXPECT_NEAR(summary.tissue[3].warm_m3, 0.25e-9, 1e-15);
  EXPECT_EQ(summary.tissue[2].warm_m3, 0);
  EXPECT_FALSE(summary.tissue[0].there);
  EXPECT_FALSE(summary.tissue[4].there);
  EXPECT_NEAR(summary.hottest_c, 57, 1e-3);
  EXPECT_LT((summary.hottest - heat.centre({1, 2, 2})).norm(), 1e-12);

  heat.advance(120);
  heat.summarise(summary);
  EXPECT_LT(summary.tissue[3].now_c, 45);
  EXPECT_NEAR(summary.tissue[3].ever_c, 57, 1e-3);
  EXPECT_GT(summary.tissue[3].cem43_min, 1);

  // removed bone counts in the history, not in the present
  const TissueHeat before = summary.tissue[1];
  cut_out(*bone, {0, 0, 0}, {8, 8, 8});
  EXPECT_TRUE(heat.read_changes());
  heat.summarise(summary);
  EXPECT_EQ(summary.tissue[1].ever_c, before.ever_c);
  EXPECT_EQ(summary.tissue[1].cem43_min, before.cem43_min);
  EXPECT_EQ(summary.tissue[1].now_c, 37);
  EXPECT_GT(summary.tissue[3].now_c, 37) << "the nerve stays";

  heat.start_over();
  heat.summarise(summary);
  EXPECT_EQ(summary.hottest_c, 37);
  EXPECT_FALSE(summary.tissue[1].there);
  EXPECT_EQ(summary.tissue[3].ever_c, 37);
  EXPECT_EQ(summary.tissue[3].cem43_min, 0);
}

TEST(HeatGrid, ChoosesCellsOfWholeVoxels) {
  for (const double voxel : {0.1e-3, 0.15e-3, 0.25e-3, 0.3e-3, 0.4e-3, 0.5e-3, 0.7e-3, 1e-3}) {
    volume::Grid grid;
    grid.size = {100, 90, 80};
    grid.voxel = voxel;
    const CellBox box = cells_around(grid, {Vec3::Zero(), Vec3::Constant(5e-3)}, 1e-3);
    EXPECT_LE(box.edge, 1e-3 + 1e-12);
    EXPECT_GT(box.edge, 0.5e-3);
    EXPECT_DOUBLE_EQ(box.edge, box.voxels * voxel);
    EXPECT_TRUE(volume::kBrickEdge % box.voxels == 0 && (box.first.array() == 0).all());
  }
}

TEST(HeatGrid, ABoxFarFromTheBoneIsHarmless) {
  const auto bone = block({8, 8, 8}, 1e-3);
  HeatGrid heat(*bone, {Vec3::Constant(1), Vec3::Constant(2)}, {});
  EXPECT_EQ(heat.deposit(Vec3::Constant(1.5), 1e-3, 1), 0);
  EXPECT_EQ(heat.deposit(Vec3::Constant(std::nan("")), 1e-3, 1), 0);
  EXPECT_EQ(heat.deposit(Vec3::Constant(1e300), 1e300, 1), 0);
  heat.irrigate(Vec3::Constant(1e300));
  heat.advance(1);
  EXPECT_EQ(heat.ledger().missed, 3);
}

}  // namespace
}  // namespace burr::thermal
