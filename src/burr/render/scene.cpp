#include "burr/render/scene.h"

#include <algorithm>
#include <utility>

#include "burr/base/check.h"

namespace burr::render {

using math::Vec3;

std::vector<Colour> colours_of(const volume::TissueTable& tissues) {
  std::vector<Colour> colours;
  colours.reserve(tissues.tissues.size());
  for (const volume::Tissue& tissue : tissues.tissues) colours.push_back(tissue.colour);
  return colours;
}

std::vector<Colour> as_bone(std::vector<Colour> colours) {
  for (std::size_t t = 1; t < colours.size(); ++t) colours[t] = volume::Tissue{}.colour;
  return colours;
}

ScenePatch packed(const surface::Patch& patch) {
  ScenePatch made;
  if (patch.triangles.empty()) return made;
  math::Vec3f lo = patch.vertices.front().p, hi = lo;
  for (const surface::Vertex& vertex : patch.vertices) {
    lo = lo.cwiseMin(vertex.p);
    hi = hi.cwiseMax(vertex.p);
  }
  made.box.extend(lo.cast<double>());
  made.box.extend(hi.cast<double>());
  made.mesh = std::make_shared<const SkinMesh>(patch);
  return made;
}

void set_patch(Scene& scene, int index, ScenePatch&& patch) {
  BURR_CHECK(index >= 0);
  const auto place = static_cast<std::size_t>(index);
  if (place >= scene.patches.size()) scene.patches.resize(place + 1);
  ScenePatch& entry = scene.patches[place];
  patch.version = entry.version + 1;
  entry = std::move(patch);
  scene.changes.add(index);
  int block = place < scene.block_of.size() ? scene.block_of[place] : -1;
  while (block >= 0) {
    SceneBlock& around = scene.blocks[static_cast<std::size_t>(block)];
    ++around.now;
    block = around.outer;
  }
}

void set_patch(Scene& scene, int index, const surface::Patch& patch) {
  set_patch(scene, index, packed(patch));
}

void set_stains(Scene& scene, int index, std::shared_ptr<const std::vector<Stain>> stains) {
  ScenePatch& patch = scene.patches[static_cast<std::size_t>(index)];
  if (patch.stains == stains) return;
  patch.stains = std::move(stains);
  scene.changes.add(index);
}

void set_coarser(Scene& scene, int index, std::shared_ptr<const std::vector<CoarseLevel>> levels) {
  scene.patches[static_cast<std::size_t>(index)].coarser = std::move(levels);
  scene.changes.add(index);
}

std::uint64_t versions_of(const Scene& scene, const SceneBlock& block) {
  std::uint64_t sum = 0;
  for (const int patch : block.patches)
    if (const auto p = static_cast<std::size_t>(patch); p < scene.patches.size())
      sum += scene.patches[p].version;
  return sum;
}

math::Aabb bounds(const Scene& scene) {
  math::Aabb box;
  for (const ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr) continue;
    box.extend(patch.box.lo);
    box.extend(patch.box.hi);
  }
  for (const SoftStructure& structure : scene.soft) {
    if (structure.box.empty()) continue;
    box.extend(structure.box.lo);
    box.extend(structure.box.hi);
  }
  if (scene.drape != nullptr) {
    box.extend(scene.drape->box.lo);
    box.extend(scene.drape->box.hi);
  }
  return box;
}

Camera whole_view(const Scene& scene, double azimuth, double elevation, double aspect) {
  std::vector<math::Aabb> boxes;
  for (const ScenePatch& patch : scene.patches)
    if (patch.mesh != nullptr) boxes.push_back(patch.box);
  return fit(boxes, azimuth, elevation, aspect, scene.camera);
}

void show_contact(Scene& scene, const Vec3& hand, const Vec3& proxy, const Vec3& force,
                  double length_per_newton) {
  constexpr Colour kHand = {0.25F, 0.65F, 1.0F}, kForce = {1.0F, 0.45F, 0.15F};
  scene.markers.clear();
  scene.rods.clear();
  const double size = std::clamp(0.2 * scene.burr.radius, 0.1e-3, 0.5e-3);

  scene.markers.push_back({hand, 0.8 * size, kHand, true});
  if ((proxy - hand).norm() > size)
    scene.rods.push_back({hand, proxy, 0.5 * size, kHand, false, true});
  if (force.norm() * length_per_newton < 4 * size) return;
  scene.rods.push_back({proxy, proxy + length_per_newton * force, size, kForce, true, true});
}

}  // namespace burr::render
