// device/crtk/reading.h - turns the messages of a CRTK arm into a reading of the hand, and refuses
// values that cannot be true. For use of this room only.
//
// Thread: any. Frame: the arm's own base, metres. Memory: none.
#pragma once

#include "burr/device/crtk/bus.h"
#include "burr/device/hand_state.h"
#include "burr/rt/rt.h"

namespace burr::device::crtk {

// False: the pose cannot be true, or CRTK marks it as not valid (its stamp is 0); `hand` is
// unchanged.
[[nodiscard]] bool take_place(const PoseStamped& message, HandState& hand) BURR_RT;
// Likewise for the velocity; a velocity that is not valid becomes zero.
[[nodiscard]] bool take_speed(const TwistStamped& message, HandState& hand) BURR_RT;

}  // namespace burr::device::crtk
