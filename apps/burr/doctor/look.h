// apps/burr/doctor/look.h - what the doctor looks at, one function a part of the computer.
//
// Nothing is changed and nothing moves. Thread: main. `System` names where to look, so that tests
// can build a computer of files.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "doctor/finding.h"

namespace burr::app {

struct System {
  std::filesystem::path root = "/";            // where sys, dev and etc lie
  std::chrono::milliseconds patience{10'000};  // with a maker's library
  std::function<bool(const std::filesystem::path&)>
      may_use;  // read and write; empty: as the kernel says
};

// Haptic devices: library or service, then the device itself; each in a process of its own.
[[nodiscard]] std::vector<Finding> look_at_devices(const System& system);
// Their USB nodes: plugged in, and allowed to this user.
[[nodiscard]] std::vector<Finding> look_at_nodes(const System& system);
// Gamepads, pedals, SpaceMouse.
[[nodiscard]] std::vector<Finding> look_at_pads(const System& system);
// Priority, memory, kernel, clock, frequency.
[[nodiscard]] std::vector<Finding> look_at_machine(const System& system);
// OpenGL, display, loudspeaker.
[[nodiscard]] std::vector<Finding> look_at_screen(const System& system);

// What /etc/udev/rules.d/70-burr.rules is to hold.
[[nodiscard]] std::string udev_rules();
[[nodiscard]] std::filesystem::path udev_file(const System& system);

}  // namespace burr::app
