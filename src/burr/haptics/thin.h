// haptics/thin.h - more contacts than the list holds: of those that face the same way, the nearest
// is kept.
//
// A ball that rests in a socket of its own size touches everything at once: 30 000 discs for 7 mm
// on voxels of 0.05 mm. Contacts whose normals differ by at most kThinAngle say nearly the same, so
// a move p may overstep a forgotten one by |p| kThinAngle at most. Thread: servo. Memory: 6 KiB of
// stack.
#pragma once

#include "burr/haptics/scan_kernel.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

// between two normals of one bin: atan(sqrt 2 / 8)  [rad]
inline constexpr double kThinAngle = 0.176;

// Keeps the first nearest of each direction, in the order they came.
void thin(Candidates& all) BURR_RT;

}  // namespace burr::haptics
