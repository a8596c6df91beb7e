// apps/burr/shared/hand_options.h - the options that choose a haptic device.
#pragma once

#include "burr/workshop/hand_device.h"

namespace CLI {
class App;
}

namespace burr::app {

// --home, --is-homed
void add_homing_options(CLI::App& command, workshop::HandRequest& request);
// The same, and --device with all that goes with it.
void add_hand_options(CLI::App& command, workshop::HandRequest& request);

}  // namespace burr::app
