// device/hand_state.h - plain structs between devices and touch: one reading of the hand, and the limits
// of a device.
//
// Frame: world (LPS). Units: SI.
// Thread: any; plain structs.
#pragma once

#include <cstdint>
#include <string>

#include "burr/math/pose.h"

namespace burr::device {

// Bit of HandState::buttons: the hand is lifted off, to be moved without the tool (a clutch). No
// force, no contact and no cutting until it is released in free air.
inline constexpr std::uint32_t kLifted = 1U << 31;
// Another one: the hand hovers. It feels and cuts nothing, and its tool is wherever the hand is set
// down in free air, however far from the place before. Where the hand is in bone, the tool follows
// it as far as the bone allows. For a hand that only points, such as a mouse without its button.
inline constexpr std::uint32_t kHovers = 1U << 30;
// Bits that burr sets itself; not buttons of a device.
inline constexpr std::uint32_t kOwnBits = kLifted | kHovers;

// One reading of the hand. The tool's tip (centre of the burr head) is the origin of the tool
// frame; the handle lies along +z.
struct HandState {
  math::Pose world_from_tool;
  math::Vec3 velocity = math::Vec3::Zero();  // of the tip, as the device reports it [m/s]
  double pedal = 0;                          // spindle command, 0..1 of the set speed
  std::uint32_t buttons = 0;                 // bit i: button i is down
  bool valid = true;                         // false: the device lost track of the hand; no force
                                             // is sent
};

// What a device is, and its limits. All forces are at the tip.
struct DeviceSpec {
  std::string name = "simulated hand";
  std::string serial = {};         // as the maker wrote it; empty: unknown
  std::string software = {};       // of its maker, with versions where reported; empty: not
                                   // reported
  int sensed = 6;                  // degrees of freedom it reads: 3 position, 6 also orientation
  int actuated = 3;                // degrees of freedom it pushes
  double peak_force = 3.3;         // never exceeded [N]
  double continuous_force = 0.88;  // may last for ever; above it the motors heat up [N]
  double peak_torque = 0;          // about the tip; 0: it cannot give torque [N m]
  // limit on heating above continuous_force: integral of F^2 - F_cont^2 over time [N^2 s]
  double thermal_budget = 3.3 * 3.3 * 5;
  double max_stiffness = 1000;  // stiffest wall it can show without shaking [N/m]
  double max_damping = 5;       // likewise [N s/m]
  // For devices with torque; 0: not known, or none.
  double max_turn_stiffness = 0;    // stiffest spring of turning it can show [N m/rad]
  double turn_damping = 0;          // its own damping when it is turned; only if measured
                                    // [N m s/rad]
  double lever = 0;                 // from where it pushes to the tip; drivers put the tip there,
                                    // so 0 [m]
  double scale = 1;                 // movement of the tip / movement of the hand; a torque of the
                                    // world is felt as 1 / scale times as much
  double workspace_radius = 75e-3;  // radius of the hand's own movement about its middle [m]
  double native_rate = 1000;        // tick rate that suits it best [Hz]
  double loss_timeout = 20e-3;      // time without a tick after which the force fades to zero. Real
                                    // devices: 5e-3 [s]
  bool simulated = true;
};

}  // namespace burr::device
