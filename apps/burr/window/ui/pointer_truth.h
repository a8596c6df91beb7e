// apps/burr/window/ui/pointer_truth.h - which buttons of the mouse are really down. A button that was
// pressed in the window and let go outside of it stays down for SDL (2.26), which then swallows the next
// press as no change. So the pointer itself is asked, and what SDL does not report is added to its events.
//
//     PointerTruth truth;
//     while (truth.next(event)) ...;   // in place of SDL_PollEvent()
//
// The pointer is asked after each change of focus or visibility, and, as long as SDL believes in a button
// that is up, once for each picture. Where the system does not tell (Wayland, without a screen), SDL is
// believed. Thread: main.
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
