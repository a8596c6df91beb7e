// apps/burr/devices/trial.h - a haptic device tried without bone: what it says at rest, whether its
// axes are where they should be, and how a wall feels on it.
//
//     rest (nothing is pushed) -> right, up, to you -> a wall below, pressed a few times
//
// Each part waits for the person to do what `tell` says and goes on by itself; a part that is not
// done in time is left out and named. The wall passes the safety layer of every session
// (haptics/safety/limit.h). Thread: the caller's, with one of its own for the ticks. Units: SI.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "burr/device/device.h"

namespace burr::app {

struct TrialSettings {
  double rest_s = 3;       // measured at rest
  double longest_s = 20;   // that a part waits for the person
  double way = 25e-3;      // to go along each axis                  [m]
  double below = 10e-3;    // of the hand, where the wall begins     [m]
  double stiffness = 300;  // of the wall, at most the device's      [N/m]
  double most_force = 2;   // at most the device's                   [N]
  int presses = 3;
};

struct AxisSeen {
  std::string asked;  // "right"
  bool done = false;
  math::Vec3 went = math::Vec3::Zero();  // in the frame of device/mapping.h [m]
  double off_deg = 0;                    // from where it should have gone
};

struct TrialSeen {
  device::DeviceSpec spec;
  // at rest
  double rate_hz = 0;
  double interval_p50_us = 0, interval_p99_us = 0, interval_max_us = 0;
  std::uint64_t ticks = 0, missed = 0, invalid = 0;
  math::Vec3 noise = math::Vec3::Zero();  // standard deviation of the place, each axis [m]
  double speed_noise = 0;                 // of the velocity it tells, root mean square [m/s]
  // all the time: from a reading's arrival to its force handed over, without the wire
  double answer_p50_us = 0, answer_p99_us = 0, answer_max_us = 0;
  std::array<AxisSeen, 3> axes;
  // the wall
  int presses = 0;
  double deepest = 0;     // [m]
  double most_force = 0;  // [N]
  double stiffness = 0;   // fitted over the presses [N/m]
  double aside_deg = 0;   // largest angle between the hand's way back and the wall's normal
  std::vector<std::string> left_out;  // sentences
  bool stopped = false;               // by the user
};

// The device is open. tell: what the person is to do now; stop: asked often.
[[nodiscard]] TrialSeen try_device(device::Device& device, const TrialSettings& settings,
                                   const std::function<void(const std::string&)>& tell,
                                   const std::function<bool()>& stop);

// One page that can be sent to a colleague, and the same for a terminal.
[[nodiscard]] std::string trial_page(const TrialSeen& seen);
[[nodiscard]] std::string trial_text(const TrialSeen& seen);
[[nodiscard]] std::string trial_json(const TrialSeen& seen);

}  // namespace burr::app
