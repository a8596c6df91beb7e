// apps/burr/window/mill/press.h - the press of a hand that measures no force (button, space bar,
// trigger, pedal): its depth, and the speed of the spindle.
//
// Plain state without events: mill_hand.cpp sets it. Thread: main. Units: m;
// shares 0..1.
#pragma once

#include <algorithm>

namespace burr::app {

class Press {
 public:
  static constexpr double kLeast = 0.2e-3;  // depth of the arm's target below the surface  [m]
  static constexpr double kMost = 6e-3;

  void begin_at(double depth) { full_ = std::clamp(depth, kLeast, kMost); }
  void deepen(double factor) { begin_at(full_ * factor); }

  void button(bool down) { button_ = down; }
  void toggle_hold() { held_ = !held_; }
  // from a trigger or a SpaceMouse: share of the full depth
  void trigger(double share) { trigger_ = share; }
  void pedal(double foot, double slowed) {
    foot_ = foot;
    slowed_ = slowed;
  }
  // Call it in each picture before the gamepad and the pedals are read.
  void rest_pads() { trigger_ = foot_ = 0; }
  void lift() {
    button_ = held_ = false;
    rest_pads();
  }

  [[nodiscard]] bool on() const { return button_ || held_ || trigger_ > 0 || foot_ > 0; }
  // while a pad presses, the mouse does not move the point
  [[nodiscard]] bool by_pad() const { return trigger_ > 0 || held_; }
  [[nodiscard]] double full() const { return full_; }
  [[nodiscard]] double depth() const {
    const double share = button_ || held_ || foot_ > 0 ? 1 : trigger_;
    return kLeast + share * (full_ - kLeast);
  }
  // share of the spindle's full speed
  [[nodiscard]] double spindle() const {
    return (button_ || held_ || trigger_ > 0 ? 1 : foot_) * (1 - slowed_);
  }
  // the same for a haptic device, which presses with space bar and pedal only
  [[nodiscard]] double spindle_of_device() const { return (held_ ? 1 : foot_) * (1 - slowed_); }

 private:
  bool button_ = false, held_ = false;
  double full_ = 4e-3;
  double trigger_ = 0, foot_ = 0, slowed_ = 0;
};

}  // namespace burr::app
