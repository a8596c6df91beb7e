#include "burr/mouse/mouse_hand.h"

#include <algorithm>

namespace burr::mouse {
MouseHand::MouseHand(const math::Pose& start) : gliding_(start.p), q_(start.q), p_(start.p) {
  aim_.world_from_tool = start;
  spec_.name = "mouse";
  // nobody feels a mouse's ticks: a machine that is busy for a moment need not stop the work
  spec_.loss_timeout = 0.5;
}

device::HandState MouseHand::state(double dt) BURR_RT {
  static_cast<void>(aims_.take(aim_));
  if (!aim_.valid || !aim_.world_from_tool.finite()) {  // the arm stays where it is
    velocity_.setZero();
    device::HandState hand;
    hand.world_from_tool = aim_.valid ? aim_.world_from_tool : math::Pose{p_, q_};
    hand.valid = aim_.valid;
    return hand;
  }
  q_ = aim_.world_from_tool.q;
  if (aim_.hovers) {
    p_ = gliding_ = aim_.world_from_tool.p;
    velocity_.setZero();
    device::HandState hand;
    hand.world_from_tool = aim_.world_from_tool;
    hand.buttons = device::kHovers;
    return hand;
  }
  const math::Vec3 way = aim_.world_from_tool.p - gliding_;
  const double far = way.norm(), most = aim_.pace * dt;
  gliding_ += far > most ? math::Vec3(way * (most / far)) : way;

  // semi-implicit Euler in four steps: stable at every rate burr allows
  constexpr int kSteps = 4;
  const double step = dt / kSteps;
  const math::Vec3 push = force_ * scale_.load(std::memory_order_relaxed);
  for (int i = 0; i < kSteps; ++i) {
    const math::Vec3 pull = arm_.stiffness * (gliding_ - p_) - arm_.damping * velocity_;
    velocity_ += (pull + push) * (step / arm_.mass);
    p_ += velocity_ * step;
  }

  device::HandState hand;
  hand.world_from_tool = {p_, aim_.world_from_tool.q};
  hand.velocity = velocity_;
  hand.pedal = aim_.pedal;
  return hand;
}

void MouseHand::write_force(const math::Vec3& force) BURR_RT {
  force_ = force;
  scale_.store(1.0, std::memory_order_relaxed);
}

}  // namespace burr::mouse
