// apps/burr/window/hands/gamepad.h - game controllers as SDL knows them: plugged in and out at any time,
// their sticks and triggers calmed, their buttons named.
//
//     pads.scan();                         // at the start, and when something was plugged
//     const PadSticks now = pads.now(0.15);
//
// Nothing presses that was not seen let go first: not what was held while it was plugged in, while
// a page was open, or while another window had the keyboard. Several pads count as one. Thread:
// main. Units: 1 is a stick or trigger all the way.
#pragma once

#include <SDL2/SDL.h>

#include <vector>

namespace burr::app {

struct PadSticks {
  double aim_right = 0, aim_up = 0;    // left stick   [-1..1]
  double turn_right = 0, turn_up = 0;  // right stick  [-1..1]
  double press = 0;                    // right trigger, or 1 while A is down  [0..1]
  double slow = 0;                     // left trigger                         [0..1]
  bool lifts = false;                  // B is down
};

// What an axis of -32768..32767 says beyond `dead`, a share of it; begins gently. -1..1, and 0 at
// rest whatever is wrong with the numbers.
[[nodiscard]] double beyond_dead(double axis, double dead);
// The same for a stick, whose dead zone is round.
void calm_stick(double& right, double& up, double dead);

class Gamepads {
 public:
  Gamepads();
  Gamepads(const Gamepads&) = delete;
  Gamepads& operator=(const Gamepads&) = delete;
  ~Gamepads();

  void scan();
  [[nodiscard]] int count() const { return static_cast<int>(pads_.size()); }
  [[nodiscard]] PadSticks now(double dead);
  // Nothing presses until all was let go.
  void disarm() { armed_ = false; }

 private:
  std::vector<SDL_GameController*> pads_;
  bool started_ = false, armed_ = false;
};

// Something was plugged in or out: scan().
[[nodiscard]] bool plugs(const SDL_Event& event);

// For pages that are walked through by keyboard: the key that a pad's button stands for there;
// false: none. `event` becomes that key's.
bool as_key(SDL_Event& event);

}  // namespace burr::app
