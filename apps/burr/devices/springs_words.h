// apps/burr/devices/springs_words.h - what a device can do about the torque of a contact, in plain
// sentences.
#pragma once

#include <string>
#include <vector>

#include "burr/device/hand_state.h"

namespace burr::app {

// The springs that a contact gets on this device (haptics/safety/coupling.h), and what is missing.
[[nodiscard]] std::vector<std::string> springs_words(const device::DeviceSpec& spec);

}  // namespace burr::app
