// haptics/contact.h - the result of one tick of touch. Plain struct; world frame, SI.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"

namespace burr::haptics {

// Why the force differs from the spring's force; several flags may be set at once.
enum Flag : std::uint32_t {
  // a hand or force was NaN, infinite or a kilometre away: zero force until the start ramp
  kFlagNotFinite = 1U << 0,
  kFlagForceLimited = 1U << 1,  // shortened to the device's or the user's limit, same direction
  kFlagSlewLimited = 1U << 2,   // grew too fast and was held back
  kFlagRamp = 1U << 3,          // start ramp
  kFlagWaiting = 1U << 4,       // not engaged yet: the computed force has not been small so far
  kFlagThermal = 1U << 5,       // the motors' heat budget is used up: continuous force only
  kFlagWatchdog = 1U << 6,      // ticks were lost: the force faded to zero
  kFlagJump = 1U << 7,          // the hand moved more than 20 mm in a tick: reading rejected
  kFlagLagging = 1U << 8,       // the proxy has not caught up with a fast hand yet
  kFlagCandidates = 1U << 9,    // more contacts than fit: a shorter move, the nearest kept
  kFlagReserve = 1U << 10,      // no brick left to add material to; raise reserve_bricks
  kFlagUndoFull = 1U << 11,   // undo memory was full, the oldest stroke dropped; raise undo_bricks
  kFlagHandLost = 1U << 12,   // the device reports that its reading is not valid
  kFlagRestoring = 1U << 13,  // an undo or reset is running: the burr is lifted, nothing is cut
  kFlagNotCut = 1U << 14,     // the debt reached its limit; the rest is counted as not cut
  kFlagGuarded = 1U << 16,    // the energy guard damped the hand
  kFlagStalled = 1U << 17,    // the spindle stands still: the bone holds it
  kFlagPutOff = 1U << 15,     // too much to cut in one tick: the bricks are cut in turn
};

struct Contact {
  math::Vec3 proxy = math::Vec3::Zero();   // centre of the burr head, never inside bone [m]
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone; zero while nothing is touched
  math::Vec3 force = math::Vec3::Zero();   // on the hand, after all limits [N]
  math::Vec3 torque = math::Vec3::Zero();  // the same about the tip, for devices with torque [N m]
  double depth = 0;    // distance from the hand to the proxy                    [m]
  int active = 0;      // constraints the proxy rests on, 0..3
  int candidates = 0;  // contacts that were examined
  bool touching = false;
  std::uint32_t flags = 0;
};

}  // namespace burr::haptics
