// The distance to a tissue, compared with a search over all voxels, and with a ball.
#include "burr/volume/distance_to.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "support/rt_guard.h"

namespace burr::volume {
namespace {

using math::Ijk;
using math::Vec3;

struct Labelled {
  Grid grid;
  std::vector<TissueId> labels;
  std::unique_ptr<Bone> bone;
};

std::size_t index_of(const Grid& grid, int i, int j, int k) {
  return static_cast<std::size_t>(i) +
         static_cast<std::size_t>(grid.size.x()) *
             (static_cast<std::size_t>(j) +
              static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(k));
}

// Soft tissue everywhere: only labels count, in bricks with and without material.
template <class Label>
Labelled labelled(const Ijk& size, double voxel, const Label& label) {
  Labelled made;
  made.grid.size = size;
  made.grid.voxel = voxel;
  made.grid.frame.p = {0.01, -0.02, 0.03};
  made.grid.frame.q = math::Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
  TissueTable tissues;
  for (int n = 2; n < 8; ++n) tissues.tissues.push_back({.name = "t", .kind = TissueKind::soft});
  made.labels.resize(index_of(made.grid, 0, 0, size.z()));
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) made.labels[index_of(made.grid, i, j, k)] = label(i, j, k);
  const std::vector<Field> field(made.labels.size(), 0);
  made.bone = bone_from_arrays(made.grid, tissues, field, made.labels, {}, 0);
  return made;
}

DistanceTo made(const Labelled& labelled, std::vector<TissueId> tissues,
                const DistanceSettings& settings = {}) {
  NoProgress quiet;
  auto distance = DistanceTo::make(*labelled.bone, tissues, settings, quiet);
  EXPECT_TRUE(distance);
  return std::move(*distance);
}

// Search over all voxels: the distance to the nearest centre of each wanted tissue [m].
std::vector<double> asked(const Labelled& labelled, const std::vector<TissueId>& tissues,
                          const Vec3& p) {
  std::vector<double> nearest(256, std::numeric_limits<double>::infinity());
  const Vec3 p_grid = labelled.grid.grid_from_world(p);
  const Ijk& size = labelled.grid.size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        const TissueId label = labelled.labels[index_of(labelled.grid, i, j, k)];
        if (std::find(tissues.begin(), tissues.end(), label) == tissues.end()) continue;
        nearest[label] =
            std::min(nearest[label], (Vec3(i, j, k) - p_grid).norm() * labelled.grid.voxel);
      }
  return nearest;
}
double least(const std::vector<double>& all) { return *std::min_element(all.begin(), all.end()); }

std::uint64_t seed_of_test() {
  const char* given = std::getenv("BURR_SEED");
  const std::uint64_t seed =
      given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
  std::printf("BURR_SEED=%llu\n", static_cast<unsigned long long>(seed));
  return seed;
}

// Few labels, so that most places are far from all of them; sizes without common factors.
Labelled random_bone(std::mt19937_64& random) {
  const auto edge = [&] { return static_cast<int>(5 + random() % 30); };
  const Ijk size(edge(), edge(), edge());
  const std::uint64_t rare = 20 + random() % 400;
  return labelled(size, 0.3e-3, [&](int, int, int) {
    return static_cast<TissueId>(random() % rare == 0 ? 1 + random() % 6 : random() % 2);
  });
}

TEST(DistanceTo, AtTheKeptVoxelsItIsTheNearestOfAll) {
  std::mt19937_64 random(seed_of_test());
  for (int round = 0; round < 12; ++round) {
    const Labelled bone = random_bone(random);
    const std::vector<TissueId> wanted = {3, 5};
    DistanceSettings settings;
    settings.reach = 1;
    const int step = 1 + round % 3;
    while (made(bone, wanted, settings).step() < step && !made(bone, wanted, settings).empty())
      settings.most_kept = settings.most_kept * 9 / 10;
    const DistanceTo distance = made(bone, wanted, settings);
    const double voxel = bone.grid.voxel;
    for (int n = 0; n < 200; ++n) {
      const auto some = [&](int size) {
        return distance.step() * static_cast<int>(random() % static_cast<std::uint64_t>(
                                                                 (size - 1) / distance.step() + 1));
      };
      const Ijk ijk(some(bone.grid.size.x()), some(bone.grid.size.y()), some(bone.grid.size.z()));
      const Vec3 p = bone.grid.world_from_grid(ijk.cast<double>());
      const std::vector<double> truth = asked(bone, wanted, p);
      const Nearest nearest = distance.at(p);
      if (std::isinf(least(truth))) {
        EXPECT_EQ(nearest.distance, least(truth));
        continue;
      }
      // rounding in the pose moves the point by a few nanometres
      EXPECT_NEAR(nearest.distance, least(truth) - voxel / 2, 1e-9) << ijk.transpose();
      EXPECT_NEAR(truth[nearest.tissue], least(truth), 1e-9) << "whose it is";
    }
  }
}

TEST(DistanceTo, BetweenThemItIsOffByLessThanTheCellAllows) {
  std::mt19937_64 random(seed_of_test());
  std::uniform_real_distribution<double> share(-0.3, 1.3);
  for (int round = 0; round < 8; ++round) {
    const Labelled bone = random_bone(random);
    const std::vector<TissueId> wanted = {3, 5};
    const DistanceTo distance =
        made(bone, wanted, {.reach = 1, .most_kept = round % 2 == 0 ? 1'000'000U : 2'000U});
    if (distance.empty()) continue;
    const double voxel = bone.grid.voxel, cell = distance.step() * voxel;
    for (int n = 0; n < 200; ++n) {
      const Vec3 p_grid(share(random) * bone.grid.size.x(), share(random) * bone.grid.size.y(),
                        share(random) * bone.grid.size.z());
      const Vec3 p = bone.grid.world_from_grid(p_grid);
      const std::vector<double> truth = asked(bone, wanted, p);
      const Nearest nearest = distance.at(p);
      const double off = nearest.distance - (least(truth) - voxel / 2);
      EXPECT_LE(off, std::sqrt(0.75) * cell + 1e-9);
      const Vec3 last = (bone.grid.size - Ijk::Ones()).cast<double>();
      if (p_grid.cwiseMax(0).cwiseMin(last) == p_grid) {
        EXPECT_GE(off, -std::sqrt(0.75) * cell - 1e-9);
        EXPECT_LE(truth[nearest.tissue], least(truth) + 2 * std::sqrt(0.75) * cell + 1e-9);
      }
    }
  }
}

TEST(DistanceTo, ABallIsAsFarAsItsFormulaSays) {
  const Vec3 centre(31.3, 24.8, 35.1);
  const double radius = 8;
  const Labelled bone = labelled({64, 56, 72}, 0.25e-3, [&](int i, int j, int k) {
    return static_cast<TissueId>((Vec3(i, j, k) - centre).norm() <= radius ? 4 : 1);
  });
  std::mt19937_64 random(seed_of_test());
  std::uniform_real_distribution<double> share(0, 1);
  for (const std::size_t most : {std::size_t{1'000'000}, std::size_t{40'000}}) {
    const DistanceTo distance = made(bone, {4}, {.reach = 1, .most_kept = most});
    EXPECT_EQ(distance.step(), most == 40'000 ? 2 : 1);
    double shortest = 0, longest = 0, sum = 0;
    int count = 0;
    for (int n = 0; n < 20'000; ++n) {
      const Vec3 p_grid(63 * share(random), 55 * share(random), 71 * share(random));
      const double truth = (p_grid - centre).norm() - radius;  // [voxel]
      if (truth < 0.5) continue;
      const Nearest nearest = distance.at(bone.grid.world_from_grid(p_grid));
      EXPECT_EQ(nearest.tissue, 4);
      const double off = nearest.distance / bone.grid.voxel - truth;
      shortest = std::min(shortest, off);
      longest = std::max(longest, off);
      sum += off;
      ++count;
    }
    std::printf("step %d: off by %.3f to %.3f voxel, %.3f in the mean\n", distance.step(), shortest,
                longest, sum / count);
    // a voxel belongs to the ball if its centre does, so the nearest centre lies slightly inside
    EXPECT_GT(shortest, -0.5 - 0.05 * distance.step());
    EXPECT_LT(longest, 0.45);
    EXPECT_NEAR(sum / count, -0.28, 0.05);
  }
}

TEST(DistanceTo, AWallIsExact) {
  const Labelled bone = labelled(
      {40, 17, 23}, 0.5e-3, [](int i, int, int) { return static_cast<TissueId>(i < 9 ? 2 : 1); });
  const DistanceTo distance = made(bone, {2}, {.reach = 1});
  for (double x = 8; x < 39; x += 0.37) {
    const Vec3 p = bone.grid.world_from_grid({x, 7.7, 11.2});
    EXPECT_NEAR(distance.at(p).distance, (x - 8.5) * 0.5e-3, 1e-9) << x;
  }
  EXPECT_NEAR(distance.at(bone.grid.world_from_grid({3.3, 4, 4})).distance, -0.25e-3, 1e-9)
      << "inside";
  // outside the grid the distance keeps growing and is never too long
  double before = 0;
  for (double x = 39; x < 80; x += 5) {
    const double now = distance.at(bone.grid.world_from_grid({x, 7.7, 11.2})).distance;
    EXPECT_GT(now, before) << x;
    EXPECT_LT(now, (x - 8.5) * 0.5e-3 + 1e-9) << x;
    before = now;
  }
}

TEST(DistanceTo, ASolidTissueEndsAtItsSurfaceNotWithItsLabels) {
  Grid grid;
  grid.size = {40, 20, 20};
  grid.voxel = 1e-3;
  std::vector<Field> field(index_of(grid, 0, 0, 20));
  const std::vector<TissueId> labels(field.size(), 1);  // everywhere, in the air too
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 40; ++i) field[index_of(grid, i, j, k)] = field_from_depth(9.5 - i);
  const Labelled bone = {grid, labels, bone_from_arrays(grid, {}, field, labels, {}, 0)};
  EXPECT_NEAR(made(bone, {1}, {.reach = 1}).at({20e-3, 5e-3, 5e-3}).distance, 10.5e-3, 1e-9);
  const Labelled half = labelled(
      {9, 9, 9}, 1e-3, [](int i, int, int) { return static_cast<TissueId>(i < 4 ? 0 : 2); });
  EXPECT_TRUE(made(half, {0}).empty()) << "air is nothing to spare";
}

TEST(DistanceTo, BeyondTheReachAndOfNothingThereIsNoAnswer) {
  const auto one = [](int i, int j, int k) {
    return static_cast<TissueId>(i == 2 && j == 2 && k == 2 ? 7 : 1);
  };
  const Labelled bone = labelled({300, 9, 9}, 1e-3, one);
  const auto at = [&bone](const DistanceTo& distance, double x) {
    return distance.at(bone.grid.world_from_grid({x, 2, 2}));
  };
  const DistanceTo distance = made(bone, {7}, {.reach = 20e-3});
  EXPECT_NEAR(at(distance, 22).distance, 19.5e-3, 1e-9);
  EXPECT_EQ(at(distance, 22).tissue, 7);
  EXPECT_TRUE(std::isinf(at(distance, 23).distance));
  EXPECT_EQ(at(distance, 23).tissue, 0);
  const DistanceTo far = made(bone, {7}, {.reach = 1});
  EXPECT_NEAR(far.reach(), 0.255, 1e-12);
  EXPECT_NEAR(at(far, 255).distance, 252.5e-3, 1e-9);
  EXPECT_TRUE(std::isinf(at(far, 299).distance));
  EXPECT_TRUE(std::isinf(far.at({std::nan(""), 0, 0}).distance));

  for (const DistanceTo& none : {made(bone, {6}), made(bone, {}), DistanceTo()}) {
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(none.memory_bytes(), 0U);
    EXPECT_TRUE(std::isinf(at(none, 2).distance));
  }
}

TEST(DistanceTo, IsTheSameHoweverManyWorkAndStopsWhenAsked) {
  std::mt19937_64 random(seed_of_test());
  const Labelled bone = random_bone(random);
  const DistanceTo one = made(bone, {3, 5}, {.reach = 1, .threads = 1});
  const DistanceTo four = made(bone, {3, 5}, {.reach = 1, .threads = 4});
  std::uniform_real_distribution<double> share(-0.3, 1.3);
  for (int n = 0; n < 2'000; ++n) {
    const Vec3 p = bone.grid.world_from_grid(Vec3(share(random), share(random), share(random))
                                                 .cwiseProduct(bone.grid.size.cast<double>()));
    EXPECT_EQ(one.at(p).distance, four.at(p).distance);
    EXPECT_EQ(one.at(p).tissue, four.at(p).tissue);
  }
  struct Stop final : Progress {
    void report(double fraction, std::string_view) override {
      EXPECT_GE(fraction, 0);
      EXPECT_LE(fraction, 1);
    }
    [[nodiscard]] bool cancelled() const override { return true; }
  } stop;
  const Labelled whole = labelled({30, 30, 30}, 1e-3, [](int, int, int) { return TissueId{2}; });
  const std::vector<TissueId> wanted = {2};
  const auto stopped = DistanceTo::make(*whole.bone, wanted, {}, stop);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().trouble, Trouble::interrupted);
}

TEST(DistanceTo, AskingTakesNoMemoryAndNoLock) {
  std::mt19937_64 random(7);
  const Labelled bone = random_bone(random);
  const DistanceTo distance = made(bone, {2}, {.reach = 1});
  ASSERT_FALSE(distance.empty());
  double sum = 0;
  const test::RtGuard guard;
  for (int n = 0; n < 1'000; ++n)
    sum += distance.at(bone.grid.world_from_grid({0.02 * n, 3, 4})).distance;
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
  EXPECT_TRUE(std::isfinite(sum));
}

// A small structure in a large grid: the memory goes by the structure and the reach, and far from it
// there is no answer.
TEST(DistanceTo, KeepsWhatItsReachNeeds) {
  const Labelled bone = labelled({120, 90, 100}, 0.5e-3, [](int i, int j, int k) {
    return static_cast<TissueId>(i == 60 && j == 41 && k == 50 ? 2 : 0);
  });
  for (const int step : {1, 2}) {
    const DistanceTo distance =
        made(bone, {2}, {.reach = 5e-3, .most_kept = step == 1 ? 2'000'000U : 200'000U});
    EXPECT_EQ(distance.step(), step);
    EXPECT_LT(distance.memory_bytes(), 3U * 40 * 40 * 40 / (step == 1 ? 1 : 4));
    double farthest = 0;
    for (int i = 0; i < 120; i += step)
      for (int j = 0; j < 90; j += step)
        for (int k = 0; k < 100; k += step) {
          const double far = 0.5e-3 * (Vec3(i, j, k) - Vec3(60, 41, 50)).norm() - 0.25e-3;
          const Nearest found = distance.at(bone.grid.world_from_grid(Vec3(i, j, k)));
          if (far > 5e-3 + 1e-9) {
            ASSERT_TRUE(std::isinf(found.distance)) << i << " " << j << " " << k;
          } else if (far < 5e-3 - 1e-9 && step == 1) {
            ASSERT_NEAR(found.distance, far, 1e-9) << i << " " << j << " " << k;
          }
          if (!std::isinf(found.distance)) farthest = std::max(farthest, found.distance);
        }
    EXPECT_GT(farthest, 4.9e-3);
  }
}

}  // namespace
}  // namespace burr::volume
