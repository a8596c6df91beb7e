#include "window/replay/difference.h"

#include <cstring>

#include "burr/volume/sample.h"

namespace burr::app {
namespace {

constexpr double kSame = 0.4;              // surfaces nearer than this are the same [voxel]
constexpr std::size_t kMostColours = 253;  // of tissues: three numbers are left

// Around the bricks in which the two bones, or one of them and the start, differ.
math::Aabb changed_box(const volume::Bone& before, const volume::Bone& left,
                       const volume::Bone& right) {
  math::Aabb box;
  const auto same = [](const volume::Field* a, const volume::Field* b) {
    return a == b || (a != nullptr && b != nullptr &&
                      std::memcmp(a, b, volume::kBrickVoxels * sizeof *a) == 0);
  };
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const volume::Field* was = before.brick_field(brick);
    if (same(was, left.brick_field(brick)) && same(was, right.brick_field(brick))) continue;
    const math::Ijk first = before.brick_ijk(brick);
    for (const int edge : {-1, volume::kBrickEdge})
      box.extend(before.grid().world_from_grid((first + math::Ijk::Constant(edge)).cast<double>()));
  }
  return box;
}

// The patch that a mesh was made of.
surface::Patch unpacked(const render::SkinMesh& mesh) {
  surface::Patch patch;
  patch.vertices.reserve(mesh.vertices().size());
  for (const render::SkinVertex& v : mesh.vertices())
    patch.vertices.push_back({.p = v.p,
                              .n = render::normal_of(v),
                              .tissue = render::tissue_of(v),
                              .beneath = static_cast<volume::TissueId>(v.under & 0xFFU),
                              .through = static_cast<std::uint8_t>(v.under >> 8 & 0xFFU),
                              .wall = static_cast<std::uint8_t>(v.under >> 16 & 0xFFU)});
  patch.triangles.reserve(mesh.index_count());
  for (std::size_t n = 0; n < mesh.index_count(); ++n) patch.triangles.push_back(mesh.index(n));
  return patch;
}

bool meet(const math::Aabb& a, const math::Aabb& b) {
  return (a.lo.array() <= b.hi.array()).all() && (a.hi.array() >= b.lo.array()).all();
}

}  // namespace

bool same_grid(const volume::Grid& a, const volume::Grid& b) {
  return (a.world_from_grid(math::Vec3::Zero()) - b.world_from_grid(math::Vec3::Zero())).norm() <
             1e-9 &&
         (a.world_from_grid(math::Vec3::Ones()) - b.world_from_grid(math::Vec3::Ones())).norm() <
             1e-9 &&
         a.voxel == b.voxel && a.size == b.size;
}

Cut cut_at(const volume::Bone& before, const volume::Bone& there, const math::Vec3& surface,
           bool here_is_left) {
  const Cut mine = here_is_left ? Cut::left_only : Cut::right_only,
            others = here_is_left ? Cut::right_only : Cut::left_only;
  const double same = kSame * before.grid().voxel;
  const double deep = volume::depth_at(there, surface);  // below 0: in the other's air
  if (deep < -same && volume::depth_at(before, surface) > -same) return others;
  if (volume::depth_at(before, surface) < same) return Cut::none;  // the old surface
  return deep > same ? mine : Cut::both;
}

Cut cut_in(bool before, bool left, bool right) {
  if (!before || (left && right)) return Cut::none;
  return left ? Cut::right_only : right ? Cut::left_only : Cut::both;
}

bool Difference::add_colours(std::vector<render::Colour>& colours) {
  if (colours.size() > kMostColours) return false;
  colours.insert(colours.end(), {kLeftOnly, kRightOnly, kBothCut});
  return true;
}

void Difference::paint(render::Scene& left, const volume::Bone& left_bone, render::Scene& right,
                       const volume::Bone& right_bone) {
  unpaint();
  counts_ = {};
  const math::Aabb changed = changed_box(*before_, left_bone, right_bone);
  if (changed.empty()) return;
  paint_one(left, right_bone, true, changed);
  paint_one(right, left_bone, false, changed);
}

void Difference::paint_one(render::Scene& scene, const volume::Bone& there, bool is_left,
                           const math::Aabb& changed) {
  const auto first = static_cast<volume::TissueId>(scene.tissue_colours.size() - 3);
  for (std::size_t n = 0; n < scene.patches.size(); ++n) {
    const render::ScenePatch was = scene.patches[n];
    if (was.mesh == nullptr || was.mesh->vertices().empty() || !meet(was.box, changed)) continue;
    std::vector<Cut> cuts(was.mesh->vertices().size());
    bool any = false;
    for (std::size_t v = 0; v < cuts.size(); ++v) {
      cuts[v] = cut_at(*before_, there, was.mesh->vertices()[v].p.cast<double>(), is_left);
      ++counts_[static_cast<std::size_t>(cuts[v])];
      any = any || cuts[v] != Cut::none;
    }
    if (!any) continue;
    surface::Patch patch = unpacked(*was.mesh);
    for (std::size_t v = 0; v < cuts.size(); ++v) {
      if (cuts[v] == Cut::none) continue;
      patch.vertices[v].tissue =
          static_cast<volume::TissueId>(first + static_cast<int>(cuts[v]) - 1);
      patch.vertices[v].beneath = 0;
      patch.vertices[v].through = patch.vertices[v].wall = 0;
    }
    render::set_patch(scene, static_cast<int>(n), patch);
    kept_.push_back({&scene, static_cast<int>(n), was, scene.patches[n].version});
  }
}

void Difference::unpaint() {
  for (Kept& kept : kept_)
    if (kept.scene->patches[static_cast<std::size_t>(kept.patch)].version == kept.version)
      render::set_patch(*kept.scene, kept.patch, std::move(kept.was));
  kept_.clear();
}

}  // namespace burr::app
