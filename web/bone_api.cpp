// What a worker calls for the bone that it shows: core_patch(), core_soft(), core_tissue(), core_row(), core_hashes(). What a call gives
// lies in the module's memory until the next call of the same function.
#include "bone_api.h"

#include <emscripten.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "burr/base/hash.h"
#include "burr/base/progress.h"
#include "work_of_page.h"

namespace burr::web {
namespace {

using math::Vec3;

std::uint64_t hash_of(const surface::Patch& patch) {
  if (patch.triangles.empty()) return 0;
  std::uint64_t hash = patch.vertices.size();
  const auto add = [&hash](const void* from, std::size_t bytes) {
    const auto* at = static_cast<const std::uint8_t*>(from);
    for (std::size_t n = 0; n < bytes; n += 4) {  // both are made of words of 4 bytes
      std::uint32_t word = 0;
      std::memcpy(&word, at + n, 4);
      hash = base::mix(hash, std::uint64_t{word});
    }
  };
  add(patch.vertices.data(), patch.vertices.size() * sizeof patch.vertices[0]);
  add(patch.triangles.data(), patch.triangles.size() * sizeof patch.triangles[0]);
  return hash;
}

// All patches, those around the work first.
void want_all(ShownBone& c) {
  const math::Ijk along = c.mesher->patches();
  const volume::Grid& grid = c.bone->grid();
  std::vector<std::pair<double, int>> order;
  for (int n = 0; n < c.mesher->patch_count(); ++n) {
    const math::Ijk at(n % along.x(), n / along.x() % along.y(), n / along.x() / along.y());
    const Vec3 middle =
        grid.frame.p + grid.frame.q * Vec3(grid.voxel * surface::kPatchEdge *
                                           (at.cast<double>().array() + 0.5).matrix());
    order.emplace_back((middle - work_at()).norm(), n);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [far, n] : order) c.want(n);
}

}  // namespace

ShownBone* shown = nullptr;

void ShownBone::take(std::unique_ptr<volume::Bone> new_bone) {
  bone = std::move(new_bone);
  changed = &bone->add_watcher();
  mesher = std::make_unique<surface::Mesher>(*bone);
  queued.resize(static_cast<std::size_t>(mesher->patch_count()));
  given_hashes.resize(queued.size());
  want_all(*this);
}

extern "C" {

// Meshes the next patch that is due. nullptr: none is. A patch without triangles had some before; number -1: the
// page has this patch already.
EMSCRIPTEN_KEEPALIVE const Given* core_patch() {
  ShownBone& c = *shown;
  c.changed->take_all([&](std::size_t brick) {
    c.named.clear();
    c.mesher->patches_of_brick(static_cast<volume::BrickIndex>(brick), c.named);
    for (const int patch : c.named) c.want(patch);
  });
  if (c.due.empty()) return nullptr;
  const int number = c.due.front();
  c.due.pop_front();
  c.queued[static_cast<std::size_t>(number)] = false;
  while (!c.mesher->mesh_patch(number, c.patch)) {  // nobody writes: it succeeds at once
  }
  // A changed brick names its neighbours too, whose surface is often the same: not worth a part of the picture.
  const std::uint64_t hash = hash_of(c.patch);
  const bool same = std::exchange(c.given_hashes[static_cast<std::size_t>(number)], hash) == hash;
  if (same) {
    c.given = {};
    return &c.given;
  }
  c.given = {number, c.patch.vertices.data(), c.patch.vertices.size(), c.patch.triangles.data(),
             c.patch.triangles.size()};
  return &c.given;
}
EMSCRIPTEN_KEEPALIVE int core_patches_due() { return static_cast<int>(shown->due.size()); }
// All patches are due once more, for somebody who has none of them.
EMSCRIPTEN_KEEPALIVE void core_again() {
  std::fill(shown->given_hashes.begin(), shown->given_hashes.end(), 0);
  want_all(*shown);
}

// The soft structures; their vertices are render::SkinVertex. nullptr: that was all.
EMSCRIPTEN_KEEPALIVE const Given* core_soft() {
  ShownBone& c = *shown;
  if (c.soft.materials.empty()) {
    NoProgress quiet;
    static_cast<void>(render::add_soft(c.soft, *c.bone, quiet));
  }
  if (c.soft_given == c.soft.soft.size()) return nullptr;
  const render::SoftStructure& one = c.soft.soft[c.soft_given++];
  const auto& triangles = one.mesh->levels.front().indices;
  c.given = {one.tissue, one.mesh->vertices.data(), one.mesh->vertices.size(), triangles.data(),
             triangles.size()};
  return &c.given;
}

EMSCRIPTEN_KEEPALIVE double core_voxel_mm() { return shown->voxel_mm; }

// The row of the last tick, tick::TickRow.
EMSCRIPTEN_KEEPALIVE const void* core_row() { return &shown->row; }
EMSCRIPTEN_KEEPALIVE int core_row_size() { return sizeof(tick::TickRow); }

// Of a tissue of the bone: its kind (volume::TissueKind), colour, and how much it bleeds. nullptr: there is
// no tissue of this number. Its name: core_tissue_name().
EMSCRIPTEN_KEEPALIVE const double* core_tissue(int number) {
  static double out[5];
  const auto& tissues = shown->bone->tissues().tissues;
  if (static_cast<std::size_t>(number) >= tissues.size()) return nullptr;
  const volume::Tissue& tissue = tissues[static_cast<std::size_t>(number)];
  out[0] = static_cast<double>(tissue.kind);
  std::copy(tissue.colour.begin(), tissue.colour.end(), out + 1);
  out[4] = tissue.bleeds;
  return out;
}
EMSCRIPTEN_KEEPALIVE const char* core_tissue_name(int number) {
  return shown->bone->tissues().tissues[static_cast<std::size_t>(number)].name.c_str();
}

// "tick hash, hash of the bone", in hexadecimal
EMSCRIPTEN_KEEPALIVE const char* core_hashes() {
  static char text[40];
  std::snprintf(text, sizeof text, "%016llx %016llx",
                static_cast<unsigned long long>(shown->row.hash),
                static_cast<unsigned long long>(shown->bone->content_hash()));
  return text;
}

}  // extern "C"

}  // namespace burr::web
