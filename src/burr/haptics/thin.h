// haptics/thin.h - shortens a list of contacts that is full: of contacts that face the same way
// only the nearest is kept.
//
// A ball in a socket of its own size touches everywhere at once: 30 000 discs for 7 mm on voxels of
// 0.05 mm. Contacts whose normals differ by at most kThinAngle constrain nearly the same, so a move
// p may violate a removed one by at most |p| kThinAngle. Thread: servo. Memory: 6 KiB of stack.
#pragma once

#include "burr/haptics/scan_kernel.h"
#include "burr/rt/rt.h"

namespace burr::haptics {

// Largest angle between two normals of one bin: atan(sqrt 2 / 8)  [rad]
inline constexpr double kThinAngle = 0.176;

// Keeps the nearest contact of each direction (the first one of equals), in the order of the list.
void thin(Candidates& all) BURR_RT;

}  // namespace burr::haptics
