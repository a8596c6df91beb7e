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
  return fine();
}

HandState SimulatedHand::state(double dt) BURR_RT {
  const PathPoint goal = at(path_, time_, hint_);
  const math::Vec3 target = goal.world_from_tool.p;
  if (!started_) {
    started_ = true;
    position_ = target_ = target;
  } else if (std::isinf(arm_.stiffness)) {
    velocity_ = (target - position_) / dt;
    position_ = target;
  } else {
    // semi-implicit Euler in four substeps: stable while stiffness / mass * (dt/4)^2 < 4
    constexpr int kSteps = 4;
    const double step = dt / kSteps;
    const math::Vec3 pace = (target - target_) / dt;
    const math::Vec3 push = force_ * scale_.load(std::memory_order_relaxed);
    for (int i = 1; i <= kSteps; ++i) {
      const math::Vec3 aim = target_ + pace * (step * i);
      const math::Vec3 pull =
          arm_.stiffness * (aim - position_) + arm_.damping * (pace - velocity_);
      velocity_ += (pull + push) * (step / arm_.mass);
      position_ += velocity_ * step;
    }
  }
  target_ = target;
  time_ += dt;

  HandState hand;
  hand.world_from_tool = {position_, goal.world_from_tool.q};
  hand.velocity = velocity_;
  hand.pedal = goal.pedal;
  return hand;
}

void SimulatedHand::write_force(const math::Vec3& force) BURR_RT {
  force_ = force;
  scale_.store(1.0, std::memory_order_relaxed);
}

}  // namespace burr::device
