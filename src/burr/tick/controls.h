// tick/controls.h - what holds in a tick: the settings as commands have changed them.
//
// Thread: servo. Units: SI.
#pragma once

#include "burr/device/hand_state.h"
#include "burr/edit/mirror.h"
#include "burr/haptics/safety/coupling.h"
#include "burr/rt/rt.h"
#include "burr/tick/settings.h"
#include "burr/tick/shed.h"

namespace burr::tick {

// The springs of a contact on this device, at the stiffness that is set.
[[nodiscard]] inline haptics::Coupling coupling_of(const device::DeviceSpec& device,
                                                   const ServoSettings& settings) BURR_RT {
  return haptics::coupling_of(device, settings.force.stiffness, settings.rate_hz);
}

// What holds in this tick. The orders (orders.h) write it; the other parts of the servo read it.
struct Controls {
  ServoSettings settings;
  Shed shed = Shed::none;
  bool irrigated = false;    // coolant runs: for the worker that computes the heat
  edit::Mirror mirror = {};  // everything is done to the bone on its other side too
};

}  // namespace burr::tick
