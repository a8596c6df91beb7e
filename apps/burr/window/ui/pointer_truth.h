// apps/burr/window/ui/pointer_truth.h - which buttons of the mouse are really down. When a button is
// pressed in the window and let go outside of it, SDL (2.26) still holds it for down. The next press is
// then no change for SDL, which drops it. This class asks the X server for the state of the buttons and
// adds the events that SDL did not report.
//
//     PointerTruth truth;
//     while (truth.next(event)) ...;   // in place of SDL_PollEvent()
//
// It asks after each change of focus or visibility. While SDL holds a button for down that is up, it asks
// once for each picture. Where there is no X server (Wayland, no screen), SDL's events are used as they
// are. Thread: main.
#pragma once

#include <SDL2/SDL.h>

#include <deque>

namespace burr::app {

class PointerTruth {
 public:
  // False: there is no event now.
  [[nodiscard]] bool next(SDL_Event& event);

 private:
  void look();  // after a change of focus
  void look_for_presses();
  void add(Uint8 button, bool down);
  void correct(const SDL_Event& event);

  std::deque<SDL_Event> events_;  // to be handed out
  Uint32 swallowed_ = 0;          // buttons that SDL believes are down and that are up: mask
  bool asks_ = false;             // look at the end of this picture's events
};

}  // namespace burr::app
