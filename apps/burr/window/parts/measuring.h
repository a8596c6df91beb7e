// apps/burr/window/parts/measuring.h - measures distance, angle and thickness on the bone as it is
// now, and draws them over the picture. It changes nothing.
//
//     measuring.next();                                   // distance, angle, thickness, off
//     if (measuring.picks()) measuring.pick(hit->p);      // a click
//     measuring.probe(bone, tip, inward, reach);          // each picture, for the thickness
//     measuring.draw(ui, scene.camera);
//
// Thread: main. Frame: world. Units: m, rad; the user reads mm and degrees.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/render/camera.h"
#include "burr/volume/thickness.h"
#include "window/ui/ui.h"

namespace burr::app {

enum class Measure { off, distance, angle, thickness };

class Measuring {
 public:
  void next();
  void stop() { *this = {}; }
  [[nodiscard]] Measure what() const { return what_; }
  [[nodiscard]] bool on() const { return what_ != Measure::off; }
  // The mouse picks points and does not mill.
  [[nodiscard]] bool picks() const { return points_wanted() > 0; }

  // Adds a point on the surface; after the last one it starts again.
  void pick(const math::Vec3& p);
  // Measures the thickness from the middle of the burr into the bone. inward: unit vector.
  void probe(const volume::Bone& bone, const math::Vec3& tip, const math::Vec3& inward,
             double reach);

  // The length [m] or the angle [rad], when it is known.
  [[nodiscard]] std::optional<double> value() const;
  // Text for the user: the result, or what to do next; "" when off.
  [[nodiscard]] std::string words() const;

  // Draws behind the panels; call it within a frame of ImGui.
  void draw(const Ui& ui, const render::Camera& camera) const;

 private:
  [[nodiscard]] std::size_t points_wanted() const {
    return what_ == Measure::distance ? 2 : what_ == Measure::angle ? 3 : 0;
  }
  Measure what_ = Measure::off;
  std::vector<math::Vec3> points_;  // for an angle the second is its vertex
  std::optional<volume::Span> span_;
};

// Where a point of the world is in a picture of width x height; none if it is behind the eye. The
// inverse of render::ray_through().
[[nodiscard]] std::optional<ImVec2> on_picture(const render::Camera& camera, const math::Vec3& p,
                                               float width, float height);

}  // namespace burr::app
