// haptics/force_steps.h - how far a force steps from one tick to the next beyond what the hand's own
// move explains.
//
//     excess = |F - F before| - k |hand - hand before|      never below 0
//
// On bone that stands still the spring alone gives 0 on a wall, in a hollow, and on a ball of radius
// R under a burr of radius r while the hand is less than (R + r) / 2 deep. What is left comes from the bone's grain, from a slip over
// an edge, from friction that lets go, or from a fault.
//
// Thread: one. Frame: any. Units: SI. Cost: a few operations; allocates nothing.
#pragma once

#include <algorithm>

#include "burr/math/sums.h"
#include "burr/math/vec3.h"

namespace burr::haptics {

class ForceSteps {
 public:
  explicit ForceSteps(double stiffness, double counted = 0.05)
      : stiffness_(stiffness), counted_(counted) {}

  // One tick: where the hand is, and the force that it gets. Returns the excess of this tick [N].
  double add(const math::Vec3& hand, const math::Vec3& force) {
    double excess = 0;
    if (ticks_ > 0)
      excess = std::max(0.0, math::norm(force - force_) - stiffness_ * math::norm(hand - hand_));
    hand_ = hand;
    force_ = force;
    ++ticks_;
    most_ = std::max(most_, excess);
    above_ += excess > counted_ ? 1 : 0;
    return excess;
  }

  [[nodiscard]] double most() const { return most_; }  // [N]
  [[nodiscard]] long above() const { return above_; }  // ticks with more than `counted`
  [[nodiscard]] long ticks() const { return ticks_; }
  [[nodiscard]] double counted() const { return counted_; }  // [N]

 private:
  double stiffness_, counted_;
  math::Vec3 hand_ = math::Vec3::Zero(), force_ = math::Vec3::Zero();
  double most_ = 0;
  long above_ = 0, ticks_ = 0;
};

}  // namespace burr::haptics
