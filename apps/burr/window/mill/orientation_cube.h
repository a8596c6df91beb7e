// apps/burr/window/mill/orientation_cube.h - a cube that turns with the view, with the patient's
// directions on its faces: L R A P S I. A click on a face turns the view to look at it.
//
// Thread: main. Frame: world (LPS).
#pragma once

#include <array>
#include <chrono>
#include <optional>

#include "burr/render/camera.h"
#include "window/ui/ui.h"

namespace burr::app {

struct CubeFace {
  char letter;
  std::array<double, 3> out;  // unit, world
  double azimuth, elevation;  // of a camera that looks at it [rad]
};
[[nodiscard]] const std::array<CubeFace, 6>& cube_faces();

// Draws the cube with its right edge at x and its top at y; the face that was pressed, if any. It is
// a panel: the mouse does not mill there.
[[nodiscard]] const CubeFace* draw_cube(Ui& ui, const render::Camera& camera, float x, float y);
// Edge of its panel [points].
inline constexpr float kCube = 92;

// The view turns there within a third of a second, so that the user keeps the orientation.
class ViewTurn {
 public:
  using Clock = std::chrono::steady_clock;
  void begin(const render::Camera& from, const CubeFace& to, Clock::time_point now);
  void stop() { running_ = false; }
  void step(render::Camera& camera, Clock::time_point now);

 private:
  bool running_ = false;
  double azimuth_ = 0, elevation_ = 0, azimuth_by_ = 0,
         elevation_by_ = 0;  // at the start, by [rad]
  Clock::time_point begun_;
};

}  // namespace burr::app
