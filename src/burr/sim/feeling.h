// sim/feeling.h - a simulated person's hand for experiments: it presses, rubs or holds still, and
// turns what it felt into a number.
//
// No two touches are the same: there are kGestures variants, which differ in depth, speed and
// duration. Thread: any. Frame: world, the wall below z = 0. Units: SI.
#pragma once

#include "burr/device/hand_path.h"
#include "burr/device/simulated_hand.h"
#include "burr/sim/trial_interval.h"

namespace burr::sim {

inline constexpr int kGestures = 4;

// The path of the hand: it presses up and down for stiffness, rubs in circles for friction, holds
// still for vibration. gesture: 0 .. kGestures - 1.
[[nodiscard]] device::HandPath gesture_for(people::Stimulus stimulus, int gesture,
                                           const WallSettings& wall, double seconds);

// The experiment's quantity, computed from what was felt.
[[nodiscard]] double sensed(people::Stimulus stimulus, const people::Felt& felt);

// A new simulated hand feels the value once.
[[nodiscard]] Result<double> feel(Wall& wall, people::Stimulus stimulus, double value, int gesture,
                                  double seconds);

}  // namespace burr::sim
