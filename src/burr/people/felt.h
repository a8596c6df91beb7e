// people/felt.h - what a hand felt in an interval, and the quantity that the trial is about.
//
// Uses only what a person has: where the hand was and the force on it, at the device, after every
// limit; not the proxy or the settings of the simulation. The first 0.7 s are left out: the start
// ramp of the safety layer, and the hand coming down.
//
// Frame: one in which `outward` points out of the wall. Units: SI. Thread: any.
#pragma once

#include <vector>

#include "burr/math/vec3.h"

namespace burr::people {

struct Felt {
  double dt = 1e-3;                   // [s]
  std::vector<math::Vec3> at, force;  // one row per tick [m], [N]
};

// Increase of force per metre of depth: the slope of force over place while pressing. [N/m]
[[nodiscard]] double felt_stiffness(const Felt& felt, const math::Vec3& outward);

// Force along the wall divided by force out of it, while sliding. [-]
[[nodiscard]] double felt_friction(const Felt& felt, const math::Vec3& outward);

// Root mean square of the force along the wall, without its mean. [N]
[[nodiscard]] double felt_vibration(const Felt& felt, const math::Vec3& outward);

}  // namespace burr::people
