#include "window/parts/mirror_mode.h"

#include <algorithm>
#include <cmath>

#include "shared/word_names.h"

namespace burr::app {

using math::Vec3;

void MirrorMode::place_at(const Vec3& p) {
  plane_ = tick::mirror_plane(grid_, tick::plane_of(grid_, plane_.axis), p);
  on_ = true;
}

void MirrorMode::next_plane() {
  const int next = (static_cast<int>(tick::plane_of(grid_, plane_.axis)) + 1) % tick::kPlanes;
  plane_ = tick::mirror_plane(grid_, static_cast<tick::Plane>(next));
  on_ = true;
}

std::string mirror_words(const volume::Grid& grid, const edit::Mirror& mirror) {
  if (!mirror.on()) return word(Word::mirror_off);
  constexpr Word kNames[] = {Word::sagittal, Word::coronal, Word::axial};
  constexpr Word kNamesOfSides[][2] = {{Word::mirror_right, Word::mirror_left},
                                       {Word::mirror_front, Word::mirror_back},
                                       {Word::mirror_below, Word::mirror_above}};
  const auto plane = static_cast<std::size_t>(tick::plane_of(grid, mirror.axis));
  const double off = tick::offset_of(grid, mirror);
  if (std::abs(off) < 0.05e-3) return say(Word::mirror_middle, word(kNames[plane]));
  return say(kNamesOfSides[plane][off > 0 ? 1 : 0], word(kNames[plane]), 1e3 * std::abs(off));
}

void show_mirror(render::Scene& scene, const volume::Grid& grid, const edit::Mirror& mirror) {
  if (!mirror.on()) {
    scene.mirrored.reset();
    return;
  }
  render::Mirrored seen;
  seen.world_from_tool = tick::image_of(scene.burr.world_from_tool, grid, mirror);
  // the part of the plane that is in the picture, around the point that the camera looks at
  const Vec3 middle = grid.grid_from_world(scene.camera.target);
  const double reach = 0.42 * scene.camera.view_height() / grid.voxel;
  const int u = (mirror.axis + 1) % 3, v = (mirror.axis + 2) % 3;
  for (int corner = 0; corner < 4; ++corner) {
    Vec3 p = middle;
    p[mirror.axis] = mirror.place();
    p[u] += corner == 1 || corner == 2 ? reach : -reach;
    p[v] += corner >= 2 ? reach : -reach;
    for (const int axis : {u, v}) p[axis] = std::clamp(p[axis], 0.0, grid.size[axis] - 1.0);
    seen.corners[static_cast<std::size_t>(corner)] = grid.world_from_grid(p);
  }
  seen.line = 0.0018 * scene.camera.view_height();
  scene.mirrored = seen;
}

}  // namespace burr::app
