// apps/burr/window/mill/pointer.h - the point over the picture where the hand is aimed: the mouse's, or the
// ring that a gamepad, SpaceMouse or arrows move in its place.
//
// Thread: main. Units: pixels of the window.
#pragma once

#include "burr/render/pick.h"
#include "burr/render/scene.h"
#include "window/shell/desk.h"

namespace burr::app {

class Pointer {
 public:
  Pointer(Desk& desk, const render::Scene& scene) : desk_(desk), scene_(scene) {}

  void begin();  // where the mouse is, before it moves
  void measure_window();
  // The mouse moved: it leads.
  void moved_to(int x, int y);
  void mouse_leads();
  // A pad leads: from where the mouse was, unless it was nowhere.
  void lead();
  // heights of the picture; one way at a time, so that it slides along panels instead of sticking
  void move(double right, double up);

  [[nodiscard]] bool pad_leads() const { return leads_; }
  // while a pad leads, the mouse may lie where it was left
  [[nodiscard]] bool over_panel() const { return !leads_ && desk_.ui().over_panel(); }
  [[nodiscard]] bool over_slices() const;
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] render::Ray aim() const { return ray(aim_x_, aim_y_); }
  [[nodiscard]] render::Ray mouse() const { return ray(mouse_x_, mouse_y_); }

  // The ring of the pad, a dot in it while it presses.
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
  int aim_x_ = 0, aim_y_ = 0;  // where the mouse was last that was no slice
  bool leads_ = false, mouse_moved_ = false;
  double pad_x_ = 0, pad_y_ = 0;
};

}  // namespace burr::app
