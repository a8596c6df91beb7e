#include "burr/haptics/limit.h"

#include <algorithm>
#include <cmath>

#include "burr/haptics/contact.h"

namespace burr::haptics {
namespace {

using math::Vec3;

// The nearest force to `wanted` that is no further than `step` from what can be had by only letting
// go of `sent`. Letting go is free, growing and turning are not.
Vec3 slew_bound(const Vec3& wanted, const Vec3& sent, double step, bool& bounded) BURR_RT {
  const double square = sent.squaredNorm();
  const double keep = square > 0 ? std::clamp(wanted.dot(sent) / square, 0.0, 1.0) : 0.0;
  const Vec3 base = keep * sent;
  const Vec3 growth = wanted - base;
  const double size = growth.norm();
  bounded = size > step;
  return bounded ? Vec3(base + growth * (step / size)) : wanted;
}

// no bone lies beyond it, nor may a path of a hand; places further out fit no count of voxels  [m]
constexpr double kFarthestHand = 1e3;

}  // namespace

ForceLimit::ForceLimit(const device::DeviceSpec& device, const LimitSettings& settings)
    : device_(device), settings_(settings) {}

void ForceLimit::set_user_force(double newton) BURR_RT {
  if (std::isfinite(newton) && newton >= 0) settings_.user_force = newton;
}

bool ForceLimit::believe(const device::HandState& hand, std::uint32_t& flags) BURR_RT {
  std::uint32_t trouble = 0;
  if (!hand.valid) {
    trouble = kFlagHandLost;
  } else if (!hand.world_from_tool.finite() || !hand.velocity.allFinite() ||
             !std::isfinite(hand.pedal) ||
             hand.world_from_tool.p.cwiseAbs().maxCoeff() > kFarthestHand) {
    trouble = kFlagNotFinite;
  } else if (has_last_hand_ &&
             (hand.world_from_tool.p - last_hand_).norm() > settings_.longest_leap) {
    trouble = kFlagJump;
  }
  if (trouble != 0) {
    fault(trouble, flags);
    has_last_hand_ = false;
    return false;
  }
  last_hand_ = hand.world_from_tool.p;
  has_last_hand_ = true;
  return true;
}

void ForceLimit::fault(std::uint32_t flag, std::uint32_t& flags) BURR_RT {
  flags |= flag;
  lift();
}

void ForceLimit::lift() BURR_RT {
  if (state_ == State::fading) return;  // already on its way to zero
  state_ = State::fading;
  fading_from_ = sent_;
  in_state_ = 0;
}

void ForceLimit::restart() BURR_RT {
  state_ = State::waiting;
  sent_ = Vec3::Zero();
  in_state_ = 0;
}

Vec3 ForceLimit::apply(const Vec3& wanted, double dt, std::uint32_t& flags) BURR_RT {
  const bool finite = wanted.allFinite();
  if (!finite) fault(kFlagNotFinite, flags);
  in_state_ += dt;

  Vec3 force = Vec3::Zero();
  if (state_ == State::fading) {
    const double left = std::max(0.0, 1.0 - in_state_ / settings_.fade_time);
    force = left * fading_from_;
    if (left <= 0) restart();
  } else if (state_ == State::waiting) {
    flags |= kFlagWaiting;
    if (wanted.norm() < settings_.small_force) {
      state_ = State::ramp;
      in_state_ = 0;
    }
  } else {
    if (state_ == State::ramp && in_state_ >= settings_.ramp_time) state_ = State::running;
    force = wanted;

    // the device, the user, and the motors' heat; direction kept. The heat limit closes gradually
    // over its last tenth.
    double most = std::min(device_.peak_force, settings_.user_force);
    const double hot = std::clamp((heat_ / device_.thermal_budget - 0.9) * 10.0, 0.0, 1.0);
    const double bearable = std::min(most, device_.continuous_force);
    if (hot > 0) most += hot * (bearable - most);
    const double size = force.norm();
    if (size > most) {
      force *= most / size;
      flags |= hot > 0 ? kFlagThermal : kFlagForceLimited;
    }

    bool bounded = false;
    force = slew_bound(
        force, sent_, (state_ == State::ramp ? settings_.ramp_slew : settings_.slew) * dt, bounded);
    if (bounded) flags |= kFlagSlewLimited;
    if (state_ == State::ramp) flags |= kFlagRamp;
  }

  const double bearable = device_.continuous_force;
  heat_ = std::max(0.0, heat_ + (force.squaredNorm() - bearable * bearable) * dt);
  sent_ = force;
  return force;
}

}  // namespace burr::haptics
