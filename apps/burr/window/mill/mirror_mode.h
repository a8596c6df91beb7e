// apps/burr/window/mill/mirror_mode.h - the mirror one sculpts with: which plane, in words and in the
// picture; the same while milling and while watching.
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
  void place_at(const math::Vec3& p);  // on, the same way, through p
  void next_plane();                   // on, the next way, through the middle
  [[nodiscard]] edit::Mirror now() const { return on_ ? plane_ : edit::Mirror{}; }

 private:
  volume::Grid grid_;
  edit::Mirror plane_;
  bool on_ = false;
};

// "mirror: sagittal, 3.5 mm left of the middle"; that it is off
[[nodiscard]] std::string mirror_words(const volume::Grid& grid, const edit::Mirror& mirror);

// Outlines of the plane and of the burr's image, or neither.
void show_mirror(render::Scene& scene, const volume::Grid& grid, const edit::Mirror& mirror);

}  // namespace burr::app
