#include "burr/device/simulated_hand.h"

#include <cmath>

namespace burr::device {

SimulatedHand::SimulatedHand(HandPath path, const ArmSettings& arm, DeviceSpec spec)
    : path_(std::move(path)), arm_(arm), spec_(std::move(spec)) {}

Status SimulatedHand::open() {
  if (path_.points.empty())
    return error(Trouble::usage, "the simulated hand has no path; give it a motion or a CSV file");
  time_ = 0;
  started_ = false;
  hand_ = {};
  force_ = math::Vec3::Zero();
  return fine();
}

HandState SimulatedHand::state(double dt) BURR_RT {
  const PathPoint goal = at(path_, time_, hint_);
  const math::Vec3 target = goal.world_from_tool.p;
  if (!started_) {
    started_ = true;
    hand_.position = target_ = target;
  } else if (std::isinf(arm_.stiffness)) {
    hand_.velocity = (target - hand_.position) / dt;
    hand_.position = target;
  } else {
    hand_.follow(arm_, target_, target, force_ * scale_.load(std::memory_order_relaxed), dt);
  }
  target_ = target;
  time_ += dt;

  HandState hand;
  hand.world_from_tool = {hand_.position, goal.world_from_tool.q};
  hand.velocity = hand_.velocity;
  hand.pedal = goal.pedal;
  return hand;
}

void SimulatedHand::write_force(const math::Vec3& force) BURR_RT {
  force_ = force;
  scale_.store(1.0, std::memory_order_relaxed);
}

}  // namespace burr::device
