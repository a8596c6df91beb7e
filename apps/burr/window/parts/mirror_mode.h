// apps/burr/window/parts/mirror_mode.h - the mirror across which the user mills: its plane, as text
// and in the picture. The same while milling and while a recording is played.
//
// Thread: main. Frame: world.
#pragma once

#include <string>

#include "burr/edit/mirror.h"
#include "burr/render/scene.h"
#include "burr/tick/mirror_plane.h"

namespace burr::app {

class MirrorMode {
 public:
  explicit MirrorMode(const volume::Grid& grid)
      : grid_(grid), plane_(tick::mirror_plane(grid, tick::Plane::sagittal)) {}

  void toggle() { on_ = !on_; }
  void place_at(const math::Vec3& p);  // switches it on, same direction, through p
  void next_plane();                   // switches it on, next direction, through the middle
  [[nodiscard]] edit::Mirror now() const { return on_ ? plane_ : edit::Mirror{}; }

 private:
  volume::Grid grid_;
  edit::Mirror plane_;
  bool on_ = false;
};

// "mirror: sagittal, 3.5 mm left of the middle", or that it is off
[[nodiscard]] std::string mirror_words(const volume::Grid& grid, const edit::Mirror& mirror);

// Draws the outlines of the plane and of the mirrored burr, or removes both.
void show_mirror(render::Scene& scene, const volume::Grid& grid, const edit::Mirror& mirror);

}  // namespace burr::app
