// haptics/contact.h - what one tick of touch found out. Plain struct; world frame, SI.
#pragma once

#include <cstdint>

#include "burr/math/vec3.h"

namespace burr::haptics {

// Why the force is not simply the spring's; several may hold at once.
enum Flag : std::uint32_t {
  // a hand or force was NaN, infinite or a kilometre away: zero, latched until the ramp
  kFlagNotFinite = 1U << 0,
  kFlagForceLimited = 1U << 1,  // shortened to the device's or the user's limit, direction kept
  kFlagSlewLimited = 1U << 2,   // grew too fast, was held back
  kFlagRamp = 1U << 3,          // start ramp
  kFlagWaiting = 1U << 4,       // not engaged yet: the computed force has not been small
  kFlagThermal = 1U << 5,       // motors' heat budget is spent: continuous force only
  kFlagWatchdog = 1U << 6,      // ticks were lost: faded to zero
  kFlagJump = 1U << 7,          // the hand leapt more than 20 mm in a tick: not believed
  kFlagLagging = 1U << 8,       // proxy has not caught up with a fast hand yet
  kFlagCandidates = 1U << 9,  // more contacts than the list holds: a shorter move, the nearest kept
  kFlagReserve = 1U << 10,    // no brick left to add material to; raise reserve_bricks
  kFlagUndoFull = 1U << 11,   // undo memory is full, the oldest stroke forgotten; raise undo_bricks
  kFlagHandLost = 1U << 12,   // the device says its reading is not valid
  kFlagRestoring = 1U << 13,  // an undo or reset is under way: the burr is lifted, nothing is cut
  kFlagNotCut = 1U << 14,     // the debt reached its cap, the rest is counted as not cut
  kFlagGuarded = 1U << 16,    // the energy guard braked the hand
  kFlagStalled = 1U << 17,    // the spindle stands: the bone holds it
  kFlagPutOff = 1U << 15,     // too much to cut in one tick: the bricks are cut in turn
};

struct Contact {
  math::Vec3 proxy = math::Vec3::Zero();   // centre of the burr head, never inside bone [m]
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone; zero while nothing is touched
  math::Vec3 force = math::Vec3::Zero();   // what the hand gets, after all limits [N]
  math::Vec3 torque = math::Vec3::Zero();  // likewise about the tip, where it can be felt [N m]
  double depth = 0;    // how far the hand is from the proxy                     [m]
  int active = 0;      // constraints the proxy rests on, 0..3
  int candidates = 0;  // contacts looked at
  bool touching = false;
  std::uint32_t flags = 0;
};

}  // namespace burr::haptics
