// apps/burr/devices/trial.h - tries a haptic device without bone: its readings at rest, whether its
// axes point where they should, and how a wall feels.
//
//     rest (no force) -> right, up, to you -> a wall below, pressed a few times
//
// Each part waits for the person to do what `tell` says, and then goes on by itself; a part that is
// not done in time is left out and named. The force of the wall passes the safety layer of every
// session (haptics/safety/limit.h). Thread: the caller's, with one of its own for the ticks. Units:
// SI.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "burr/device/device.h"

namespace burr::app {

struct TrialSettings {
  double rest_s = 3;       // time of measurement at rest
  double longest_s = 20;   // longest wait for the person in each part [s]
  double way = 25e-3;      // distance to move along each axis [m]
  double below = 10e-3;    // depth below the hand at which the wall begins [m]
  double stiffness = 300;  // of the wall; limited to the device's [N/m]
  double most_force = 2;   // limited to the device's [N]
  int presses = 3;
};

struct AxisMeasurement {
  std::string asked;  // requested direction: "right"
  bool done = false;
  math::Vec3 went = math::Vec3::Zero();  // movement, in the frame of device/mapping.h [m]
  double off_deg = 0;                    // angle to the requested direction
};

struct TrialMeasurements {
  device::DeviceSpec spec;
  // at rest
  double rate_hz = 0;
  double interval_p50_us = 0, interval_p99_us = 0, interval_max_us = 0;
  std::uint64_t ticks = 0, missed = 0, invalid = 0;
  math::Vec3 noise = math::Vec3::Zero();  // standard deviation of the position on each axis [m]
  double speed_noise = 0;                 // of the velocity it reports, root mean square [m/s]
  // during all parts: from a reading's arrival until its force is given over, without the wire
  double answer_p50_us = 0, answer_p99_us = 0, answer_max_us = 0;
  std::array<AxisMeasurement, 3> axes;
  // the wall
  int presses = 0;
  double deepest = 0;     // [m]
  double most_force = 0;  // [N]
  double stiffness = 0;   // fitted over the presses [N/m]
  double aside_deg = 0;   // largest angle between the wall's normal and the hand's way back
  std::vector<std::string> left_out;  // sentences
  bool stopped = false;               // by the user
};

// The device must be open. tell: shows the person what to do now; stop: called often.
[[nodiscard]] TrialMeasurements try_device(device::Device& device, const TrialSettings& settings,
                                           const std::function<void(const std::string&)>& tell,
                                           const std::function<bool()>& stop);

// One page to send to a colleague, and the same for a terminal.
[[nodiscard]] std::string trial_page(const TrialMeasurements& seen);
[[nodiscard]] std::string trial_text(const TrialMeasurements& seen);
[[nodiscard]] std::string trial_json(const TrialMeasurements& seen);

}  // namespace burr::app
