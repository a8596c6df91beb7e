// rt/flags.h - the bits of a tick: why its force, or its cut, is not what the laws alone would
// give.
//
// One enum for everybody who sets such a bit: haptics (safety layer, touch), edit (carver, brush)
// and tick. Several bits may be set at once. Recordings hold these numbers: a bit keeps its number
// and its meaning for ever, a new one gets the next free number. Sentences: tick/flag_words.h.
#pragma once

#include <cstdint>

namespace burr::rt {

enum Flag : std::uint32_t {
  // the hand or the force was NaN, infinite or a kilometre away: fades to zero, until the ramp
  kFlagNotFinite = 1U << 0,
  kFlagForceLimited = 1U << 1,  // shortened to the device's or the user's limit, direction kept
  kFlagSlewLimited = 1U << 2,   // the force grew too fast and was held back
  kFlagRamp = 1U << 3,          // start ramp
  kFlagWaiting = 1U << 4,       // not engaged yet: the computed force has not been small
  kFlagThermal = 1U << 5,       // the motors' heat budget is spent: continuous force only
  kFlagWatchdog = 1U << 6,      // ticks were lost: faded to zero
  kFlagJump = 1U << 7,          // the hand moved more than 20 mm in a tick: reading rejected
  kFlagLagging = 1U << 8,       // the proxy has not caught up with a fast hand yet
  kFlagCandidates = 1U << 9,  // more contacts than the list holds: a shorter move, the nearest kept
  kFlagReserve = 1U << 10,    // no brick left to add material to; raise reserve_bricks
  kFlagUndoFull = 1U << 11,   // undo memory is full, the oldest stroke forgotten; raise undo_bricks
  kFlagHandLost = 1U << 12,   // the device says that its reading is not valid
  kFlagRestoring = 1U << 13,  // an undo or reset is in progress: the burr is lifted, nothing is cut
  kFlagNotCut = 1U << 14,     // the debt reached its cap, the rest is counted as not cut
  kFlagPutOff = 1U << 15,     // too much to cut in one tick: the bricks are cut in turn
  kFlagGuarded = 1U << 16,    // the energy guard damped the hand
  kFlagStalled = 1U << 17,    // the spindle stands still: the bone holds it
  kFlagShaft = 1U << 18,      // a part of the tool that never cuts rests on bone
  kFlagLaw = 1U << 19,        // a custom law gave what cannot be: it is off, no force of touch
};

}  // namespace burr::rt
