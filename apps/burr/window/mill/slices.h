// apps/burr/window/mill/slices.h - three slices through the tip of the burr, in a column at the right of
// the picture: the bone as it is now, its labels over it, and the burr as a ring.
//
// One of them is drawn anew in a frame, each ten times a second at most: they cost little where the
// processor draws.
// Thread: main. Frame: world. Units: m.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "burr/render/scene.h"
#include "burr/render/slice.h"
#include "window/shell/ui.h"

namespace burr::app {

class Slices {
 public:
  // Before the session starts: adds a watcher. greys: what the scan measured; nullptr: there is
  // none.
  explicit Slices(volume::Bone& bone, std::shared_ptr<const volume::Greys> greys = nullptr);

  // Into the scene's insets, which are replaced; none when not `shown`. width, height: of the
  // window's drawing area; bottom: of it that is left free [pixel].
  void update(render::Scene& scene, bool shown, bool labels, int width, int height, int bottom);

  // Over them, within a frame of ImGui.
  void write_names(const render::Scene& scene, const Ui& ui) const;

  // Higher or lower: how much is seen, in steps of a quarter.
  void zoom(int steps);

  // ---- window and level of what the scan measured

  [[nodiscard]] bool has_greys() const { return greys_ != nullptr; }
  // The next of: bone as a model, the scan as one looks at bone, at soft tissue; said in words.
  std::string next_window();
  // As radiologists pull: to the right a wider window, up a higher level; in parts of a slice's
  // edge. From the model it goes to the scan.
  void pull_window(double right, double up);

 private:
  using Clock = std::chrono::steady_clock;
  render::Slicer slicer_;
  [[nodiscard]] std::string window_words() const;

  std::shared_ptr<const volume::Greys> greys_;
  std::size_t chosen_ = 0;            // of the windows; 0: the model
  double window_ = 4000, level_ = 0;  // as chosen, or pulled from there
  double height_ = 40e-3;             // of what a slice shows
  std::size_t next_ = 0;
  std::array<std::shared_ptr<const render::Image>, 3> images_;
  std::array<Clock::time_point, 3> drawn_ = {};
};

}  // namespace burr::app
