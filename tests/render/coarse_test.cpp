// Patches drawn with fewer triangles: no cracks, no colours that move, errors within the promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "burr/math/rotation.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/render/bone_scene.h"
#include "burr/render/coarse_mesh.h"
#include "burr/render/coarsening.h"
#include "burr/render/renderer.h"
#include "burr/render/thin_patch.h"
#include "burr/surface/mesher.h"
#include "render/formula_surfaces.h"
#include "render/gpu.h"

namespace burr::render {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.3 * kMm;
constexpr double kErrors[] = {0.1 * kVoxel, 0.3 * kVoxel};

// A block with a closed cave, shaped like a ball: from inside one sees bone in all directions. The
// bone has two tissues, which meet in a slanted plane.
Scene cave() {
  NoProgress quiet;
  volume::TissueTable table;
  table.tissues.push_back(table.tissues[1]);
  table.tissues[2].name = "other";
  table.tissues[2].colour = {0.2F, 0.4F, 0.9F};
  phantom::Formula formula;
  formula.depth = phantom::common(phantom::box(Vec3::Constant(12 * kMm)), phantom::bowl(9 * kMm));
  formula.tissue = [](const Vec3& p, double) {
    return static_cast<volume::TissueId>(p.x() + 0.4 * p.z() > 1 * kMm ? 2 : 1);
  };
  auto bone = phantom::bone_from_formula(
      phantom::box_grid(Vec3::Constant(-14 * kMm), Vec3::Constant(14 * kMm), kVoxel), table,
      formula, 0, 2, quiet);
  EXPECT_TRUE(bone.ok());
  Scene scene;
  EXPECT_TRUE(skin_bone(scene, **bone, 2, quiet).ok());
  scene.look.plain = true;
  return scene;
}

// number of patches along each axis
math::Ijk cave_patches() {
  const volume::Grid grid =
      phantom::box_grid(Vec3::Constant(-14 * kMm), Vec3::Constant(14 * kMm), kVoxel);
  const volume::Bone bone(grid, volume::TissueTable{}, 1, 0, false);
  return surface::Mesher(bone).patches();
}

using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// directed edges without a partner
template <class At>
Edges rim_of(std::size_t count, const At& at) {
  Edges edges, rim;
  for (std::size_t t = 0; t + 2 < count; t += 3)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({at(t + k), at(t + (k + 1) % 3)});
  for (const auto& [a, b] : edges)
    if (edges.count({b, a}) == 0) rim.insert({a, b});
  return rim;
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Ericson 2005, 5.1.5
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6)
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
  const Vec3 n = ab.cross(ac).normalized();
  return std::abs(ap.dot(n));
}

// All patches whose number modulo `by` is `rest`.
JoinedMesh joined(const Scene& scene, std::size_t by = 1, std::size_t rest = 0) {
  JoinedMesh all;
  for (std::size_t p = rest; p < scene.patches.size(); p += by)
    if (scene.patches[p].mesh != nullptr) all.add(*scene.patches[p].mesh);
  return all;
}

using Place = std::array<float, 3>;
Place place_of(const SkinVertex& v) { return {v.p.x(), v.p.y(), v.p.z()}; }

TEST(CoarseMesh, KeepsTheRimTheTissuesAndTheShape) {
  const Scene scene = cave();
  double worst[2] = {};
  std::size_t full = 0, left[2] = {};
  // every third patch: each is border all around
  const JoinedMesh before = joined(scene, 3, 1);
  const CoarseMesh coarse = coarser(JoinedMesh(before), kErrors);
  ASSERT_EQ(coarse.levels.size(), 2U);
  // vertices are identified by position; seams are closed
  const auto edges = [](const std::vector<SkinVertex>& vertices,
                        const std::vector<std::uint32_t>& triangles) {
    std::map<Place, std::uint32_t> number;
    std::vector<std::uint32_t> at;
    for (const SkinVertex& v : vertices)
      at.push_back(
          number.emplace(place_of(v), static_cast<std::uint32_t>(number.size())).first->second);
    const Edges rim = rim_of(triangles.size(), [&](std::size_t n) { return at[triangles[n]]; });
    std::vector<const Place*> place(number.size());
    for (const auto& [where, n] : number) place[n] = &where;
    std::set<std::pair<Place, Place>> named;
    for (const auto& [a, b] : rim) named.insert({*place[a], *place[b]});
    return named;
  };
  // triangles between tissues, by the positions of their corners
  const auto mixed = [](const std::vector<SkinVertex>& vertices,
                        const std::vector<std::uint32_t>& triangles) {
    std::multiset<std::array<Place, 3>> found;
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
      const auto v = [&](std::size_t k) { return vertices[triangles[t + k]]; };
      if (tissue_of(v(0)) != tissue_of(v(1)) || tissue_of(v(1)) != tissue_of(v(2)))
        found.insert({place_of(v(0)), place_of(v(1)), place_of(v(2))});
    }
    return found;
  };
  const auto rim = edges(before.vertices, before.triangles);
  EXPECT_GT(rim.size(), 1000U);
  EXPECT_GT(mixed(before.vertices, before.triangles).size(), 100U);
  full = before.triangles.size() / 3;
  for (std::size_t l = 0; l < 2; ++l) {
    const auto& indices = coarse.levels[l].indices;
    EXPECT_EQ(coarse.levels[l].error, kErrors[l]);
    ASSERT_EQ(indices.size() % 3, 0U);
    left[l] = indices.size() / 3;
    EXPECT_EQ(edges(coarse.vertices, indices), rim);
    EXPECT_EQ(mixed(coarse.vertices, indices), mixed(before.vertices, before.triangles));
    // distance of some of the old vertices from the new surface
    const auto at = [&](std::uint32_t i) { return Vec3(coarse.vertices[i].p.cast<double>()); };
    for (std::size_t v = 0; v < before.vertices.size(); v += 97) {
      const Vec3 p = before.vertices[v].p.cast<double>();
      double nearest = 1;
      for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
        nearest = std::min(nearest, distance_to_triangle(p, at(indices[t]), at(indices[t + 1]),
                                                         at(indices[t + 2])));
      }
      worst[l] = std::max(worst[l], nearest);
    }
  }
  std::printf("of %zu triangles %zu and %zu; off by at most %.3f and %.3f voxel\n", full, left[0],
              left[1], worst[0] / kVoxel, worst[1] / kVoxel);
  EXPECT_LT(left[0], full / 2);
  EXPECT_LT(left[1], left[0]);
  // a quadric's error is a mean over planes: some vertices are twice as far
  EXPECT_LT(worst[0], 2.5 * kErrors[0]);
  EXPECT_LT(worst[1], 2.5 * kErrors[1]);
}

TEST(CoarseMesh, OfNothingIsNothing) { EXPECT_TRUE(coarser(JoinedMesh{}, kErrors).levels.empty()); }

// Each patch by itself, with its own vertices.
TEST(ThinPatch, KeepsTheRimTheTissuesAndTheShape) {
  const Scene scene = cave();
  std::size_t full = 0, left = 0, rims = 0, mixed_count = 0;
  double worst = 0;
  for (const ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr) continue;
    const SkinMesh& mesh = *patch.mesh;
    const std::vector<CoarseLevel> levels = thinned(mesh, kErrors);
    full += mesh.index_count();
    left += levels.empty() ? mesh.index_count() : levels.back().indices.size();
    const Edges rim = rim_of(mesh.index_count(), [&](std::size_t n) { return mesh.index(n); });
    rims += rim.size();
    const auto mixed = [&](std::size_t count, const auto& at) {
      std::multiset<std::array<std::uint32_t, 3>> found;
      for (std::size_t t = 0; t + 2 < count; t += 3) {
        const std::array<std::uint32_t, 3> c = {at(t), at(t + 1), at(t + 2)};
        const auto of = [&](std::size_t k) { return tissue_of(mesh.vertices()[c[k]]); };
        if (of(0) == of(1) && of(1) == of(2)) continue;
        for (std::size_t k = 0; k < 3; ++k)  // the edges that go from one to the other
          if (of(k) != of((k + 1) % 3)) found.insert({c[k], c[(k + 1) % 3], 0});
      }
      return found;
    };
    const auto before = mixed(mesh.index_count(), [&](std::size_t n) { return mesh.index(n); });
    mixed_count += before.size();
    for (const CoarseLevel& level : levels) {
      const auto at = [&](std::size_t n) { return level.indices[n]; };
      EXPECT_EQ(rim_of(level.indices.size(), at), rim);
      EXPECT_EQ(mixed(level.indices.size(), at), before);
      const auto place = [&](std::size_t n) {
        return Vec3(mesh.vertices()[at(n)].p.cast<double>());
      };
      for (std::size_t v = 0; v < mesh.vertices().size(); v += 37) {
        const Vec3 p = mesh.vertices()[v].p.cast<double>();
        double nearest = 1;
        for (std::size_t t = 0; t + 2 < level.indices.size(); t += 3)
          nearest =
              std::min(nearest, distance_to_triangle(p, place(t), place(t + 1), place(t + 2)));
        worst = std::max(worst, nearest / level.error);
      }
    }
  }
  std::printf("of %zu triangles %zu; off by at most %.2f of the error\n", full / 3, left / 3,
              worst);
  EXPECT_GT(rims, 1000U);
  EXPECT_GT(mixed_count, 100U);
  EXPECT_LT(left, full / 2);
  EXPECT_LT(worst, 2.5);
}

TEST(ThinPatch, OfNothingIsNothing) {
  EXPECT_TRUE(thinned(SkinMesh(surface::Patch{}), kErrors).empty());
}

// For all patches together nothing is border: far fewer triangles, and the surface is still closed.
TEST(CoarseMesh, SeamsBetweenWhatIsJoinedAreNoRim) {
  const Scene scene = cave();
  const CoarseMesh coarse = coarser(joined(scene), kErrors);
  ASSERT_EQ(coarse.levels.size(), 2U);
  std::map<Place, std::uint32_t> number;
  std::vector<std::uint32_t> at;
  for (const SkinVertex& v : coarse.vertices)
    at.push_back(
        number.emplace(place_of(v), static_cast<std::uint32_t>(number.size())).first->second);
  for (const CoarseLevel& level : coarse.levels)
    EXPECT_TRUE(
        rim_of(level.indices.size(), [&](std::size_t n) { return at[level.indices[n]]; }).empty());
  EXPECT_LT(coarse.levels[1].indices.size(), joined(scene).triangles.size() / 10);
}

void settle(Coarsening& coarse, Scene& scene, double now) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  do {
    coarse.update(scene, now);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (coarse.waiting() > 0 && std::chrono::steady_clock::now() < end);
  coarse.update(scene, now);
}

// the block is valid for the present patches
bool stands(const Scene& scene, const SceneBlock& block) {
  EXPECT_EQ(block.now, versions_of(scene, block));
  return block.mesh != nullptr && block.versions == versions_of(scene, block);
}

TEST(Coarsening, MakesAllOnceAndWhatIsMilledWhenItRests) {
  Scene scene = cave();
  Coarsening coarse(cave_patches(), kVoxel);
  coarse.hold_back(true);
  coarse.update(scene, 0);
  EXPECT_EQ(coarse.waiting(), 0U);
  coarse.hold_back(false);
  settle(coarse, scene, 0);

  // every patch is in one smallest block, every block but the largest in one larger
  std::vector<int> within(scene.patches.size()), large(scene.blocks.size());
  for (const SceneBlock& block : scene.blocks) {
    EXPECT_TRUE(versions_of(scene, block) == 0 || stands(scene, block));
    for (const int inner : block.inner) ++large[static_cast<std::size_t>(inner)];
    if (!block.inner.empty()) continue;
    for (const int patch : block.patches)
      if (static_cast<std::size_t>(patch) < within.size())
        ++within[static_cast<std::size_t>(patch)];
  }
  EXPECT_EQ(within, std::vector<int>(within.size(), 1));
  for (std::size_t b = 0; b < scene.blocks.size(); ++b)
    EXPECT_EQ(large[b], scene.blocks[b].outer < 0 ? 0 : 1);

  // a new patch, as after milling: no block is valid for it until it has been at rest
  std::size_t some = 0;
  while (scene.patches[some].mesh == nullptr) ++some;
  const auto all_stand = [&](bool with, bool larger = false) {
    for (const SceneBlock& block : scene.blocks)
      if ((!larger || !block.inner.empty()) &&
          (std::find(block.patches.begin(), block.patches.end(), static_cast<int>(some)) !=
           block.patches.end()) &&
          stands(scene, block) != with)
        return false;
    return true;
  };
  const ScenePatch again = scene.patches[some];
  EXPECT_TRUE(all_stand(true));
  set_patch(scene, static_cast<int>(some), ScenePatch(again));
  for (const double now : {10.0, 10.2}) {
    settle(coarse, scene, now);
    EXPECT_TRUE(all_stand(false)) << now;
  }
  settle(coarse, scene, 10.5);  // the smallest one comes first
  EXPECT_FALSE(all_stand(false));
  EXPECT_TRUE(all_stand(false, true));
  settle(coarse, scene, 11.1);
  EXPECT_TRUE(all_stand(true));
  // a patch that changes while its coarse levels are being made does not get the old ones
  set_patch(scene, static_cast<int>(some), ScenePatch(again));
  coarse.update(scene, 20);
  coarse.update(scene, 21.1);
  set_patch(scene, static_cast<int>(some), ScenePatch(again));
  settle(coarse, scene, 21.2);
  EXPECT_TRUE(all_stand(false));
}

TEST(Coarsening, EndsInTheMiddleOfItsWork) {
  Scene scene = cave();
  Coarsening coarse(cave_patches(), kVoxel);
  coarse.update(scene, 0);
  EXPECT_GT(coarse.waiting(), 0U);
}

TEST(CoarsePicture, OfAClosedCaveShowsNoBackground) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = cave();
  Coarsening coarse(cave_patches(), kVoxel);
  settle(coarse, scene, 0);
  // neighbours of every kind: no block around one of the patches is valid
  const auto in_middle = [](const ScenePatch& patch) {
    return patch.mesh != nullptr && patch.box.centre().norm() < 10 * kMm;
  };
  const auto some = std::find_if(scene.patches.begin(), scene.patches.end(), in_middle);
  ASSERT_NE(some, scene.patches.end());
  set_patch(scene, static_cast<int>(some - scene.patches.begin()), ScenePatch(*some));
  const int hole = static_cast<int>(some - scene.patches.begin());
  int holed = 0, sizes = 0;
  for (const SceneBlock& block : scene.blocks) {
    const bool with =
        std::find(block.patches.begin(), block.patches.end(), hole) != block.patches.end();
    EXPECT_EQ(stands(scene, block), versions_of(scene, block) != 0 && !with);
    holed += with ? 1 : 0;
    sizes += block.outer < 0 && with ? 1 : 0;
  }
  EXPECT_GE(holed, 3);
  EXPECT_EQ(sizes, 1);
  scene.look.background_top = scene.look.background_bottom = {1, 0, 1};
  scene.quality.coarse_px = 1000;
  scene.quality.refine = false;
  scene.camera.field_of_view = 1.5;
  scene.camera.distance = 3 * kMm;
  gpu.resize_offscreen(700, 500);
  for (int view = 0; view < 40; ++view) {
    orbit(scene.camera, 0.7, 0.31 * std::sin(view));
    ASSERT_TRUE(gpu.show(scene).ok());
    const Image image = gpu.shown();
    long through = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      through += image.rgb[i] > 200 && image.rgb[i + 1] < 60 && image.rgb[i + 2] > 200;
    EXPECT_EQ(through, 0) << "view " << view;
  }
  // it was drawn coarse at all
  scene.camera.distance = 80 * kMm;
  gpu.skip_hidden(false);
  ASSERT_TRUE(gpu.show(scene).ok());
  const long coarse_ones = gpu.figures().triangles_drawn;
  scene.quality.coarse_px = 0;
  orbit(scene.camera, 0.01, 0);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_GT(gpu.figures().triangles_drawn, 2 * coarse_ones);
}

// Coarse levels show patches in an earlier state: of a patch that was milled, or has dust or blood
// on it, not one pixel may come from the block's older state.
TEST(CoarsePicture, DrawsWhatChangedOrIsDressedAsItIsAndNotAsItsBlockWas) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = cave();
  Coarsening coarse(cave_patches(), kVoxel);
  settle(coarse, scene, 0);
  scene.camera = whole_view(scene, 0.5, 0.4, 1.4);
  scene.tissue_colours.resize(4);
  scene.tissue_colours[3] = {1, 0, 1};
  gpu.resize_offscreen(700, 500);
  const Vec3 eye = scene.camera.eye();
  int nearest = -1;
  for (std::size_t p = 0; p < scene.patches.size(); ++p)
    if (scene.patches[p].mesh != nullptr &&
        (nearest < 0 ||
         (scene.patches[p].box.centre() - eye).norm() <
             (scene.patches[static_cast<std::size_t>(nearest)].box.centre() - eye).norm()))
      nearest = static_cast<int>(p);
  const ScenePatch before = scene.patches[static_cast<std::size_t>(nearest)];

  const auto count = [&](double coarse_px, const auto& is) {
    scene.quality.coarse_px = coarse_px;
    scene.quality.refine = false;
    orbit(scene.camera, 1e-4, 0);  // draws everything
    EXPECT_TRUE(gpu.show(scene).ok());
    const Image image = gpu.shown();
    long found = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) found += is(&image.rgb[i]);
    return found;
  };
  const auto pink = [](const std::uint8_t* rgb) {
    return rgb[0] > 200 && rgb[1] < 60 && rgb[2] > 200;
  };
  EXPECT_EQ(count(1000, pink), 0);
  surface::Patch other = test::unpacked(*before.mesh);
  for (auto& v : other.vertices) v.tissue = 3;
  set_patch(scene, nearest, other);
  const long all = count(0, pink);
  EXPECT_GT(all, 500);
  EXPECT_NEAR(static_cast<double>(count(1000, pink)), static_cast<double>(all),
              0.02 * static_cast<double>(all));

  // unchanged again, so its block is valid again; then blood comes over it
  set_patch(scene, nearest, ScenePatch(before));
  settle(coarse, scene, 10);
  settle(coarse, scene, 12);
  const auto red = [](const std::uint8_t* rgb) {
    return rgb[0] > 2 * rgb[1] && rgb[0] > 2 * rgb[2];
  };
  EXPECT_EQ(count(1000, red), 0);
  set_stains(scene, nearest,
             std::make_shared<const std::vector<Stain>>(before.mesh->vertices().size(),
                                                        Stain{0, 0, 0, 255}));
  const long bloody = count(0, red);
  EXPECT_GT(bloody, 500);
  EXPECT_NEAR(static_cast<double>(count(1000, red)), static_cast<double>(bloody),
              0.02 * static_cast<double>(bloody));
}

// What was left out while the eye moved is drawn later, exact to the bit, in any order of events.
TEST(CoarsePicture, AtRestBecomesThatOfAllTriangles) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = cave();
  scene.look = {};
  scene.camera = whole_view(scene, 0.5, 0.4, 1.4);
  scene.burr.visible = true;
  scene.burr.world_from_tool.p = Vec3(0, -11 * kMm, 0);
  // away from the eye: the handpiece is longer than the cave, and what moves is drawn anew
  scene.burr.world_from_tool.q =
      math::shortest_rotation(Vec3::UnitZ(), Vec3(-scene.camera.backward()));
  gpu.resize_offscreen(700, 500);
  const auto still = gpu.image(scene, 300, 200);
  ASSERT_TRUE(gpu.show(scene).ok());
  const Image full = gpu.shown();
  const long all = gpu.figures().triangles_drawn;
  Coarsening coarse(cave_patches(), kVoxel);
  settle(coarse, scene, 0);

  Quality least;
  least.ambient_occlusion = false;
  least.ambient_occlusion_later = true;
  least.coarse_px = 3;
  least.refine = false;
  for (const bool ambient_occlusion_later : {false, true}) {
    scene.quality = least;
    scene.quality.ambient_occlusion_later = ambient_occlusion_later;
    orbit(scene.camera, 0.1, 0);
    ASSERT_TRUE(gpu.show(scene).ok());
    orbit(scene.camera, -0.1, 0);
    ASSERT_TRUE(gpu.show(scene).ok());
    EXPECT_LT(gpu.figures().triangles_drawn, all / 4);
    EXPECT_FALSE(gpu.refined());
    EXPECT_NE(gpu.shown().rgb, full.rgb);
    ASSERT_TRUE(gpu.show(scene).ok());
    EXPECT_FALSE(gpu.refined()) << "not wanted yet";

    scene.quality.refine = true;
    int frames = 0;
    double most = 0;
    while (!gpu.refined() && ++frames < 200) {
      // the hand moves meanwhile
      scene.burr.world_from_tool.p.x() = frames % 2 == 0 ? 0 : 2 * kMm;
      ASSERT_TRUE(gpu.show(scene).ok());
      if (!gpu.refined()) most = std::max(most, gpu.figures().redrawn);
    }
    scene.burr.world_from_tool.p.x() = 0;
    ASSERT_TRUE(gpu.show(scene).ok());
    EXPECT_TRUE(gpu.refined());
    EXPECT_GT(frames, 5) << "all at once makes a hand wait";
    EXPECT_LT(most, 0.9);
    EXPECT_EQ(gpu.shown().rgb, full.rgb) << ambient_occlusion_later;
  }

  // fewer samples: the same picture, softer; then sharp again
  scene.quality = {};
  scene.quality.scale = 0.75;
  ASSERT_TRUE(gpu.show(scene).ok());
  const Image soft = gpu.shown();
  ASSERT_EQ(soft.rgb.size(), full.rgb.size());
  double sum = 0;
  for (std::size_t i = 0; i < full.rgb.size(); ++i)
    sum += std::pow(static_cast<double>(full.rgb[i]) - soft.rgb[i], 2);
  const double rms = std::sqrt(sum / static_cast<double>(full.rgb.size()));
  std::printf("fewer samples: %.2f of 255 rms\n", rms);
  EXPECT_GT(rms, 0.1);
  EXPECT_LT(rms, 6);
  scene.quality = {};
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(gpu.shown().rgb, full.rgb);

  scene.quality = least;
  const auto again = gpu.image(scene, 300, 200);
  ASSERT_TRUE(still.ok() && again.ok());
  EXPECT_EQ(still->rgb, again->rgb) << "an image leaves nothing out";
}

}  // namespace
}  // namespace burr::render
