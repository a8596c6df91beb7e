// apps/burr/window/hands/gamepad.h - game controllers through SDL. They may be plugged in and out
// at any time. Sticks and triggers get a dead zone and a gentle start.
//
//     pads.scan();                         // at the start, and when something was plugged
//     const PadSticks now = pads.now(0.15);
//
// The press (right trigger or A) counts only after both have been seen released. So nothing is
// milled by what was held down while the pad was plugged in, while a page was open, or while
// another window had the keyboard. Several pads count as one. Thread: main. Units: 1 is a stick or
// trigger moved all the way.
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

// The part of an axis value (-32768..32767) beyond the dead zone, squared, so that it starts
// gently; -1..1. dead: the dead zone, a share of the full way. 0 at rest and for a value that is
// not a number.
[[nodiscard]] double beyond_dead(double axis, double dead);
// The same for a stick, whose dead zone is round: right and up together.
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
  // Ignores the press until trigger and A have been released.
  void disarm() { armed_ = false; }

 private:
  std::vector<SDL_GameController*> pads_;
  bool started_ = false, armed_ = false;
};

// A pad was plugged in or out: call scan().
[[nodiscard]] bool is_plug_event(const SDL_Event& event);

// For pages that are used with the keyboard: turns the event of a pad's button into the event of
// the key with the same meaning. false: the button has none; `event` is unchanged.
bool as_key(SDL_Event& event);

}  // namespace burr::app
