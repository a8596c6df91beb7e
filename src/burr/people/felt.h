// people/felt.h - what a hand felt in an interval, and the number in it that is asked for.
//
// Only what a person has: where the hand was and how it was pushed, at the device, after every
// limit. Nothing of the simulation's own proxy or settings. The first 0.7 s are left out: the start
// ramp of the safety layer, and the hand that comes down.
//
// Frame: one in which `outward` points out of the wall. Units: SI. Thread: any.
#pragma once

#include <vector>

#include "burr/math/vec3.h"

namespace burr::people {

struct Felt {
  double dt = 1e-3;                   // [s]
  std::vector<math::Vec3> at, force;  // a row a tick [m], [N]
};

// How much more force a metre deeper gives: the slope of force over place while pressing. [N/m]
[[nodiscard]] double felt_stiffness(const Felt& felt, const math::Vec3& outward);

// Force along the wall over force out of it, while sliding. [-]
[[nodiscard]] double felt_friction(const Felt& felt, const math::Vec3& outward);

// Root mean square of the force along the wall, its mean taken out. [N]
[[nodiscard]] double felt_vibration(const Felt& felt, const math::Vec3& outward);

}  // namespace burr::people
