// apps/burr/doctor/doctor_checks.h - the checks of the doctor, one function for each part of the computer.
//
// Nothing is changed and nothing moves. Thread: main. `System` says where to look, so that tests
// can make a computer out of files.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "doctor/finding.h"

namespace burr::app {

struct System {
  std::filesystem::path root = "/";                 // folder that contains sys, dev and etc
  std::chrono::milliseconds maker_timeout{10'000};  // time limit for a maker's library
  std::function<bool(const std::filesystem::path&)>
      may_use;  // read and write; empty: as the kernel says
};

// Haptic devices: library or service, then the device itself; each in a process of its own.
[[nodiscard]] std::vector<Finding> look_at_devices(const System& system);
// Their USB nodes: whether they are plugged in, and whether this user may open them.
[[nodiscard]] std::vector<Finding> look_at_nodes(const System& system);
// Gamepads, pedals, SpaceMouse.
[[nodiscard]] std::vector<Finding> look_at_pads(const System& system);
// Priority, memory, kernel, clock, frequency.
[[nodiscard]] std::vector<Finding> look_at_machine(const System& system);
// OpenGL, display, loudspeaker.
[[nodiscard]] std::vector<Finding> look_at_screen(const System& system);

// The wanted content of /etc/udev/rules.d/70-burr.rules.
[[nodiscard]] std::string udev_rules();
[[nodiscard]] std::filesystem::path udev_file(const System& system);

}  // namespace burr::app
