// apps/burr/window/mill/hand_plane.h - the plane a mouse's hand goes in when it does not follow the
// bone: square to the look, as deep as the wheel has moved it, drawn as a few crossed lines.
//
//     G: begin(where the hand is)    mouse: meet(ray)    wheel: push(1 mm)    each picture: show()
//
// Turning the view turns it about the hand. Thread: main. Frame: world. Units: SI.
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

  // Away from the eye [m]; below 0: nearer.
  void push(double by, const render::Camera& camera) { at_ -= by * camera.backward(); }

  // Where the hand is then: on the ray; where it was, for one that goes past.
  math::Vec3 meet(const render::Ray& ray, const render::Camera& camera);

  // Lines about the hand, or none.
  void show(render::Scene& scene);

 private:
  bool on_ = false;
  math::Vec3 at_ = math::Vec3::Zero();
  double shown_ = 0;  // radius of the lines that are in the scene [m]
};

}  // namespace burr::app
