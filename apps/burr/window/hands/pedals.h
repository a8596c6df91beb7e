// apps/burr/window/hands/pedals.h - foot pedals: joysticks that are not game controllers.
//
// The first axis, or a button, mills. Other buttons change burr and tool, switch the coolant and lift a
// haptic device. The settings say which button does what, because pedals differ. A milling pedal
// that was down when it was plugged in mills only after it has been seen released (as in
// gamepad.h). A joystick with more than three axes, or one that reports itself as a steering wheel
// or another such device, is not taken for a pedal. Thread: main.
#pragma once

#include <SDL2/SDL.h>

#include <vector>

namespace burr::app {

// Numbers of the buttons, from 0.
struct PedalMap {
  int mill = 0, burr = 1, coolant = 2, clutch = 3;
  int rest = -1;  // value of the axis with no foot on it: -1, 0 or 1
  int tool = 4;   // the next tool of the rack
};

class Pedals {
 public:
  enum class Step { none, burr, coolant, tool };

  Pedals();
  Pedals(const Pedals&) = delete;
  Pedals& operator=(const Pedals&) = delete;
  ~Pedals();

  void scan();
  [[nodiscard]] int count() const { return static_cast<int>(pedals_.size()); }
  // How far the milling pedal is pressed  [0..1].
  [[nodiscard]] double now(const PedalMap& map);
  // The clutch is down: the hand of a haptic device may be moved without moving the burr.
  [[nodiscard]] bool clutched(const PedalMap& map) const;
  // The step that this event requests, if it is a pedal's button going down.
  [[nodiscard]] Step step(const SDL_Event& event, const PedalMap& map) const;
  void disarm() { armed_ = false; }

 private:
  std::vector<SDL_Joystick*> pedals_;
  bool started_ = false, armed_ = false;
};

}  // namespace burr::app
