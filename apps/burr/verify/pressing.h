// apps/burr/verify/pressing.h - a whole session in which a simulated hand presses a burr on bone and waits: a closed loop of
// hand, law, limits and cut. What gives the hand energy shows here.
//
// Thread: one. Units: SI.
#pragma once

#include <memory>

#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/tick/own_law.h"
#include "burr/tick/settings.h"

namespace burr::app {

// Whole sessions: a hand presses and waits. The energy that it gave is summed as -F dx, with the
// force that was held during each tick.
struct Pressing {
  const char* name;
  phantom::Depth bone;
  double radius = 2e-3;
  tick::ToolMode mode = tick::ToolMode::touch;
  double stiffness = 1000;
  device::ArmSettings arm = {.mass = 0.06, .damping = 5, .stiffness = 200};
  bool guarded = false;
  double drag = 1;
  std::shared_ptr<tick::OwnLaw> law = nullptr;
};
struct Lasting {
  double least = 0, energy = 0;  // lowest value during the run, and value at its end [J]
  double ripple = 0;  // standard deviation of the force in the last second, over its mean
  double force = 0;   // mean of the force in the last second [N]
  bool ok = false;
  bool law_off = false;  // the custom law was switched off
};
[[nodiscard]] Lasting last(const Pressing& one, double seconds);

}  // namespace burr::app
