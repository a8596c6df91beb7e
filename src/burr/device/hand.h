// device/hand.h - what a hand says and what it can bear: plain structs between devices and touch.
//
// Frame: world (LPS). Units: SI.
#pragma once

#include <cstdint>
#include <string>

#include "burr/math/pose.h"

namespace burr::device {

// In HandState::buttons: the hand is lifted off to be laid elsewhere (a clutch): no force, nothing
// is touched or cut until it is let go again in free air.
inline constexpr std::uint32_t kLifted = 1U << 31;

// One reading of the hand. The tool's tip (centre of the burr head) is the origin of the tool
// frame, its handle lies along +z.
struct HandState {
  math::Pose world_from_tool;
  math::Vec3 velocity = math::Vec3::Zero();  // of the tip, as the device knows it [m/s]
  double pedal = 0;                          // spindle command, 0..1 of the set speed
  std::uint32_t buttons = 0;                 // bit i: button i is down
  bool valid = true;                         // false: the device lost track; no force is sent
};

// What a device is and how much it may be asked for. All forces at the tip.
struct DeviceSpec {
  std::string name = "simulated hand";
  std::string serial = {};         // as the maker wrote it; empty: unknown
  std::string software = {};       // of its maker, with versions as they are told; empty: not told
  int sensed = 6;                  // degrees of freedom it reads: 3 place, 6 also how it is turned
  int actuated = 3;                // that it pushes
  double peak_force = 3.3;         // never exceeded                                             [N]
  double continuous_force = 0.88;  // bearable for ever; the motors' heat budget starts here     [N]
  double peak_torque = 0;          // about the tip; 0: none can be felt                       [N m]
  // how long above continuous_force: integral of F^2 - F_cont^2  [N^2 s]
  double thermal_budget = 3.3 * 3.3 * 5;
  double max_stiffness = 1000;      // of a wall it can show without trembling                 [N/m]
  double max_damping = 5;           // likewise                                              [N s/m]
  double workspace_radius = 75e-3;  // of the hand's own way about its middle                    [m]
  double native_rate = 1000;        // ticks per second it likes best                           [Hz]
  double loss_timeout = 20e-3;      // no tick for this long: fade to zero. Real devices: 5e-3   [s]
  bool simulated = true;
};

}  // namespace burr::device
