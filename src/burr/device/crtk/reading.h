// device/crtk/reading.h - the hand that a CRTK arm's messages tell, and what is never believed of
// them; of this room only.
//
// Thread: any. Frame: the arm's own base, metres. Memory: none.
#pragma once

#include "burr/device/crtk/bus.h"
#include "burr/device/hand.h"
#include "burr/rt/rt.h"

namespace burr::device::crtk {

// False: no place where an arm's end can be, or one that CRTK calls not valid (a stamp of 0);
// `hand` is as it was then.
[[nodiscard]] bool take_place(const PoseStamped& told, HandState& hand) BURR_RT;
// Likewise; a speed that is not valid is none.
[[nodiscard]] bool take_speed(const TwistStamped& told, HandState& hand) BURR_RT;

}  // namespace burr::device::crtk
