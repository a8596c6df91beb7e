#include "burr/device/pushed_hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/math/turn.h"

namespace burr::device {

PushedHand::PushedHand(const ArmSettings& arm, DeviceSpec spec)
    : arm_(arm), spec_(std::move(spec)) {}

Status PushedHand::open() {
  goal_ = target_ = {};
  left_ = 0;
  placed_ = false;
  jumps_ = true;
  hand_ = {};
  force_ = math::Vec3::Zero();
  now_ = {};
  return fine();
}

void PushedHand::place(const math::Pose& there, double pedal, std::uint32_t buttons) BURR_RT {
  goal_ = target_ = there;  // a move may follow before the next tick
  now_.pedal = pedal;
  now_.buttons = buttons;
  left_ = 0;
  placed_ = jumps_ = true;
}

void PushedHand::move(const math::Pose& there, double pedal, std::uint32_t buttons,
                      std::uint64_t ticks) BURR_RT {
  if (!placed_) {
    place(there, pedal, buttons);
    return;
  }
  goal_ = there;
  now_.pedal = pedal;
  now_.buttons = buttons;
  left_ = std::max<std::uint64_t>(ticks, 1);
}

HandState PushedHand::state(double dt) BURR_RT {
  const math::Vec3 from = target_.p;
  if (left_ > 0) {
    const double part = 1.0 / static_cast<double>(left_);
    target_.p += (goal_.p - target_.p) * part;
    target_.q = left_ > 1 ? math::between(target_.q, goal_.q, part) : goal_.q;
    --left_;
  } else {
    target_ = goal_;
  }
  if (jumps_) {
    hand_ = {.position = target_.p};
    jumps_ = false;
  } else if (std::isinf(arm_.stiffness)) {
    hand_.velocity = (target_.p - hand_.position) / dt;
    hand_.position = target_.p;
  } else {
    hand_.follow(arm_, from, target_.p, force_, dt);
  }
  now_.world_from_tool = {hand_.position, target_.q};
  now_.velocity = hand_.velocity;
  return now_;
}

}  // namespace burr::device
