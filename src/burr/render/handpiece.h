// render/handpiece.h - the outline of shaft and handpiece of a round burr, as pictures show it.
//
// Turned shapes: radius r at each z, along the tool's axis. Units: m. Thread: any.
#pragma once

#include <utility>
#include <vector>

namespace burr::render {

// z, r; z never decreases
using Profile = std::vector<std::pair<double, double>>;

// Where the handpiece begins, from the middle of the burr's head. A straight one, as drills for the
// ear and the skull have: the burr's shaft sticks out by this much, and the nose widens to the grip
// of 16 mm.
inline constexpr double kShaftOut = 26e-3;

// From the middle of the head. A neck thinner than the head, so that the head can cut sideways; it
// widens to the shaft.
[[nodiscard]] Profile shaft_profile(double radius, double shaft_radius);

// From the beginning of the handpiece.
[[nodiscard]] Profile collet_profile();
[[nodiscard]] Profile nose_profile();
[[nodiscard]] Profile grip_profile();
[[nodiscard]] Profile tail_profile();

}  // namespace burr::render
