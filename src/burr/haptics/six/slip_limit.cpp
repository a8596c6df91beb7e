#include "burr/haptics/six/slip_limit.h"

#include <algorithm>

#include "burr/math/sums.h"
#include "burr/math/turn.h"

namespace burr::haptics {

using math::Vec3;

bool SlipLimit::step(const Vec3& hand, bool applies, Touch& touch) BURR_RT {
  const Vec3 before = last_stretch_;
  const Vec3 stretch =
      touch.touching ? Vec3(touch.depth * touch.normal + touch.tangential) : Vec3(Vec3::Zero());
  const Vec3 change = stretch - before;
  const double most = math::norm(hand - last_hand_) + slip_, length = math::norm(change);
  const bool limited = known_ && slip_ > 0 && applies && length > most;
  last_hand_ = hand;
  last_stretch_ = stretch;
  known_ = true;
  if (!limited) return false;
  const Vec3 allowed = before + change * (most / length);
  last_stretch_ = allowed;
  const double along = touch.touching ? math::dot(allowed, touch.normal) : 0;
  touch.touching = true;
  if (along > 0) {
    touch.depth = along;
    touch.tangential = allowed - along * touch.normal;
  } else {
    touch.slipping = true;
    touch.depth = math::norm(allowed);
    touch.normal = allowed / std::max(touch.depth, 1e-12);
    touch.tangential = Vec3::Zero();
  }
  return true;
}

void TurnLimit::step(const math::Quat& hand, double slip, Vec3& turn) BURR_RT {
  const Vec3 change = turn - last_turn_;
  const double went =
      math::norm(math::rotation_vector(math::product(hand, last_hand_.conjugate())));
  const double most = went + slip, length = math::norm(change);
  if (known_ && slip > 0 && length > most) turn = last_turn_ + change * (most / length);
  last_hand_ = hand;
  last_turn_ = turn;
  known_ = true;
}

}  // namespace burr::haptics
