// apps/burr/window/hands/pedals.h - pedals under the desk: joysticks that are no game controllers.
//
// The first axis, or a button, mills; buttons change the burr, let the coolant run, and lift a
// haptic device. Which is which stands in the settings, since no two pedals agree. As with
// gamepad.h, what was held down when the pedal came mills only after it was let go. What has more
// than three axes, or is a steering wheel or the like by its own word, is no pedal. Thread: main.
#pragma once

#include <SDL2/SDL.h>

#include <vector>

namespace burr::app {

// Buttons by their number from 0.
struct PedalMap {
  int mill = 0, burr = 1, coolant = 2, clutch = 3;
  int rest = -1;  // where the axis is while no foot is on it: -1, 0 or 1
};

class Pedals {
 public:
  enum class Step { none, burr, coolant };

  Pedals();
  Pedals(const Pedals&) = delete;
  Pedals& operator=(const Pedals&) = delete;
  ~Pedals();

  void scan();
  [[nodiscard]] int count() const { return static_cast<int>(pedals_.size()); }
  // How far down the milling pedal is  [0..1].
  [[nodiscard]] double now(const PedalMap& map);
  // The clutch is down: a haptic device is lifted to be laid elsewhere.
  [[nodiscard]] bool clutched(const PedalMap& map) const;
  // What a button of a pedal asks for once, when it goes down.
  [[nodiscard]] Step step(const SDL_Event& event, const PedalMap& map) const;
  void disarm() { armed_ = false; }

 private:
  std::vector<SDL_Joystick*> pedals_;
  bool started_ = false, armed_ = false;
};

}  // namespace burr::app
