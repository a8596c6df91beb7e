// apps/burr/window/parts/slices.h - three slices through the tip of the burr, in a column at the
// right of the picture: the bone as it is now, the labels over it, and the burr as a ring.
//
// In each frame at most one slice is drawn again, and each slice at most ten times a second: where
// the processor draws, this costs little. Thread: main. Frame: world. Units: m.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "burr/render/scene.h"
#include "burr/render/slice.h"
#include "window/ui/ui.h"

namespace burr::app {

class Slices {
 public:
  // Make it before the session starts, because it adds a watcher. greys: the values of the scan;
  // nullptr: there are none.
  explicit Slices(volume::Bone& bone, std::shared_ptr<const volume::Greys> greys = nullptr);

  // through: the point that the slices go through. Replaces the insets of the scene; removes them if not `shown`. width, height: of the window's
  // drawing area; bottom: height at its lower edge that stays free [pixel].
  void update(render::Scene& scene, const math::Vec3& through, bool shown, bool labels, int width,
              int height, int bottom);

  // The point of the bone at a position of the picture [pixel]; none: no slice is there.
  [[nodiscard]] std::optional<math::Vec3> point_at(const render::Scene& scene, double x,
                                                   double y) const;
  // Called for each slice after it was drawn, to paint on it; empty: nothing.
  using Paint = std::function<void(const render::Slice& slice, render::Image& image)>;
  void paint_with(Paint paint);

  // Writes the names over the slices, and the patient's directions at their sides; call it within a frame of ImGui.
  // from: x of the left edge of the scene's picture [pixel].
  void write_names(const render::Scene& scene, const Ui& ui, float from = 0) const;

  // Zooms by steps of a quarter; above 0: in.
  void zoom(int steps);

  // ---- window and level of the scan's values

  [[nodiscard]] bool has_greys() const { return greys_ != nullptr; }
  // Changes to the next of: bone as a model, the scan with the window for bone, for soft tissue.
  // Returns its name.
  std::string next_window();
  // Changes the window as in radiology: right makes it wider, up raises the level. In parts of a
  // slice's edge. From the model it changes to the scan.
  void pull_window(double right, double up);

 private:
  using Clock = std::chrono::steady_clock;
  render::Slicer slicer_;
  [[nodiscard]] std::string window_words() const;

  std::shared_ptr<const volume::Greys> greys_;
  Paint paint_;
  std::size_t chosen_ = 0;            // index of the window; 0: the model
  double window_ = 4000, level_ = 0;  // as chosen or changed
  double height_ = 40e-3;             // of the region that a slice shows
  std::size_t next_ = 0;
  std::array<std::shared_ptr<const render::Image>, 3> images_;
  std::array<Clock::time_point, 3> drawn_ = {};
  std::array<render::Slice, 3> shown_;  // as drawn last
};

}  // namespace burr::app
