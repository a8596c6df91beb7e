// apps/burr/window/mill/pointer.h - the point in the picture at which the hand is aimed: the
// mouse's, or a ring that a gamepad, a SpaceMouse or the arrow keys move instead.
//
// Thread: main. Units: pixels of the window.
#pragma once

#include "burr/render/pick.h"
#include "burr/render/scene.h"
#include "window/ui/desk.h"

namespace burr::app {

class Pointer {
 public:
  Pointer(Desk& desk, const render::Scene& scene) : desk_(desk), scene_(scene) {}

  void begin();  // takes the mouse's position, before it moves
  void measure_window();
  // The mouse moved: from now on the mouse moves the point.
  void moved_to(int x, int y);
  void mouse_leads();
  // From now on a pad moves the point. It starts where the mouse was, or in the middle if the mouse
  // has not moved or was outside or on a panel.
  void lead();
  // in heights of the picture; each direction on its own, so that the point slides along panels and
  // does not stick
  void move(double right, double up);

  [[nodiscard]] bool pad_leads() const { return leads_; }
  // while a pad moves the point, the mouse may lie over a panel
  [[nodiscard]] bool over_panel() const { return !leads_ && desk_.ui().over_panel(); }
  [[nodiscard]] bool over_slices() const;
  [[nodiscard]] int height() const { return height_; }
  // The mouse's position in the picture [pixel of the drawing area].
  [[nodiscard]] Eigen::Vector2d in_picture() const;
  [[nodiscard]] render::Ray aim() const { return ray(aim_x_, aim_y_); }
  [[nodiscard]] render::Ray mouse() const { return ray(mouse_x_, mouse_y_); }

  // Draws the ring of the pad, with a dot in it while it presses.
  void draw(bool pressing) const;

 private:
  [[nodiscard]] render::Ray ray(int x, int y) const {
    return render::ray_through(scene_.camera, x + 0.5, y + 0.5, width_, height_);
  }
  void aim_at_mouse() {
    aim_x_ = mouse_x_;
    aim_y_ = mouse_y_;
  }
  void step_to(double x, double y);

  Desk& desk_;
  const render::Scene& scene_;
  int mouse_x_ = 0, mouse_y_ = 0, width_ = 1, height_ = 1;
  int aim_x_ = 0, aim_y_ = 0;  // last position of the mouse outside the slices
  bool leads_ = false, mouse_moved_ = false;
  double pad_x_ = 0, pad_y_ = 0;
};

}  // namespace burr::app
