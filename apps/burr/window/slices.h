// apps/burr/window/slices.h - three slices through the tip of the burr, in a column at the right of
// the picture: the bone as it is now, its labels over it, and the burr as a ring.
//
// One of them is drawn anew in a frame, each ten times a second at most: they cost little where the
// processor draws.
// Thread: main. Frame: world. Units: m.
#pragma once

#include <array>
#include <chrono>

#include "burr/render/scene.h"
#include "burr/render/slice.h"
#include "window/ui.h"

namespace burr::app {

class Slices {
 public:
  // Before the session starts: adds a watcher.
  explicit Slices(volume::Bone& bone) : slicer_(bone) {}

  // Into the scene's insets, which are replaced; none when not `shown`. width, height: of the
  // window's drawing area; bottom: of it that is left free [pixel].
  void update(render::Scene& scene, bool shown, bool labels, int width, int height, int bottom);

  // Over them, within a frame of ImGui.
  static void write_names(const render::Scene& scene, const Ui& ui);

  // Higher or lower: how much is seen, in steps of a quarter.
  void zoom(int steps);

 private:
  using Clock = std::chrono::steady_clock;
  render::Slicer slicer_;
  double height_ = 40e-3;  // of what a slice shows
  std::size_t next_ = 0;
  std::array<std::shared_ptr<const render::Image>, 3> images_;
  std::array<Clock::time_point, 3> drawn_ = {};
};

}  // namespace burr::app
