// apps/burr/window/mill/hand_plane.h - a plane in which the hand moves with the mouse, instead of
// following the bone. It is perpendicular to the view; the wheel changes its depth. It is drawn as
// a few crossed lines.
//
//     G: begin(where the hand is)    mouse: meet(ray)    wheel: push(1 mm)    each picture: show()
//
// The plane turns with the view, about the hand. Thread: main. Frame: world. Units: SI.
#pragma once

#include "burr/render/camera.h"
#include "burr/render/scene.h"

namespace burr::app {

class HandPlane {
 public:
  void begin(const math::Vec3& hand) {
    on_ = true;
    at_ = hand;
  }
  void end() { on_ = false; }
  [[nodiscard]] bool on() const { return on_; }

  // Moves the plane away from the eye [m]; below 0: towards it.
  void push(double by, const render::Camera& camera) { at_ -= by * camera.backward(); }

  // Position of the hand: where the ray meets the plane. If it does not, the hand stays where it
  // was.
  math::Vec3 meet(const render::Ray& ray, const render::Camera& camera);

  // Draws the lines at the hand, or removes them.
  void show(render::Scene& scene);

 private:
  bool on_ = false;
  math::Vec3 at_ = math::Vec3::Zero();
  double shown_ = 0;  // radius of the lines in the scene [m]
};

}  // namespace burr::app
