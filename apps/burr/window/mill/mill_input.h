// apps/burr/window/mill/mill_input.h - takes what the window reports of mouse, keyboard, gamepad and
// pedals on the page for milling, and passes it on: to the hand, the view, the table of keys.
//
// It decides what an event is for: a click on a panel does not mill, a drag on a slice changes its
// window. Thread: main, outside a frame of ImGui.
#pragma once

#include <SDL2/SDL.h>

#include <cstdint>
#include <optional>

#include "window/mill/mill_actions.h"
#include "window/mill/mill_parts.h"
#include "window/mill/mill_site.h"

namespace burr::app {

class MillInput {
 public:
  MillInput(const MillSite& site, MillParts& parts, MillActions& actions)
      : desk_(site.desk),
        scene_(site.scene),
        notes_(site.notes),
        over_(site.over),
        parts_(parts),
        actions_(actions) {}

  // All events that have come since the last picture.
  void take_events();

 private:
  void take(const SDL_Event& event);
  void key_down(const SDL_KeyboardEvent& key);
  void key_up(const SDL_KeyboardEvent& key);
  void window(const SDL_WindowEvent& event);
  void move(const SDL_MouseMotionEvent& motion);
  void button(const SDL_MouseButtonEvent& button);
  void wheel(const SDL_MouseWheelEvent& wheel);
  void pad_button(Uint8 button);
  void pedal_button(const SDL_Event& event);

  Desk& desk_;
  render::Scene& scene_;
  MillNotes& notes_;
  MillOver& over_;
  MillParts& parts_;
  MillActions& actions_;
  std::optional<std::uint32_t> to_front_;  // when the window came to the front, in SDL's time [ms]
  bool pulls_window_ = false;              // the drag that is under way began on a slice
};

}  // namespace burr::app
