#include "burr/surface/mesher.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <thread>

#include "burr/surface/cases.h"
#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using math::Vec3;
using test::askew;
using test::bone_of;
using test::Shape;
using test::shape_of;
using volume::Field;

Mesh whole(const volume::Bone& bone, int threads = 2) {
  NoProgress progress;
  auto mesh = whole_surface(bone, threads, progress);
  EXPECT_TRUE(mesh.ok());
  return std::move(*mesh);
}

double ball(const Vec3& p, const Vec3& centre, double radius) {
  return radius - (p - centre).norm();
}

TEST(Cases, NeverNeedMoreThanFiveTrianglesAndOppositesMirrorEachOther) {
  for (std::size_t solid = 0; solid < 256; ++solid) EXPECT_LE(cell_cases()[solid].count, 5);
  EXPECT_EQ(cell_cases()[0].count, 0);
  EXPECT_EQ(cell_cases()[255].count, 0);
  EXPECT_EQ(cell_cases()[1].count, 1);
  EXPECT_EQ(cell_cases()[254].count, 1);
  EXPECT_EQ(cell_cases()[1 | 8].count, 2) << "diagonal solid corners are kept apart";
}

TEST(Mesher, ABallIsOneClosedSurfaceWithItsVolumeAndNormals) {
  const auto grid = askew({50, 47, 53});
  const Vec3 centre(24.3, 22.1, 27.8);
  const auto bone = bone_of(grid, [&](const Vec3& p) { return ball(p, centre, 17.2); });
  const Mesh mesh = whole(*bone);
  const Shape shape = shape_of(mesh);
  EXPECT_EQ(shape.trouble, "");
  EXPECT_EQ(shape.euler(), 2);
  const double truth = 4.0 / 3 * std::numbers::pi * std::pow(17.2 * grid.voxel, 3);
  EXPECT_NEAR(shape.volume / truth, 1, 0.004);

  const Vec3 middle = grid.world_from_grid(centre);
  double off = 0, turned = 0;
  for (const Vertex& v : mesh.vertices) {
    const Vec3 out = v.p.cast<double>() - middle;
    off = std::max(off, std::abs(out.norm() / grid.voxel - 17.2));
    turned = std::max(turned, std::acos(std::min(1.0, out.normalized().dot(v.n.cast<double>()))));
    EXPECT_NEAR(v.n.norm(), 1, 1e-5);
    EXPECT_EQ(v.tissue, 1);
  }
  EXPECT_LT(off, 0.02) << "voxels from the ball";
  EXPECT_LT(turned * 180 / std::numbers::pi, 0.5) << "degrees from the ball's normal";
}

TEST(Mesher, ATorusHasOneHole) {
  const auto bone = bone_of(askew({60, 60, 30}), [](const Vec3& p) {
    const Vec3 d = p - Vec3(30, 29.5, 14.2);
    return 6.3 - std::hypot(std::hypot(d.x(), d.y()) - 18, d.z());
  });
  const Shape shape = shape_of(whole(*bone));
  EXPECT_EQ(shape.trouble, "");
  EXPECT_EQ(shape.euler(), 0);
  const double truth = 2 * std::pow(std::numbers::pi * 6.3, 2) * 18 * std::pow(0.5e-3, 3);
  EXPECT_NEAR(shape.volume / truth, 1, 0.01);
}

TEST(Mesher, APlateThatLeavesTheGridIsClosedHalfAVoxelOutside) {
  const auto bone =
      bone_of(askew({40, 33, 24}), [](const Vec3& p) { return 3.7 - std::abs(p.z() - 11.9); });
  const Shape shape = shape_of(whole(*bone));
  EXPECT_EQ(shape.trouble, "");
  EXPECT_EQ(shape.euler(), 2);
  EXPECT_NEAR(shape.volume / (40 * 33 * 7.4 * std::pow(0.5e-3, 3)), 1, 0.015);
}

TEST(Mesher, AWhollySolidGridIsABox) {
  for (const int n : {1, 7, 15, 16, 17, 31, 32}) {
    SCOPED_TRACE(n);
    const auto bone = bone_of(askew({n, n, n}), [](const Vec3&) { return 10.0; });
    const Shape shape = shape_of(whole(*bone));
    EXPECT_EQ(shape.trouble, "");
    EXPECT_EQ(shape.euler(), 2);
    EXPECT_LT(shape.volume, std::pow(n * 0.5e-3, 3));
    EXPECT_GT(shape.volume, std::pow((n - 1) * 0.5e-3, 3));
  }
}

TEST(Mesher, BricksThatReachBeyondTheGridAreCutOff) {
  volume::Grid grid = askew({19, 18, 21});
  volume::Bone bone(grid, {}, 1000, 0, false);
  for (volume::BrickIndex b = 0; b < bone.brick_count(); ++b)
    std::fill_n(bone.build_field(b), volume::kBrickVoxels, volume::kSolid);
  const Shape shape = shape_of(whole(bone));
  EXPECT_EQ(shape.trouble, "");
  EXPECT_NEAR(shape.volume / (19 * 18 * 21 * std::pow(grid.voxel, 3)), 1, 0.01);
}

// All faces and cells, ambiguous in every possible way.
TEST(Mesher, NoiseOfAnyKindIsAClosedManifold) {
  std::mt19937 random(20240817);
  for (int round = 0; round < 6; ++round) {
    SCOPED_TRACE("seed 20240817, round " + std::to_string(round));
    volume::Grid grid = askew({37, 35, 34});
    std::vector<Field> field(37 * 35 * 34);
    for (Field& voxel : field) switch (round % 3) {
        case 0:
          voxel = static_cast<Field>(random());
          break;
        case 1:  // near the iso-level, often exactly on it
          voxel = static_cast<Field>(volume::kIso - 2 + static_cast<int>(random() % 4));
          break;
        default:
          voxel = random() % 2 == 0 ? Field{0} : volume::kSolid;
      }
    const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);
    EXPECT_EQ(shape_of(whole(*bone)).trouble, "");
  }
}

TEST(Mesher, VerticesStayApartInFineVoxelsFarFromTheOrigin) {
  std::mt19937 random(5);
  volume::Grid grid = askew({20, 20, 20}, 0.035e-3);
  grid.frame.p = {0.4, -0.45, 0.49};
  std::vector<Field> field(20 * 20 * 20);
  for (Field& voxel : field) voxel = static_cast<Field>(volume::kIso - 2 + random() % 4);
  const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);
  EXPECT_EQ(shape_of(whole(*bone)).trouble, "");
}

TEST(Mesher, PatchesMeetBitForBitAndMakeTheWholeTogether) {
  std::mt19937 random(7);
  volume::Grid grid = askew({50, 34, 40});
  std::vector<Field> field(50 * 34 * 40);
  for (Field& voxel : field) voxel = static_cast<Field>(random());
  const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);

  using Bits = std::array<std::uint32_t, 7>;
  const auto bits_of = [](const Vertex& v) {
    Bits bits{};
    std::memcpy(bits.data(), v.p.data(), 12);
    std::memcpy(&bits[3], v.n.data(), 12);
    bits[6] = v.tissue;
    return bits;
  };
  const auto place_of = [](const Bits& bits) { return std::array{bits[0], bits[1], bits[2]}; };
  const Mesh mesh = whole(*bone);
  std::set<Bits> in_whole, in_patches;
  for (const Vertex& v : mesh.vertices) in_whole.insert(bits_of(v));

  Mesher mesher(*bone);
  Patch patch;
  std::map<std::array<std::uint32_t, 3>, int> places;
  std::size_t repeated = 0, triangles = 0;
  for (int i = 0; i < mesher.patch_count(); ++i) {
    ASSERT_TRUE(mesher.mesh_patch(i, patch));
    triangles += patch.triangles.size();
    for (const Vertex& v : patch.vertices) {
      in_patches.insert(bits_of(v));
      repeated += static_cast<std::size_t>(++places[place_of(bits_of(v))] > 1);
    }
  }
  EXPECT_GT(repeated, 1000U);
  EXPECT_EQ(in_patches.size(), places.size()) << "one place, two normals or tissues";
  EXPECT_EQ(in_patches, in_whole);
  EXPECT_EQ(triangles, mesh.triangles.size());
}

TEST(Mesher, TheSameMeshComesOutOfAnyNumberOfThreads) {
  const auto bone = bone_of(askew({70, 60, 50}), [](const Vec3& p) {
    return 4 * (std::sin(p.x() / 3) + std::sin(p.y() / 4) + std::sin(p.z() / 5));
  });
  const Mesh one = whole(*bone, 1), three = whole(*bone, 3);
  EXPECT_EQ(shape_of(one).trouble, "");
  EXPECT_EQ(one.triangles, three.triangles);
  ASSERT_EQ(one.vertices.size(), three.vertices.size());
  for (std::size_t i = 0; i < one.vertices.size(); ++i) {
    ASSERT_EQ(one.vertices[i].p, three.vertices[i].p);
    ASSERT_EQ(one.vertices[i].n, three.vertices[i].n);
  }
}

TEST(Mesher, AChangedBrickNamesEveryPatchThatLooksDifferent) {
  std::mt19937 random(11);
  const auto bone = bone_of(askew({60, 41, 49}), [](const Vec3& p) {
    return 4 * (std::sin(p.x() / 3) + std::sin(p.y() / 4) + std::sin(p.z() / 5));
  });
  Mesher mesher(*bone);
  const auto snapshot = [&] {
    std::vector<Patch> all(static_cast<std::size_t>(mesher.patch_count()));
    for (int i = 0; i < mesher.patch_count(); ++i)
      EXPECT_TRUE(mesher.mesh_patch(i, all[static_cast<std::size_t>(i)]));
    return all;
  };
  auto before = snapshot();
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE("seed 11, round " + std::to_string(round));
    const auto brick =
        static_cast<volume::BrickIndex>(random() % static_cast<unsigned>(bone->brick_count()));
    volume::BrickField content{};
    if (!bone->copy_brick(brick, content) || bone->brick_field(brick) == nullptr) continue;
    for (Field& voxel : content.voxel) voxel = static_cast<Field>(random());
    bone->write_brick(brick, content);
    std::vector<int> named;
    mesher.patches_of_brick(brick, named);
    EXPECT_LE(named.size(), 8U);
    const auto after = snapshot();
    for (int i = 0; i < mesher.patch_count(); ++i) {
      const Patch& a = before[static_cast<std::size_t>(i)];
      const Patch& b = after[static_cast<std::size_t>(i)];
      bool same = a.triangles == b.triangles && a.vertices.size() == b.vertices.size();
      for (std::size_t v = 0; same && v < a.vertices.size(); ++v)
        same = a.vertices[v].p == b.vertices[v].p && a.vertices[v].n == b.vertices[v].n;
      if (!same) {
        EXPECT_TRUE(std::find(named.begin(), named.end(), i) != named.end()) << "patch " << i;
      }
    }
    before = after;
  }
}

TEST(Mesher, TissueIsThatOfTheSolidSide) {
  volume::Grid grid = askew({24, 24, 24});
  std::vector<Field> field;
  std::vector<volume::TissueId> tissue;
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) {
        field.push_back(
            volume::field_from_depth(ball({double(i), double(j), double(k)}, {12, 12, 12}, 8.4)));
        tissue.push_back(field.back() < volume::kIso ? 0 : i < 12 ? 1 : 2);
      }
  volume::TissueTable table;
  table.tissues.resize(3);
  const auto bone = volume::bone_from_arrays(grid, table, field, tissue, {}, 0);
  int seen[3] = {0, 0, 0};
  for (const Vertex& v : whole(*bone).vertices) {
    const double i = grid.grid_from_world(v.p.cast<double>()).x();
    ASSERT_LT(v.tissue, 3);
    ++seen[v.tissue];
    if (i <= 11) {
      EXPECT_EQ(v.tissue, 1);
    }
    if (i >= 12) {
      EXPECT_EQ(v.tissue, 2);
    }
  }
  EXPECT_EQ(seen[0], 0);
  EXPECT_GT(seen[1], 100);
  EXPECT_GT(seen[2], 100);
}

TEST(Mesher, WorkersMayLookOnWhileTheServoCuts) {
  const auto bone = bone_of(
      askew({40, 40, 40}),
      [](const Vec3& p) {
        return ball(p, {20, 20, 20}, 14);
      },
      300);
  std::atomic<bool> stop = false;
  std::thread servo([&] {
    for (int round = 0; !stop; ++round) {
      const volume::BrickIndex brick = round % bone->brick_count();
      if (bone->ensure_slot(brick) == volume::kNoSlot) continue;
      volume::BrickField content;
      for (int v = 0; v < volume::kBrickVoxels; ++v)
        content.voxel[v] = static_cast<Field>(static_cast<unsigned>(round) * 7919U +
                                              static_cast<unsigned>(v) * 131U);
      bone->write_brick(brick, content);
      std::this_thread::yield();
    }
  });
  std::vector<std::thread> workers;
  std::atomic<int> meshed = 0;
  for (int w = 0; w < 2; ++w)
    workers.emplace_back([&] {
      Mesher mesher(*bone);
      Patch patch;
      for (int i = 0; i < 3000; ++i) {
        if (!mesher.mesh_patch(i % mesher.patch_count(), patch)) continue;
        ++meshed;
        for (const std::uint32_t v : patch.triangles) ASSERT_LT(v, patch.vertices.size());
      }
    });
  for (std::thread& worker : workers) worker.join();
  stop = true;
  servo.join();
  EXPECT_GT(meshed, 1000);
  EXPECT_EQ(shape_of(whole(*bone)).trouble, "");
}

TEST(Mesher, StopsWhenAsked) {
  struct Impatient final : Progress {
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  } progress;
  const auto bone = bone_of(askew({90, 90, 90}), [](const Vec3& p) { return 30 - p.z(); });
  const auto mesh = whole_surface(*bone, 1, progress);
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().trouble, Trouble::interrupted);
}

}  // namespace
}  // namespace burr::surface
