#include "burr/haptics/safety/limit.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/math/turn.h"
#include "burr/rt/flags.h"

namespace burr::haptics {
namespace {

using math::Vec3;

// The force nearest to `wanted` that differs by at most `step` from some reduced copy of `sent`.
// Reducing is unlimited; growing and turning are limited.
Vec3 slew_bound(const Vec3& wanted, const Vec3& sent, double step, bool& bounded) BURR_RT {
  const double square = math::squared_norm(sent);
  const double keep = square > 0 ? std::clamp(math::dot(wanted, sent) / square, 0.0, 1.0) : 0.0;
  const Vec3 base = keep * sent;
  const Vec3 growth = wanted - base;
  const double size = math::norm(growth);
  bounded = size > step;
  return bounded ? Vec3(base + growth * (step / size)) : wanted;
}

// no bone or hand path may lie farther away; larger coordinates do not fit a voxel index  [m]
constexpr double kFarthestHand = 1e3;

}  // namespace

ForceLimit::ForceLimit(const device::DeviceSpec& device, const LimitSettings& settings)
    : device_(device),
      settings_(settings),
      lever_(device.peak_force > 0 ? device.peak_torque / device.peak_force : 0) {}

void ForceLimit::set_user_force(double newton) BURR_RT {
  if (std::isfinite(newton) && newton >= 0) settings_.user_force = newton;
}

bool ForceLimit::accept_reading(const device::HandState& hand, std::uint32_t& flags) BURR_RT {
  std::uint32_t trouble = 0;
  if (!hand.valid) {
    trouble = rt::kFlagHandLost;
  } else if (!hand.world_from_tool.finite() || !hand.velocity.allFinite() ||
             !std::isfinite(hand.pedal) ||
             hand.world_from_tool.p.cwiseAbs().maxCoeff() > kFarthestHand) {
    trouble = rt::kFlagNotFinite;
  } else if (has_last_hand_ &&
             math::norm(hand.world_from_tool.p - last_hand_) > settings_.largest_jump) {
    trouble = rt::kFlagJump;
  } else if (has_last_hand_ && device_.peak_torque > 0 &&
             math::norm(math::rotation_vector(math::product(
                 hand.world_from_tool.q, last_turn_.conjugate()))) > settings_.largest_turn) {
    trouble = rt::kFlagJump;
  }
  if (trouble != 0) {
    fault(trouble, flags);
    has_last_hand_ = false;
    return false;
  }
  last_hand_ = hand.world_from_tool.p;
  last_turn_ = hand.world_from_tool.q;
  has_last_hand_ = true;
  return true;
}

void ForceLimit::fault(std::uint32_t flag, std::uint32_t& flags) BURR_RT {
  flags |= flag;
  lift();
}

void ForceLimit::lift() BURR_RT {
  if (state_ == State::fading) return;  // already fading to zero
  state_ = State::fading;
  for (Channel* one : {&force_, &torque_}) one->fading_from = one->sent;
  in_state_ = 0;
}

void ForceLimit::restart() BURR_RT {
  state_ = State::waiting;
  for (Channel* one : {&force_, &torque_}) one->sent = Vec3::Zero();
  in_state_ = 0;
}

double ForceLimit::left() const BURR_RT {
  return std::max(0.0, 1.0 - in_state_ / settings_.fade_time);
}

// Limits of device, user and motor heat. The heat limit closes gradually over the last tenth of the
// budget.
double ForceLimit::most(const Channel& channel, double& hot) const BURR_RT {
  double most = std::min(device_.peak_force, settings_.user_force);
  hot = std::clamp((channel.heat / device_.thermal_budget - 0.9) * 10.0, 0.0, 1.0);
  const double bearable = std::min(most, device_.continuous_force);
  if (hot > 0) most += hot * (bearable - most);
  return most;
}

// Limits `wanted` for this set of motors in the present state; direction kept.
Vec3 ForceLimit::bound(Channel& channel, const Vec3& wanted, double dt,
                       std::uint32_t& flags) const BURR_RT {
  Vec3 force = Vec3::Zero();
  if (state_ == State::fading) {
    force = left() * channel.fading_from;
  } else if (state_ == State::waiting) {
    flags |= rt::kFlagWaiting;
  } else {
    force = wanted;

    double hot = 0;
    const double allowed = most(channel, hot);
    const double size = math::norm(force);
    if (size > allowed) {
      force *= allowed / size;
      flags |= hot > 0 ? rt::kFlagThermal : rt::kFlagForceLimited;
    }

    bool bounded = false;
    force =
        slew_bound(force, channel.sent,
                   (state_ == State::ramp ? settings_.ramp_slew : settings_.slew) * dt, bounded);
    if (bounded) flags |= rt::kFlagSlewLimited;
    if (state_ == State::ramp) flags |= rt::kFlagRamp;
  }

  const double bearable = device_.continuous_force;
  channel.heat =
      std::max(0.0, channel.heat + (math::squared_norm(force) - bearable * bearable) * dt);
  channel.sent = force;
  return force;
}

Vec3 ForceLimit::apply(const Vec3& wanted, double dt, std::uint32_t& flags) BURR_RT {
  if (!wanted.allFinite()) fault(rt::kFlagNotFinite, flags);
  in_state_ += dt;
  if (state_ == State::ramp && in_state_ >= settings_.ramp_time) state_ = State::running;
  const Vec3 force = bound(force_, wanted, dt, flags);
  if (state_ == State::fading && left() <= 0) {
    restart();
  } else if (state_ == State::waiting && math::norm(wanted) < settings_.small_force) {
    state_ = State::ramp;
    in_state_ = 0;
  }
  return force;
}

Vec3 ForceLimit::apply_torque(const Vec3& wanted, double dt, std::uint32_t& flags) BURR_RT {
  if (lever_ <= 0) return Vec3::Zero();
  if (!wanted.allFinite()) fault(rt::kFlagNotFinite, flags);
  if (state_ == State::ramp && in_state_ <= 0) return Vec3::Zero();  // begins with the next tick
  return lever_ * bound(torque_, wanted / lever_, dt, flags);
}

Wrench ForceLimit::apply(const Wrench& wanted, const Vec3& twist, double dt,
                         std::uint32_t& flags) BURR_RT {
  if (lever_ <= 0) return {apply(wanted.force, dt, flags), Vec3::Zero()};
  if (!wanted.force.allFinite() || !wanted.torque.allFinite()) fault(rt::kFlagNotFinite, flags);
  in_state_ += dt;
  if (state_ == State::ramp && in_state_ >= settings_.ramp_time) state_ = State::running;

  Wrench asked = {wanted.force, wanted.torque / lever_};
  if (engaged()) {
    double hot_force = 0, hot_torque = 0;
    const double most_force = most(force_, hot_force), most_torque = most(torque_, hot_torque);
    const double force = math::norm(asked.force), torque = math::norm(asked.torque);
    if (force > most_force || torque > most_torque)
      flags |= (force > most_force ? hot_force : hot_torque) > 0 ? rt::kFlagThermal
                                                                 : rt::kFlagForceLimited;
    asked = limited(asked, most_force, most_torque);
  }
  Wrench sent;
  sent.force = bound(force_, asked.force, dt, flags);
  sent.torque = lever_ * bound(torque_, asked.torque, dt, flags);

  if (state_ == State::fading && left() <= 0) {
    restart();
  } else if (state_ == State::waiting && math::norm(wanted.force) < settings_.small_force &&
             math::norm(Vec3(wanted.torque - twist)) < settings_.small_force * lever_) {
    state_ = State::ramp;
    in_state_ = 0;
  }
  return sent;
}

}  // namespace burr::haptics
